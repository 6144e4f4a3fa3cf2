// SPDX-License-Identifier: Apache-2.0
// Finds which codes or numbers the bytes of a picture's colours are.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "app/media/reading/code_count.h"
#include "app/media/reading/sample_parts.h"

namespace relievo {
namespace {

// Calls `compare` for each sample examined and the direction, left or up, in which there are `reach` others.
template <class Compare>
void compareBack(const Frame& frame, int reach, Compare compare) {
  for (int r = 0; r < frame.height; r += rowStep(frame)) {
    for (int c = 0; c < frame.width; ++c) {
      if (c >= reach) compare(c, r, 1, 0);
      if (r >= reach) compare(c, r, 0, 1);
    }
  }
}

// True if the lower byte continues where the upper one changes by one: on a slope it does nearly everywhere, beside an
// unrelated colour hardly ever.
bool carries(const Frame& frame, std::size_t upper, std::size_t lower) noexcept {
  constexpr std::uint64_t kLeast = 32;
  constexpr int kMostStep = 64;
  std::uint64_t changes = 0, carried = 0;
  compareBack(frame, 1, [&](int c, int r, int left, int up) {
    const auto step = [&](std::size_t part) {
      return static_cast<int>(partAt(frame, part, c, r)) - static_cast<int>(partAt(frame, part, c - left, r - up));
    };
    const int rise = step(upper);
    if (std::abs(rise) != 1) return;
    ++changes;
    if (std::abs(256 * rise + step(lower)) <= kMostStep) ++carried;
  });
  // For unrelated bytes 3 % would; the rest of a depth's changes are steep slopes or edges.
  return carried >= kLeast && 10 * carried >= changes;
}

// True if red, green and blue are a number, the lowest byte first: where red jumps, which is at least every 256 codes
// of a slope, the number goes on as it did. In no other picture do the bytes above red make good its jumps.
bool isNumber(const Frame& frame) noexcept {
  constexpr int kJump = 96, kMostBend = 64;
  constexpr std::uint64_t kLeast = 256;
  std::uint64_t jumps = 0, smooth = 0;
  compareBack(frame, 2, [&](int c, int r, int left, int up) {
    const auto number = [&](int i) { return static_cast<int>(numberAt(frame, c - i * left, r - i * up)); };
    const int here = number(0), before = number(1), first = number(2);
    if (std::abs((here & 0xff) - (before & 0xff)) < kJump) return;
    ++jumps;
    smooth += std::abs(here - 2 * before + first) <= kMostBend ? 1 : 0;
  });
  return jumps >= kLeast && 2 * smooth >= jumps;
}

// True if all numbers but white, the sky, have 20 bits.
bool areBelow20Bits(const Frame& frame) noexcept {
  constexpr std::uint32_t kWhite = 0xffffff, kBits = 20;
  for (int r = 0; r < frame.height; r += rowStep(frame)) {
    for (int c = 0; c < frame.width; ++c) {
      if (const std::uint32_t number = numberAt(frame, c, r); number != kWhite && number >> kBits != 0) return false;
    }
  }
  return true;
}

// True if nearly all samples are distances that differ little from their neighbours. In a picture with an opaque or a
// transparent alpha none is.
bool holdsFloats(const Frame& frame) noexcept {
  constexpr float kLeast = 0.01F, kMost = 1e5F, kAlike = 0.1F;
  if (!frame.alpha || frame.alpha->bits != 8) return false;
  std::uint64_t sound = 0, alike = 0, samples = 0;
  for (int r = 0; r < frame.height; r += rowStep(frame)) {
    float left = 0;
    for (int c = 0; c < frame.width; ++c, ++samples) {
      const float here = floatAt(frame, c, r);
      if (!(here >= kLeast && here <= kMost)) continue;  // NaN as well
      ++sound;
      if (std::abs(here - left) <= kAlike * here) ++alike;
      left = here;
    }
  }
  return 10 * sound >= 9 * samples && 10 * alike >= 8 * samples;
}

// The upper byte of a height changes every 256 m (Terrarium: 128 at the sea) or 6554 m (Mapbox: 1 at the sea), the next
// one from sample to sample. No picture of shades or hues has so few values of red beside so many of green.
SampleOrder terrainOrder(const Frame& frame) noexcept {
  constexpr std::uint32_t kDeepest = 85, kHighest = 163, kHighestOfMapbox = 2;
  constexpr int kMostRed = 24, kLeastGreen = 4;
  std::array<bool, 256> red{}, green{};
  std::uint64_t samples = 0, low = 0, terrarium = 0, mapbox = 0;
  for (int r = 0; r < frame.height; r += rowStep(frame)) {
    for (int c = 0; c < frame.width; ++c) {
      const std::uint32_t top = partAt(frame, 0, c, r) & 0xff, next = partAt(frame, 1, c, r) & 0xff;
      if (top == 0 && next == 0 && partAt(frame, 2, c, r) == 0) continue;  // no data
      ++samples;
      red[top] = green[next] = true;
      low += top == 0 ? 1 : 0;
      terrarium += top >= kDeepest && top <= kHighest ? 1 : 0;
      mapbox += top <= kHighestOfMapbox ? 1 : 0;
    }
  }
  const auto reds = std::count(red.begin(), red.end(), true), greens = std::count(green.begin(), green.end(), true);
  if (reds > kMostRed || greens < kLeastGreen) return SampleOrder::AsStored;
  if (mapbox == samples && 2 * low < samples) return carries(frame, 1, 2) ? SampleOrder::Mapbox : SampleOrder::AsStored;
  return terrarium == samples && (reds <= 2 || carries(frame, 0, 1)) ? SampleOrder::Terrarium : SampleOrder::AsStored;
}

}  // namespace

bool isConstant(const Frame& frame, std::size_t part) {
  std::uint64_t others = 0, samples = 0;
  const std::uint32_t usual = partAt(frame, part, frame.width / 2, frame.height / 2);
  for (int r = 0; r < frame.height; r += rowStep(frame)) {
    for (int c = 0; c < frame.width; ++c, ++samples) others += partAt(frame, part, c, r) != usual ? 1 : 0;
  }
  return 100 * others <= samples;
}

SampleOrder packedOrder(const Frame& depth) {
  if (!isPackable(depth)) return SampleOrder::AsStored;
  if (holdsFloats(depth)) return SampleOrder::FloatBytes;
  if (const SampleOrder terrain = terrainOrder(depth); terrain != SampleOrder::AsStored) return terrain;
  if (!isConstant(depth, 2)) {  // of 24 bits the upper 16, whichever end is the upper one
    if (isNumber(depth)) return areBelow20Bits(depth) ? SampleOrder::Below20 : SampleOrder::BlueGreen;
    if (carries(depth, 0, 1)) return SampleOrder::RedGreen;
    if (isConstant(depth, 0) && carries(depth, 1, 2)) return SampleOrder::GreenBlue;
    return carries(depth, 2, 1) ? SampleOrder::BlueGreen : SampleOrder::AsStored;
  }
  if (carries(depth, 0, 1)) return SampleOrder::RedGreen;
  return carries(depth, 1, 0) ? SampleOrder::GreenRed : SampleOrder::AsStored;
}

}  // namespace relievo
