// SPDX-License-Identifier: Apache-2.0
// Light in cd/m2, the primaries' matrix, then the curve of ITU-R BT.2390-11, 5.4.1, for the brightest component: the
// others keep their ratio to it, so that no hue changes.
#include "app/scene/sdr_color.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "hal/media/frame.h"

namespace relievo {
namespace {

constexpr std::uint8_t kPq = 16, kHlg = 18, kBt2020 = 9;  // ITU-T H.273

// SMPTE ST 2084.
constexpr double kM1 = 2610.0 / 16384, kM2 = 2523.0 / 32, kC1 = 3424.0 / 4096, kC2 = 2413.0 / 128, kC3 = 2392.0 / 128;

double lightOfPq(double code) noexcept {
  const double root = std::pow(std::max(code, 0.0), 1 / kM2);
  return 10'000 * std::pow(std::max(root - kC1, 0.0) / (kC2 - kC3 * root), 1 / kM1);
}

double pqOfLight(double light) noexcept {
  const double power = std::pow(std::max(light, 0.0) / 10'000, kM1);
  return std::pow((kC1 + kC2 * power) / (1 + kC3 * power), kM2);
}

// ITU-R BT.2100-2, table 5: of the scene, 0 to 1.
double sceneOfHlg(double code) noexcept {
  constexpr double kA = 0.17883277, kB = 1 - 4 * kA, kC = 0.55991073;
  return code <= 0.5 ? code * code / 3 : (std::exp((code - kC) / kA) + kB) / 12;
}

glm::dvec3 lightOf(const glm::dvec3& color, std::uint8_t transfer) noexcept {
  const glm::dvec3 light(hdrLight(color.r, transfer), hdrLight(color.g, transfer), hdrLight(color.b, transfer));
  if (transfer == kPq) return light;
  return light * (kHdrPeakCdM2 * std::pow(glm::dot(light, kBt2020Luminance), kHlgGamma - 1));
}

double codeOf(double light) noexcept {
  return std::pow(std::clamp(light / kSdrWhiteCdM2, 0.0, 1.0), 1 / kSdrGamma);
}

}  // namespace

const char* hdrName(std::uint8_t transfer) noexcept {
  return transfer == kPq ? "PQ" : transfer == kHlg ? "HLG" : nullptr;
}

bool isHlg(std::uint8_t transfer) noexcept {
  return transfer == kHlg;
}

bool isBt2020(std::uint8_t primaries) noexcept {
  return primaries == kBt2020 || primaries == kUnspecifiedColor;
}

double hdrLight(double code, std::uint8_t transfer) noexcept {
  return transfer == kPq ? lightOfPq(code) : sceneOfHlg(code);
}

double compressedLight(double light) noexcept {
  static const double whole = pqOfLight(kHdrPeakCdM2), most = pqOfLight(kSdrWhiteCdM2) / whole, knee = 1.5 * most - 0.5;
  const double e = std::min(pqOfLight(light) / whole, 1.0);
  if (e <= knee) return light;
  const double t = (e - knee) / (1 - knee), t2 = t * t, t3 = t2 * t;
  const double spline = (2 * t3 - 3 * t2 + 1) * knee + (t3 - 2 * t2 + t) * (1 - knee) + (3 * t2 - 2 * t3) * most;
  return lightOfPq(spline * whole);
}

glm::dvec3 asSdr(const glm::dvec3& color, std::uint8_t transfer, std::uint8_t primaries) noexcept {
  if (hdrName(transfer) == nullptr) return color;
  glm::dvec3 light = lightOf(color, transfer);
  if (isBt2020(primaries)) light = glm::max(kBt709FromBt2020 * light, 0.0);
  const double brightest = std::max({light.r, light.g, light.b});
  if (brightest > 0) light *= compressedLight(brightest) / brightest;
  return {codeOf(light.r), codeOf(light.g), codeOf(light.b)};
}

}  // namespace relievo
