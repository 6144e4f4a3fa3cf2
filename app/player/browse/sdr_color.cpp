// SPDX-License-Identifier: Apache-2.0
// Light in cd/m2, the primaries' matrix, then the curve of ITU-R BT.2390-11, 5.4.1, for the brightest component: the
// others keep their ratio to it, so that no hue changes.
#include "app/player/browse/sdr_color.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

constexpr std::uint8_t kPq = 16, kHlg = 18, kBt2020 = 9;  // ITU-T H.273
constexpr double kWhite = 203;                            // cd/m2: ITU-R BT.2408, table 1
constexpr double kPeak = 1000;                            // likewise, of most masters
constexpr double kGamma = 2.4;                            // ITU-R BT.1886

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

PictureColor times(const PictureColor& color, double factor) noexcept {
  return {color.red * factor, color.green * factor, color.blue * factor};
}

PictureColor lightOf(const PictureColor& color, std::uint8_t transfer) noexcept {
  if (transfer == kPq) return {lightOfPq(color.red), lightOfPq(color.green), lightOfPq(color.blue)};
  constexpr double kSystemGamma = 1.2;  // of a screen of 1000 cd/m2
  const PictureColor scene{sceneOfHlg(color.red), sceneOfHlg(color.green), sceneOfHlg(color.blue)};
  const double luminance = 0.2627 * scene.red + 0.6780 * scene.green + 0.0593 * scene.blue;
  return times(scene, kPeak * std::pow(luminance, kSystemGamma - 1));
}

// ITU-R BT.2087-0, annex 1.
PictureColor inBt709(const PictureColor& c) noexcept {
  return {std::max(0.0, 1.6605 * c.red - 0.5876 * c.green - 0.0728 * c.blue),
          std::max(0.0, -0.1246 * c.red + 1.1329 * c.green - 0.0083 * c.blue),
          std::max(0.0, -0.0182 * c.red - 0.1006 * c.green + 1.1187 * c.blue)};
}

// At most kWhite.
double compressed(double light) noexcept {
  static const double whole = pqOfLight(kPeak), most = pqOfLight(kWhite) / whole, knee = 1.5 * most - 0.5;
  const double e = std::min(pqOfLight(light) / whole, 1.0);
  if (e <= knee) return light;
  const double t = (e - knee) / (1 - knee), t2 = t * t, t3 = t2 * t;
  const double spline = (2 * t3 - 3 * t2 + 1) * knee + (t3 - 2 * t2 + t) * (1 - knee) + (3 * t2 - 2 * t3) * most;
  return lightOfPq(spline * whole);
}

double codeOf(double light) noexcept {
  return std::pow(std::clamp(light / kWhite, 0.0, 1.0), 1 / kGamma);
}

}  // namespace

PictureColor asSdr(const PictureColor& color, std::uint8_t transfer, std::uint8_t primaries) noexcept {
  if (transfer != kPq && transfer != kHlg) return color;
  PictureColor light = lightOf(color, transfer);
  if (primaries == kBt2020 || primaries == kUnspecifiedColor) light = inBt709(light);
  const double brightest = std::max({light.red, light.green, light.blue});
  if (brightest > 0) light = times(light, compressed(brightest) / brightest);
  return {codeOf(light.red), codeOf(light.green), codeOf(light.blue)};
}

}  // namespace relievo
