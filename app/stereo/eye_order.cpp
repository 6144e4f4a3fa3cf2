// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/eye_order.h"

#include <array>
#include <cmath>
#include <cstdlib>

namespace relievo {
namespace {

constexpr int kBeside = 4;  // pixels on each side whose colours are compared
constexpr float kStep = 2;  // pixels of disparity
constexpr int kLeastRun = 2;
constexpr float kTold = 1.5F;       // times as like one side as the other
constexpr float kLeastUnlike = 24;  // levels between the sides, of the three components together

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

void voteOnRun(const ViewPicture& left, int r, int begin, int end, EyeVotes& votes) {
  const Color before = meanOf(left, r, begin - kBeside, begin), after = meanOf(left, r, end, end + kBeside);
  if (between(before, after) < kLeastUnlike) return;
  for (int c = begin; c < end; ++c) {
    const Color here = meanOf(left, r, c, c + 1);
    const float to_before = between(here, before), to_after = between(here, after);
    if (to_after > kTold * to_before) ++votes.in_order;
    if (to_before > kTold * to_after) ++votes.swapped;
  }
}

}  // namespace

EyeVotes& EyeVotes::operator+=(const EyeVotes& other) noexcept {
  in_order += other.in_order;
  swapped += other.swapped;
  return *this;
}

bool EyeVotes::areSwapped() const noexcept {
  constexpr std::uint64_t kLeast = 100;
  return swapped > kLeast && 2 * swapped > 3 * in_order;
}

EyeVotes voteOnEyes(const DisparityMap& map, const ViewPicture& left) {
  EyeVotes votes;
  for (int r = 0; r < map.rows; ++r) {
    for (int c = kBeside; c < map.cols - kBeside; ++c) {
      if (map.seen[map.at(c, r)] != 0) continue;
      int end = c;
      while (end < map.cols && map.seen[map.at(end, r)] == 0) ++end;
      const bool inside = end + kBeside <= map.cols && map.seen[map.at(c - 1, r)] != 0;
      const float rise = inside ? map.pixels[map.at(end, r)] - map.pixels[map.at(c - 1, r)] : 0;
      const auto run = static_cast<float>(end - c);
      if (rise >= kStep && end - c >= kLeastRun && run < 2 * rise && rise < 2 * run) voteOnRun(left, r, c, end, votes);
      c = end;
    }
  }
  return votes;
}

}  // namespace relievo
