// SPDX-License-Identifier: Apache-2.0
// Adds up the motions from picture to picture.
#include "app/author/material/map_follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace relievo {
namespace {

constexpr MapFollower::Place kNowhere{-1, -1};
constexpr double kOutside = 0.75;  // samples beyond the last one

}  // namespace

void MapFollower::add(GrayPicture picture) {
  if (last_ && last_->bytes != picture.bytes) {
    const std::vector<Motion> motion = motionBetween(*last_, picture), back = motionBetween(picture, *last_);
    const std::vector<bool> is_new = uncovered(*last_, picture, motion, back);
    std::vector<Place> places;
    places.reserve(places_.size());
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const int c = static_cast<int>(i) % picture.cols, r = static_cast<int>(i) / picture.cols;
      const Motion& from = motion[i];
      places.push_back(is_new[i] ? kNowhere
                                 : placeBefore(c + static_cast<double>(from.x), r + static_cast<double>(from.y)));
    }
    places_ = std::move(places);
  }
  const bool is_first = !last_;
  last_ = std::move(picture);
  if (is_first) begin();
}

void MapFollower::begin() {
  places_.clear();
  for (int r = 0; r < last_->rows; ++r) {
    for (int c = 0; c < last_->cols; ++c) places_.push_back({static_cast<float>(c), static_cast<float>(r)});
  }
}

void MapFollower::cut() {
  std::ranges::fill(places_, kNowhere);
}

// Interpolates between samples of one object; at an object's edge takes the nearest one's place.
MapFollower::Place MapFollower::placeBefore(double x, double y) const {
  const int cols = last_->cols, rows = last_->rows;
  if (x < -kOutside || y < -kOutside || x > cols - 1 + kOutside || y > rows - 1 + kOutside) return kNowhere;
  x = std::clamp(x, 0.0, cols - 1.0);
  y = std::clamp(y, 0.0, rows - 1.0);
  const auto at = [&](double c, double r) {
    return places_[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + static_cast<std::size_t>(c)];
  };
  const Place nearest = at(std::floor(x + 0.5), std::floor(y + 0.5));
  const double c = std::min(std::floor(x), cols - 2.0), r = std::min(std::floor(y), rows - 2.0);
  const std::array<Place, 4> around{at(c, r), at(c + 1, r), at(c, r + 1), at(c + 1, r + 1)};
  for (const Place& place : around) {
    if (place.x < 0 || std::abs(place.x - nearest.x) + std::abs(place.y - nearest.y) > 3) return nearest;
  }
  const auto s = static_cast<float>(x - c), t = static_cast<float>(y - r);
  const auto mix = [&](float Place::* part) {
    const float upper = around[0].*part + s * (around[1].*part - around[0].*part);
    const float lower = around[2].*part + s * (around[3].*part - around[2].*part);
    return upper + t * (lower - upper);
  };
  return {mix(&Place::x), mix(&Place::y)};
}

}  // namespace relievo
