// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/eye_order.h"

#include <array>
#include <cmath>
#include <cstdlib>

#include "app/stereo/quick/small_view.h"

namespace relievo {
namespace {

constexpr int kBeside = 4;  // pixels on each side whose colours are compared
constexpr float kStep = 2;  // pixels of disparity
constexpr int kLeastRun = 2;
constexpr float kTold = 1.5F;       // a pixel counts if it is this many times as like one side as the other
constexpr float kLeastUnlike = 24;  // levels between the sides, of the three components together
constexpr float kEven = 1;          // pixels of disparity: of what lies on one side
constexpr float kMost = 0.8F;       // largest share of the run's pixels that are like one side

using Color = std::array<float, 3>;

Color meanOf(const ViewPicture& view, int r, int begin, int end) {
  Color mean{};
  for (int c = begin; c < end; ++c) {
    const std::uint8_t* p = view.pixel(c, r);
    for (std::size_t k = 0; k < 3; ++k) mean[k] += static_cast<float>(p[k]) / static_cast<float>(end - begin);
  }
  return mean;
}

float between(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

// True if both sides of a run were seen and are even: else the matcher's errors look like an area seen by one eye.
bool hasEvenSides(const DisparityMap& map, int r, int begin, int end) {
  const std::size_t before = map.at(begin - 1, r), after = map.at(end, r);
  for (std::size_t i = 0; i < kBeside; ++i) {
    if (map.seen[before - i] == 0 || std::abs(map.pixels[before - i] - map.pixels[before]) > kEven) return false;
    if (map.seen[after + i] == 0 || std::abs(map.pixels[after + i] - map.pixels[after]) > kEven) return false;
  }
  return true;
}

// A run belongs to one side as a whole.
void voteOnRun(const ViewPicture& view, int r, int begin, int end, EyeVotes& votes) {
  const Color before = meanOf(view, r, begin - kBeside, begin), after = meanOf(view, r, end, end + kBeside);
  if (between(before, after) < kLeastUnlike) return;
  int like_before = 0, like_after = 0;
  for (int c = begin; c < end; ++c) {
    const Color here = meanOf(view, r, c, c + 1);
    const float to_before = between(here, before), to_after = between(here, after);
    if (to_after > kTold * to_before) ++like_before;
    if (to_before > kTold * to_after) ++like_after;
  }
  const auto run = static_cast<float>(end - begin);
  if (static_cast<float>(like_before) >= kMost * run) votes.in_order += static_cast<std::uint64_t>(like_before);
  if (static_cast<float>(like_after) >= kMost * run) votes.swapped += static_cast<std::uint64_t>(like_after);
}

// The right view's own disparities, mirrored, for points that the left view has, too.
DisparityMap mirroredRight(const DisparityMap& map) {
  constexpr float kAgree = 1;  // pixels
  DisparityMap result(map.cols, map.rows);
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      const float found = map.from_right[map.at(c, r)];
      const std::size_t i = result.at(map.cols - 1 - c, r);
      result.pixels[i] = found;
      if (!std::isfinite(found)) continue;
      const int there = nearest(static_cast<float>(c) + found);
      const bool agrees = there >= 0 && there < map.cols && map.seen[map.at(there, r)] != 0 &&
                          std::abs(map.pixels[map.at(there, r)] - found) <= kAgree;
      result.seen[i] = agrees ? 1 : 0;
    }
  }
  return result;
}

EyeVotes voteOnView(const DisparityMap& map, const ViewPicture& view) {
  EyeVotes votes;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = kBeside; c < map.cols - kBeside; ++c) {
      if (map.seen[map.at(c, r)] != 0) continue;
      int end = c;
      while (end < map.cols && map.seen[map.at(end, r)] == 0) ++end;
      const bool inside = end + kBeside <= map.cols && map.seen[map.at(c - 1, r)] != 0;
      const float rise = inside ? map.pixels[map.at(end, r)] - map.pixels[map.at(c - 1, r)] : 0;
      const auto run = static_cast<float>(end - c);
      if (rise >= kStep && end - c >= kLeastRun && run < 2 * rise && rise < 2 * run && hasEvenSides(map, r, c, end))
        voteOnRun(view, r, c, end, votes);
      c = end;
    }
  }
  return votes;
}

}  // namespace

EyeVotes& EyeVotes::operator+=(const EyeVotes& other) noexcept {
  in_order += other.in_order;
  swapped += other.swapped;
  return *this;
}

bool EyeVotes::tell(std::uint64_t votes, std::uint64_t others) noexcept {
  constexpr std::uint64_t kLeast = 100, kLeastClear = 40, kClear = 8;
  if (2 * votes > 3 * others && votes > kLeast) return true;
  return votes > kLeastClear && votes > kClear * others;
}

EyeVotes voteOnEyes(const DisparityMap& map, const ViewPicture& left, const ViewPicture& right) {
  EyeVotes votes = voteOnView(map, left);
  ViewPicture mirrored = right;
  mirror(mirrored);
  votes += voteOnView(mirroredRight(map), mirrored);
  return votes;
}

}  // namespace relievo
