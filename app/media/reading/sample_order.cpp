// SPDX-License-Identifier: Apache-2.0
// Finds how a gray picture stores the bits of its codes, and puts the codes in order.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <vector>

#include "app/media/reading/code_count.h"
#include "app/media/reading/sample_parts.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

std::uint32_t swapped(std::uint32_t code) noexcept {
  return (code >> 8 | code << 8) & kTop;
}
std::uint32_t ordered(std::uint32_t code, const SampleOrder& order) noexcept {
  if (order == SampleOrder::Low13) return code & 0x1fff;
  if (order == SampleOrder::Upper13) return code >> 3;
  if (order == SampleOrder::RotatedLeft3) return (code >> 3 | code << 13) & kTop;
  return order == SampleOrder::Swapped ? swapped(code) : code;
}

bool isGray16(const Frame& frame) noexcept {
  return frame.model == ColorModel::Gray && frame.components[0].bits == 16;
}

bool isPackedOrder(const SampleOrder& order) noexcept {
  return order == SampleOrder::RedGreen || order == SampleOrder::GreenRed || order == SampleOrder::GreenBlue ||
         order == SampleOrder::BlueGreen || order == SampleOrder::Below20 || order == SampleOrder::FloatBytes ||
         isTerrain(order);
}

std::uint32_t grayAt(const Frame& frame, int c, int r) noexcept {
  return partAt(frame, 0, c, r);
}

std::uint32_t terrainAt(const Frame& frame, int c, int r, const SampleOrder& order) noexcept {
  constexpr double kLowest = -11000, kCodesAMetre = 3.2;
  const std::uint32_t number = partAt(frame, 0, c, r) << 16 | partAt(frame, 1, c, r) << 8 | partAt(frame, 2, c, r);
  if (number == 0) return 0;
  const double metres = order == SampleOrder::Terrarium ? number / 256.0 - 32768 : number / 10.0 - 10000;
  return static_cast<std::uint32_t>(std::clamp(std::round((metres - kLowest) * kCodesAMetre), 1.0, double{kTop}));
}

// Distances that 16 bits cannot hold are the sky: 65535.
std::uint32_t codeOf(float metres) noexcept {
  constexpr float kCodesAMetre = 250;
  return metres > 0 && metres * kCodesAMetre < static_cast<float>(kTop)
             ? static_cast<std::uint32_t>(std::lround(metres * kCodesAMetre))
             : kTop;
}

float halfOf(std::uint32_t bits) noexcept {
  constexpr int kMantissaBits = 10, kBias = 15;
  constexpr std::uint32_t kInfinite = 31, kOne = 1u << kMantissaBits;
  const std::uint32_t exponent = bits >> kMantissaBits, mantissa = bits & (kOne - 1);  // the sign counts as too large
  if (exponent >= kInfinite) return 0;
  const auto significand = static_cast<float>(exponent == 0 ? mantissa : kOne + mantissa);
  return std::ldexp(significand, std::max(1, static_cast<int>(exponent)) - kBias - kMantissaBits);
}

// The depth at `code` along the ray of a pinhole camera with the picture's centre as its principal point; its focal
// lengths are shares of the picture's width and height.
std::uint32_t depthAlongRay(const Frame& frame, int c, int r, std::uint32_t code, double focal_x, double focal_y) {
  if (code == kTop) return code;  // a hole
  const double x = (c - 0.5 * frame.width) / (focal_x * frame.width);
  const double y = (r - 0.5 * frame.height) / (focal_y * frame.height);
  return static_cast<std::uint32_t>(std::lround(code / std::sqrt(1 + x * x + y * y)));
}

std::uint32_t orderedAt(const Frame& frame, int c, int r, const SampleOrder& order) noexcept {
  if (order == SampleOrder::FloatBytes) return codeOf(floatAt(frame, c, r));
  if (order == SampleOrder::HalfFloat) return codeOf(halfOf(grayAt(frame, c, r)));
  // 600 of 640 x 480 pixels; 60 x 45 degrees.
  if (order == SampleOrder::AlongRay) return depthAlongRay(frame, c, r, grayAt(frame, c, r), 0.9375, 1.25);
  if (order == SampleOrder::AlongWideRay) return depthAlongRay(frame, c, r, grayAt(frame, c, r), 0.866025, 1.207107);
  if (isTerrain(order)) return terrainAt(frame, c, r, order);
  if (order == SampleOrder::Below20) return std::min(numberAt(frame, c, r) >> 4, kTop);
  if (!isPackedOrder(order)) return ordered(grayAt(frame, c, r), order);
  const std::uint32_t red = partAt(frame, 0, c, r), green = partAt(frame, 1, c, r);
  if (order == SampleOrder::BlueGreen) return partAt(frame, 2, c, r) << 8 | green;
  if (order == SampleOrder::GreenBlue) return green << 8 | partAt(frame, 2, c, r);
  return order == SampleOrder::RedGreen ? red << 8 | green : green << 8 | red;
}

// Gray, or the luma of a film.
bool hasSteps(const Frame& frame) noexcept {
  return frame.model != ColorModel::Rgb && frame.components[0].bits == EvenSteps::kBits;
}

// The code of 16 bits for each of 12.
std::vector<std::uint16_t> codesOf(const EvenSteps& steps) {
  constexpr int kCodes = 1 << EvenSteps::kBits;
  const double near = static_cast<double>(steps.nearest_mm), far = static_cast<double>(steps.farthest_mm);
  const double shift = static_cast<double>(steps.shift_mm);
  std::vector<std::uint16_t> codes(kCodes);
  for (int code = 1; code < kCodes; ++code) {
    const double share = static_cast<double>(code) / (kCodes - 1);
    const double mm = steps.logarithmic ? (near + shift) * std::pow((far + shift) / (near + shift), share) - shift
                                        : near + share * (far - near);
    codes[static_cast<std::size_t>(code)] =
        static_cast<std::uint16_t>(std::clamp(std::round(mm / steps.unitMm()), 1.0, double{kTop}));
  }
  return codes;
}

// The samples of `depth` as gray of 16 bits: code(c, r).
template <class Code>
Frame recoded(const Frame& depth, Code&& code) {
  auto samples = std::make_shared<std::vector<std::uint16_t>>();
  samples->reserve(static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height));
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 0; c < depth.width; ++c) samples->push_back(static_cast<std::uint16_t>(code(c, r)));
  }
  Frame frame = grayFrame(std::move(samples), depth.width, depth.height);
  frame.pts = depth.pts;
  frame.duration = depth.duration;
  frame.sample_aspect = depth.sample_aspect;
  return frame;
}

}  // namespace

bool isSwapped(const Frame& depth) {
  constexpr int kClearly = 8, kLeastDifferent = 2;
  if (!isGray16(depth)) return false;
  std::uint64_t as_stored = 0, as_swapped = 0;
  std::array<std::uint64_t, 256> low_bytes{};
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 1; c < depth.width; ++c) {
      const std::uint32_t left = grayAt(depth, c - 1, r), here = grayAt(depth, c, r);
      if (left == 0 || here == 0) continue;
      const auto difference = [](std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; };
      as_stored += difference(left, here);
      as_swapped += difference(swapped(left), swapped(here));
      ++low_bytes[here & 0xff];
    }
  }
  // 8 bits in the upper half of 16, or steps of a whole upper byte, are alike in either order.
  const auto different = std::count_if(low_bytes.begin(), low_bytes.end(), [](std::uint64_t n) { return n > 0; });
  return different >= kLeastDifferent && as_stored > kClearly * as_swapped;
}

bool hasConfidence(const Frame& depth) {
  constexpr std::uint32_t kLow = 0x1fff;
  constexpr std::uint64_t kClearly = 32;
  if (!isGray16(depth)) return false;
  std::uint64_t as_stored = 0, below = 0;
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 1; c < depth.width; ++c) {
      const auto left = static_cast<int>(grayAt(depth, c - 1, r)), here = static_cast<int>(grayAt(depth, c, r));
      if (std::min(left, here) == 0 || std::max(left, here) == static_cast<int>(kTop)) continue;
      as_stored += static_cast<std::uint64_t>(std::abs(here - left));
      below += static_cast<std::uint64_t>(std::abs(static_cast<int>(here & kLow) - static_cast<int>(left & kLow)));
    }
  }
  return as_stored > kClearly * below;
}

bool isRotated(const CodeCount& count) {
  constexpr double kMost = 0.95;
  return count.remainders(8, 1) >= kMost && count.remainders(16, 0) < kMost;
}

bool hasPlayers(const CodeCount& count) {
  constexpr double kBackground = 0.5, kLeast = 1e-3, kOutliers = 0.002;
  constexpr std::uint32_t kNearest = 8 * 300, kFarthest = 8 * 7500;  // a Kinect sees from 0.4 m on
  const CodeCount all = count.together();
  const double background = all.remainders(8, 0);
  const auto reach = all.reach(kOutliers, 1, kTop);
  return background >= kBackground && background < 1 - kLeast && all.remainders(8, 6) == 1 && reach.low >= kNearest &&
         reach.high < kFarthest;
}

bool hasEqualColors(const Frame& depth) noexcept {
  if (depth.model != ColorModel::Rgb || depth.components[0].bits <= 8) return false;
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 0; c < depth.width; ++c) {
      const std::uint32_t red = partAt(depth, 0, c, r);
      if (red != partAt(depth, 1, c, r) || red != partAt(depth, 2, c, r)) return false;
    }
  }
  return true;
}

SampleOrder orderOf(const KnownKind* kind, const Frame& stored) {
  if (kind != nullptr && kind->order != SampleOrder::AsStored) return orderOf(*kind, stored);
  return hasEqualColors(stored) ? SampleOrder::EqualColors : SampleOrder::AsStored;
}

SampleOrder orderOf(const KnownKind& kind, const Frame& stored) {
  constexpr std::uint32_t kRawHole = 2047;
  const bool raw = kind.order == SampleOrder::Swapped && kind.inverse.offset > 0 && isGray16(stored);
  return raw && CodeCount(stored).share(kRawHole + 1, kTop) == 0 ? SampleOrder::AsStored : kind.order;
}

Result<Frame> inOrder(const Frame& depth, const SampleOrder& order) {
  if (order == SampleOrder::EqualColors && depth.model == ColorModel::Rgb) {
    Frame gray = depth;
    gray.model = ColorModel::Gray;
    gray.alpha.reset();
    return gray;
  }
  bool stored_so = isPackedOrder(order)          ? isPackable(depth)
                   : order == SampleOrder::Steps ? hasSteps(depth)
                                                 : isGray16(depth);
  if (order == SampleOrder::FloatBytes) stored_so = stored_so && depth.alpha.has_value();
  if (order == SampleOrder::AsStored || !stored_so) return depth;
  try {
    if (order == SampleOrder::Steps) {
      const std::vector<std::uint16_t> codes = codesOf(order.steps());
      return recoded(depth, [&](int c, int r) { return codes[grayAt(depth, c, r) % codes.size()]; });
    }
    return recoded(depth, [&](int c, int r) { return orderedAt(depth, c, r, order); });
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Exhausted, "out of memory for a picture");
  }
}

}  // namespace relievo
