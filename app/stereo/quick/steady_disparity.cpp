// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/steady_disparity.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace relievo {
namespace {

constexpr int kMotionCols = 160;      // in which motion is looked for
constexpr int kSameColor = 12;        // levels of the three components, over 3 x 3 pixels in the mean
constexpr float kSurface = 0.75F;     // pixels of disparity between two surfaces
constexpr std::uint8_t kMemory = 24;  // pictures
constexpr int kMovingMemory =
    5;  // pictures, for objects that come nearer or go away, whose change is known only roughly
constexpr std::uint8_t kPatience = 8;   // pictures in a row that found another surface
constexpr std::uint8_t kConfirmed = 2;  // likewise, where both views show it
constexpr float kStep = 2;    // pixels of disparity: what comes nearer changes by less from picture to picture
constexpr int kInferred = 3;  // seen pictures that an inferred disparity counts less than
constexpr int kBeside = 3;    // pixels on each side that are compared to choose a surface
constexpr int kPlainly = 2;   // gray levels a pixel by which the other surface must fit better to be taken

bool isNear(float a, float b) noexcept {
  return std::abs(a - b) < kSurface;
}

}  // namespace

void SteadyDisparity::steady(DisparityMap& map, const ViewPicture& left, const ViewPicture& right) {
  left_ = left.bytes;
  lumaOf(left, left_luma_);
  lumaOf(right, right_luma_);
  const int cols = std::min(kMotionCols, map.cols), rows = std::max(1, map.rows * cols / map.cols);
  GrayPicture now = scaledTo(cols, rows, left_luma_.data(), map.cols, map.rows);
  const bool goes_on =
      before_ && before_->cols == now.cols && before_->rows == now.rows && disparity_.size() == map.size();
  if (goes_on) follow(map, now);
  else was_.assign(map.size(), {});
  findChanges(map);
  average(map);
  before_ = std::move(now);
  left_before_.swap(left_);
}

// Takes the pixel's own place if it has not moved, or the place that its neighbourhood has moved from: the one whose
// surface was found now.
void SteadyDisparity::follow(DisparityMap& map, const GrayPicture& now) {
  const std::vector<Motion> motion =
      before_->bytes == now.bytes ? std::vector<Motion>(now.size()) : motionBetween(*before_, now);
  const float scale = static_cast<float>(map.cols) / static_cast<float>(now.cols);
  std::vector<int> columns(static_cast<std::size_t>(map.cols));
  for (int c = 0; c < map.cols; ++c) columns[static_cast<std::size_t>(c)] = c * now.cols / map.cols;
  was_.resize(map.size());
  findStill(map);
  for (int r = 0; r < map.rows; ++r) {
    const int y = std::min(r * now.rows / map.rows, now.rows - 1);
    const Motion* const row = &motion[static_cast<std::size_t>(y) * static_cast<std::size_t>(now.cols)];
    for (int c = 0; c < map.cols; ++c) {
      const std::size_t i = map.at(c, r);
      Was& was = was_[i];
      was.disparity = disparity_[i];
      was.age = age_[i];
      was.strays = strays_[i];
      was.same = still_[i] != 0;
      was.moved = false;
      const Motion& v = row[columns[static_cast<std::size_t>(c)]];
      if (!agrees(map, i) && !(v == Motion{})) {
        const bool stays = was.same;
        const Was moved = movedTo(map, c, r, {v.x * scale, v.y * scale});
        if (!stays || (moved.same && isNear(map.pixels[i], moved.disparity))) was = moved;
        was.moved = !stays;
      }
      if (agrees(map, i)) was.strays = 0;
      else if (was.same) choose(map, c, r, was);
    }
  }
}

// It shows the same as before and has the same surface.
bool SteadyDisparity::agrees(const DisparityMap& map, std::size_t i) const noexcept {
  return was_[i].same && isNear(map.pixels[i], was_[i].disparity);
}

SteadyDisparity::Was SteadyDisparity::movedTo(const DisparityMap& map, int c, int r, const Motion& motion) const {
  const float x = static_cast<float>(c) + motion.x, y = static_cast<float>(r) + motion.y;
  const int dx = nearest(motion.x), dy = nearest(motion.y);
  if (x < 0 || y < 0 || x > static_cast<float>(map.cols - 1) || y > static_cast<float>(map.rows - 1)) return {};
  if (!showsTheSame(map, c, r, dx, dy)) return {};
  const std::size_t there = map.at(std::clamp(c + dx, 0, map.cols - 1), std::clamp(r + dy, 0, map.rows - 1));
  Was was{disparity_[there], age_[there], strays_[there], true};
  const int i = std::min(static_cast<int>(x), map.cols - 2), j = std::min(static_cast<int>(y), map.rows - 2);
  const float u = x - static_cast<float>(i), v = y - static_cast<float>(j);
  const float* const p = &disparity_[map.at(i, j)];
  const float a = p[0], b = p[1], d = p[map.cols], e = p[map.cols + 1];
  const float least = std::min(std::min(a, b), std::min(d, e)), most = std::max(std::max(a, b), std::max(d, e));
  if (most - least < kSurface) was.disparity = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * e);
  return was;
}

bool SteadyDisparity::showsTheSame(const DisparityMap& map, int c, int r, int dx, int dy) const {
  const bool inside =
      std::min({r, r + dy, c, c + dx}) > 0 && std::max(r, r + dy) + 1 < map.rows && std::max(c, c + dx) + 1 < map.cols;
  int sum = 0, count = 0;
  for (int y = -1; inside && y <= 1; ++y) {
    const std::uint8_t* const a = &left_[3 * map.at(c - 1, r + y)];
    const std::uint8_t* const b = &left_before_[3 * map.at(c - 1 + dx, r + y + dy)];
    for (int i = 0; i < 9; ++i) sum += std::abs(a[i] - b[i]);
  }
  if (inside) return sum < 9 * kSameColor;
  for (int y = std::max({r - 1, 0, -dy}); y <= std::min({r + 1, map.rows - 1, map.rows - 1 - dy}); ++y) {
    for (int x = std::max({c - 1, 0, -dx}); x <= std::min({c + 1, map.cols - 1, map.cols - 1 - dx}); ++x, ++count) {
      sum += unlikeness(&left_[3 * map.at(x, y)], &left_before_[3 * map.at(x + dx, y + dy)]);
    }
  }
  return count > 0 && sum < kSameColor * count;
}

// Computes showsTheSame for all pixels that have not moved, at once.
void SteadyDisparity::findStill(const DisparityMap& map) {
  changes_.resize(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    changes_[i] = static_cast<std::uint16_t>(unlikeness(&left_[3 * i], &left_before_[3 * i]));
  }
  still_.assign(map.size(), 0);
  for (int r = 1; r + 1 < map.rows; ++r) {
    const std::uint16_t* const above = &changes_[map.at(0, r - 1)];
    const std::uint16_t *const here = above + map.cols, *const below = here + map.cols;
    std::uint8_t* const out = &still_[map.at(0, r)];
    for (std::ptrdiff_t c = 1; c + 1 < map.cols; ++c) {
      const int sum = above[c - 1] + above[c] + above[c + 1] + here[c - 1] + here[c] + here[c + 1] + below[c - 1] +
                      below[c] + below[c + 1];
      out[c] = sum < 9 * kSameColor ? 1 : 0;
    }
  }
  for (int r = 0; r < map.rows; ++r) {  // along the border
    const bool outer = r == 0 || r + 1 == map.rows;
    for (int c = 0; c < map.cols; c += outer ? 1 : std::max(1, map.cols - 1)) {
      still_[map.at(c, r)] = showsTheSame(map, c, r, 0, 0) ? 1 : 0;
    }
  }
}

// Another surface than before on the same object: takes the one at which both views match; beyond a step only if it
// is found twice in a row, since beside an outline the two surfaces are found in turns. A surface seen often is kept
// longer; a moving one is not kept against a new match, since something else lies beside its edge.
void SteadyDisparity::choose(DisparityMap& map, int c, int r, Was& was) const {
  const std::size_t i = map.at(c, r);
  if (map.seen[i] != 0) ++was.strays;
  const bool given_up = was.strays >= (was.moved ? 1 : std::min(was.age, kPatience));
  const bool certain = was.strays >= kConfirmed || std::abs(map.pixels[i] - was.disparity) < kStep;
  const bool plainly =
      map.seen[i] != 0 && certain && misfit(map, c, r, map.pixels[i]) + kPlainly < misfit(map, c, r, was.disparity);
  if (plainly || given_up) was = {};
  else map.pixels[i] = was.disparity;
}

// Levels a pixel between the left view around a pixel and the right one at that disparity.
int SteadyDisparity::misfit(const DisparityMap& map, int c, int r, float disparity) const {
  const int away = nearest(disparity);
  int sum = 0, count = 0;
  for (int y = std::max(r - kBeside, 0); y <= std::min(r + kBeside, map.rows - 1); ++y) {
    for (int x = std::max({c - kBeside, 0, away}); x <= std::min({c + kBeside, map.cols - 1, map.cols - 1 + away});
         ++x) {
      sum += std::abs(left_luma_[map.at(x, y)] - right_luma_[map.at(x - away, y)]);
      ++count;
    }
  }
  return count > 0 ? sum / count : 255;
}

// Finds motion toward the viewer or away over an area.
void SteadyDisparity::findChanges(const DisparityMap& map) {
  std::vector<float> least(map.pixels.begin(), map.pixels.begin() + map.cols), most = least;  // of the columns
  for (int r = 1; r < map.rows; ++r) {
    const float* const row = &map.pixels[map.at(0, r)];
    for (std::size_t c = 0; c < least.size(); ++c) {
      least[c] = std::min(least[c], row[c]);
      most[c] = std::max(most[c], row[c]);
    }
  }
  towards_.begin(map.cols, map.rows, std::ranges::min(least), std::ranges::max(most));
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      const std::size_t i = map.at(c, r);
      if (was_[i].same && was_[i].strays == 0 && map.seen[i] != 0)
        towards_.add(c, r, map.pixels[i], map.pixels[i] - was_[i].disparity);
    }
  }
  towards_.smooth();
}

void SteadyDisparity::average(DisparityMap& map) {
  age_.resize(map.size());
  strays_.resize(map.size());
  disparity_.resize(map.size());
  for (int r = 0; r < map.rows; ++r) {
    const Was* was = &was_[map.at(0, r)];
    const std::uint8_t* seen = &map.seen[map.at(0, r)];
    float *pixels = &map.pixels[map.at(0, r)], *kept = &disparity_[map.at(0, r)];
    std::uint8_t *ages = &age_[map.at(0, r)], *strays = &strays_[map.at(0, r)];
    for (int c = 0; c < map.cols; ++c, ++was, ++seen, ++pixels) {
      int age = was->age + (*seen != 0 ? 1 : 0);  // an inferred disparity is unreliable
      if (was->same) {
        const MotionGrid::Change change = towards_.at(c, r, *pixels);
        age = std::min(age, std::max(kMovingMemory, static_cast<int>(kMemory * change.stillness)));
        const int weight = *seen != 0 ? std::max(age, 1) : age + kInferred;
        const float moved = was->disparity + change.pixels;
        *pixels = moved + (*pixels - moved) / static_cast<float>(weight);
      }
      *kept++ = *pixels;
      *ages++ = static_cast<std::uint8_t>(age);
      *strays++ = was->strays;
    }
  }
}

}  // namespace relievo
