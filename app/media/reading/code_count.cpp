// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/code_count.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <numeric>

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

std::uint32_t swapped(std::uint32_t code) noexcept {
  return (code >> 8 | code << 8) & kTop;
}
std::uint32_t ordered(std::uint32_t code, SampleOrder order) noexcept {
  if (order == SampleOrder::Low13) return code & 0x1fff;
  if (order == SampleOrder::RotatedLeft3) return (code >> 3 | code << 13) & kTop;
  return order == SampleOrder::Swapped ? swapped(code) : code;
}

bool isGray16(const Frame& frame) noexcept {
  return frame.model == ColorModel::Gray && frame.components[0].bits == 16;
}

bool isPackable(const Frame& frame) noexcept {
  return frame.model == ColorModel::Rgb && frame.components[0].bits == 8;
}
bool isPackedOrder(SampleOrder order) noexcept {
  return order == SampleOrder::RedGreen || order == SampleOrder::GreenRed || order == SampleOrder::BlueGreen;
}

std::uint32_t partAt(const Frame& frame, std::size_t part, int c, int r) noexcept {
  const Component& k = frame.components[part];
  const Plane& plane = frame.planes[k.plane];
  return codeAt(k, plane.data + r * plane.stride_bytes + k.offset_bytes + std::ptrdiff_t{c} * k.step_bytes);
}

// Whether the lower byte runs on where the upper one changes by one: on a slope that is so nearly everywhere, beside a
// colour that has nothing to do with it hardly ever.
bool carries(const Frame& frame, std::size_t upper, std::size_t lower) noexcept {
  constexpr std::uint64_t kLeast = 32;
  constexpr int kMostStep = 64;
  std::uint64_t changes = 0, carried = 0;
  const auto compare = [&](int c, int r, int left, int up) {
    const auto step = [&](std::size_t part) {
      return static_cast<int>(partAt(frame, part, c, r)) - static_cast<int>(partAt(frame, part, c - left, r - up));
    };
    const int rise = step(upper);
    if (std::abs(rise) != 1) return;
    ++changes;
    if (std::abs(256 * rise + step(lower)) <= kMostStep) ++carried;
  };
  for (int r = 0; r < frame.height; ++r) {
    for (int c = 0; c < frame.width; ++c) {
      if (c > 0) compare(c, r, 1, 0);
      if (r > 0) compare(c, r, 0, 1);
    }
  }
  // Of bytes that have nothing to do with each other 3 % would; the rest of a depth's are steep or edges.
  return carried >= kLeast && 10 * carried >= 3 * changes;
}

std::uint32_t grayAt(const Frame& frame, int c, int r) noexcept {
  return partAt(frame, 0, c, r);
}

std::uint32_t orderedAt(const Frame& frame, int c, int r, SampleOrder order) noexcept {
  if (!isPackedOrder(order)) return ordered(grayAt(frame, c, r), order);
  const std::uint32_t red = partAt(frame, 0, c, r), green = partAt(frame, 1, c, r);
  if (order == SampleOrder::BlueGreen) return partAt(frame, 2, c, r) << 8 | green;
  return order == SampleOrder::RedGreen ? red << 8 | green : green << 8 | red;
}

}  // namespace

CodeCount::CodeCount(const Frame& depth) : bits_(std::max<int>(8, depth.components[0].bits)) {
  of_code_.assign(std::size_t{1} << bits_, 0);
  const Component& k = depth.components[depth.model == ColorModel::Rgb ? 1 : 0];
  const Plane& plane = depth.planes[k.plane];
  for (int r = 0; r < depth.height; ++r) {
    const std::uint8_t* at = plane.data + r * plane.stride_bytes + k.offset_bytes;
    for (int c = 0; c < depth.width; ++c, at += k.step_bytes) ++of_code_[codeAt(k, at) & (of_code_.size() - 1)];
  }
  samples_ = static_cast<std::uint64_t>(depth.width) * static_cast<std::uint64_t>(depth.height);
}

double CodeCount::share(std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  if (low > high || samples_ == 0) return 0;
  const auto sum = std::accumulate(of_code_.begin() + low, of_code_.begin() + high + 1, std::uint64_t{0});
  return static_cast<double>(sum) / static_cast<double>(samples_);
}

double CodeCount::share(const CodeSet& set) const {
  return samples_ == 0 ? 0 : 1 - static_cast<double>(without(set).samples_) / static_cast<double>(samples_);
}

std::uint32_t CodeCount::quantile(double q, std::uint32_t low, std::uint32_t high) const {
  high = std::min<std::uint32_t>(high, static_cast<std::uint32_t>(of_code_.size()) - 1);
  double left = q * share(low, high) * static_cast<double>(samples_);
  for (std::uint32_t code = low; code <= high; ++code) {
    if (of_code_[code] == 0) continue;
    left -= static_cast<double>(of_code_[code]);
    if (left <= 0) return code;
  }
  return low;
}

CodeCount::Reach CodeCount::reach(double outliers, std::uint32_t low, std::uint32_t high) const {
  Reach reach{quantile(outliers, low, high), quantile(1 - outliers, low, high)};
  for (const CodeCount& later : later_) {
    if (later.bits_ != bits_ || later.share(low, high) == 0) continue;
    reach.low = std::min(reach.low, later.quantile(outliers, low, high));
    reach.high = std::max(reach.high, later.quantile(1 - outliers, low, high));
  }
  return reach;
}

CodeCount CodeCount::together() const {
  CodeCount all = *this;
  all.later_.clear();
  for (const CodeCount& later : later_) {
    if (later.bits_ != bits_) continue;
    all.samples_ += later.samples_;
    for (std::size_t code = 0; code < of_code_.size(); ++code) all.of_code_[code] += later.of_code_[code];
  }
  return all;
}

std::uint32_t CodeCount::step() const {
  std::uint32_t step = 0;
  for (std::uint32_t code = 0; code < of_code_.size(); ++code) {
    if (of_code_[code] > 0 && code != kTop) step = std::gcd(step, code);
  }
  return step;
}

double CodeCount::remainders(std::uint32_t divisor, std::uint32_t most) const {
  std::uint64_t fit = 0, all = 0;
  for (std::uint32_t code = 1; code < of_code_.size() && code < kTop; ++code) {
    all += of_code_[code];
    if (code % divisor <= most) fit += of_code_[code];
  }
  return all == 0 ? 0 : static_cast<double>(fit) / static_cast<double>(all);
}

int CodeCount::kinds() const {
  return static_cast<int>(std::count_if(of_code_.begin(), of_code_.end(), [](std::uint64_t n) { return n > 0; }));
}

CodeCount CodeCount::without(const CodeSet& set) const {
  CodeCount rest = *this;
  for (std::uint32_t code = 0; code < of_code_.size(); ++code) {
    if (!set.contains(code)) continue;
    rest.samples_ -= rest.of_code_[code];
    rest.of_code_[code] = 0;
  }
  for (CodeCount& later : rest.later_) later = later.without(set);
  return rest;
}

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

SampleOrder packedOrder(const Frame& depth) {
  if (!isPackable(depth)) return SampleOrder::AsStored;
  std::uint64_t other_blue = 0;
  const std::uint32_t blue = partAt(depth, 2, depth.width / 2, depth.height / 2);
  for (int r = 0; r < depth.height; ++r) {
    for (int c = 0; c < depth.width; ++c) other_blue += partAt(depth, 2, c, r) != blue ? 1 : 0;
  }
  const std::uint64_t samples = static_cast<std::uint64_t>(depth.width) * static_cast<std::uint64_t>(depth.height);
  if (100 * other_blue > samples) {  // of 24 bits the upper 16, whichever end is the upper one
    if (carries(depth, 0, 1)) return SampleOrder::RedGreen;
    return carries(depth, 2, 1) ? SampleOrder::BlueGreen : SampleOrder::AsStored;
  }
  if (carries(depth, 0, 1)) return SampleOrder::RedGreen;
  return carries(depth, 1, 0) ? SampleOrder::GreenRed : SampleOrder::AsStored;
}

bool isScattered(const Frame& depth) {
  if (!isGray16(depth)) return false;
  std::uint64_t readings = 0, alone = 0;
  for (int r = 1; r + 1 < depth.height; ++r) {
    for (int c = 1; c + 1 < depth.width; ++c) {
      if (grayAt(depth, c, r) == 0) continue;
      const int beside = (grayAt(depth, c - 1, r) != 0 ? 1 : 0) + (grayAt(depth, c + 1, r) != 0 ? 1 : 0) +
                         (grayAt(depth, c, r - 1) != 0 ? 1 : 0) + (grayAt(depth, c, r + 1) != 0 ? 1 : 0);
      ++readings;
      if (beside <= 2) ++alone;
    }
  }
  return readings > 0 && 2 * alone > readings;
}

SampleOrder orderOf(const KnownKind& kind, const Frame& stored) {
  constexpr std::uint32_t kRawHole = 2047;
  const bool raw = kind.order == SampleOrder::Swapped && kind.inverse.offset > 0 && isGray16(stored);
  return raw && CodeCount(stored).share(kRawHole + 1, kTop) == 0 ? SampleOrder::AsStored : kind.order;
}

Result<Frame> inOrder(const Frame& depth, SampleOrder order) {
  const bool stored_so = isPackedOrder(order) ? isPackable(depth) : isGray16(depth);
  if (order == SampleOrder::AsStored || !stored_so) return depth;
  try {
    auto samples = std::make_shared<std::vector<std::uint16_t>>();
    samples->reserve(static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height));
    for (int r = 0; r < depth.height; ++r) {
      for (int c = 0; c < depth.width; ++c) {
        samples->push_back(static_cast<std::uint16_t>(orderedAt(depth, c, r, order)));
      }
    }
    Frame frame = grayFrame(std::move(samples), depth.width, depth.height);
    frame.pts = depth.pts;
    frame.duration = depth.duration;
    frame.sample_aspect = depth.sample_aspect;
    return frame;
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::Exhausted, "out of memory for a picture");
  }
}

}  // namespace relievo
