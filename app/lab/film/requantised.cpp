// SPDX-License-Identifier: Apache-2.0
// Rounds sample by sample.
#include "app/lab/film/requantised.h"

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "app/lab/film/colored_depth.h"

namespace relievo {
namespace {

constexpr double kNearMm = 500, kFarMm = 2000;
constexpr double kTruthHighest = 65535;

// From -1/2 to 1/2 of a step (Bayer 1973).
double ditherAt(int c, int r) {
  static constexpr std::array<int, 4> kQuarter{0, 2, 3, 1};  // [(r & 1) * 2 + (c & 1)]
  int rank = 0;
  for (int bit = 0; bit < 3; ++bit) {
    const int quarter = ((r >> bit) & 1) * 2 + ((c >> bit) & 1);
    rank = 4 * rank + kQuarter.at(static_cast<std::size_t>(quarter));
  }
  return (rank + 0.5) / 64 - 0.5;
}

// The normalised code of the inverse law for a height, as a share of the volume's depth.
double byDisparity(double height) {
  const double distance = kFarMm - height * (kFarMm - kNearMm);
  return (1 / distance - 1 / kFarMm) / (1 / kNearMm - 1 / kFarMm);
}

}  // namespace

const char* name(DepthSteps steps) noexcept {
  switch (steps) {
    case DepthSteps::Even:
      return "even";
    case DepthSteps::Dithered:
      return "dithered";
    case DepthSteps::Disparity:
      return "disparity";
    case DepthSteps::Hue:
      return "hue";
    case DepthSteps::HueDisparity:
      return "hue-disparity";
    case DepthSteps::Turbo:
      return "turbo";
  }
  return "";
}

DepthCalibration meaningOf(int bits, DepthSteps steps) noexcept {
  if (steps == DepthSteps::Turbo) return {.code = DepthCode::Turbo};
  if (steps == DepthSteps::Hue) return {.polarity = DepthPolarity::NearIsLow, .code = DepthCode::Hue};
  if (steps == DepthSteps::HueDisparity) {
    return {.law = DepthLaw::Inverse, .code = DepthCode::Hue, .near_mm = kNearMm, .far_mm = kFarMm};
  }
  if (steps != DepthSteps::Disparity) return {.bits = bits};
  return {.law = DepthLaw::Inverse, .bits = bits, .near_mm = kNearMm, .far_mm = kFarMm};
}

Frame requantised(const Frame& depth, int bits, DepthSteps steps) {
  if (steps >= DepthSteps::Hue) return colored(depth, meaningOf(bits, steps));
  const std::size_t bytes = bits > 8 ? 2 : 1;
  const std::size_t stride = static_cast<std::size_t>(depth.width) * bytes;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(stride * static_cast<std::size_t>(depth.height));
  const double highest = std::exp2(bits) - 1;
  std::uint8_t* out = samples->data();
  for (int r = 0; r < depth.height; ++r) {
    const std::uint8_t* in = depth.planes[0].data + r * depth.planes[0].stride_bytes;
    for (int c = 0; c < depth.width; ++c, in += 2, out += bytes) {
      const double height = (in[0] | in[1] << 8) / kTruthHighest;
      double code = highest * (steps == DepthSteps::Disparity ? byDisparity(height) : height);
      if (steps == DepthSteps::Dithered) code += ditherAt(c, r);
      const auto rounded = static_cast<std::uint16_t>(std::lround(std::clamp(code, 0.0, highest)));
      out[0] = static_cast<std::uint8_t>(rounded);
      if (bytes == 2) out[1] = static_cast<std::uint8_t>(rounded >> 8);
    }
  }
  Frame frame = depth;
  frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(bytes), .bits = static_cast<std::uint8_t>(bits)};
  frame.planes[0] = {samples->data(), static_cast<std::ptrdiff_t>(stride)};
  frame.owner = samples;
  return frame;
}

void HeightErrorSum::add(const HeightField& felt, const HeightField& truth) {
  for (int r = 0; r < truth.rows(); ++r) {
    for (int c = 0; c < truth.cols(); ++c) {
      const double error = std::abs(felt.heightMm(c, r) - truth.heightMm(c, r));
      if (std::isnan(error)) continue;  // a hole
      squares_ += error * error;
      largest_ = std::max(largest_, error);
      ++count_;
    }
  }
}

}  // namespace relievo
