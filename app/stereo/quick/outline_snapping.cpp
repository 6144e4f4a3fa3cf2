// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/outline_snapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace relievo {
namespace {

constexpr float kStep = 1.5F;      // pixels of the small map: a greater difference around a pixel is a step
constexpr float kColor = 14;       // levels of difference by which a colour's weight falls to 1/e
constexpr int kReach = 2;          // pixels of the small map
constexpr float kInferred = 0.3F;  // weight of a pixel that was not seen

struct Side {
  float weight = 0, sum = 0;
};

class Enlarger {
 public:
  Enlarger(const DisparityMap& small, const ViewPicture& small_left, const ViewPicture& left)
      : small_(small),
        small_left_(small_left),
        left_(left),
        scale_(static_cast<float>(left.cols) / static_cast<float>(small.cols)),
        down_(static_cast<float>(small.rows) / static_cast<float>(left.rows)) {
    for (std::size_t i = 0; i < of_color_.size(); ++i) of_color_[i] = std::exp(-static_cast<float>(i) / kColor);
    findSteps();
  }

  void fill(DisparityMap& large) const {
    std::vector<float> columns;
    columns.reserve(static_cast<std::size_t>(large.cols));
    for (int c = 0; c < large.cols; ++c) {
      columns.push_back(
          std::clamp((static_cast<float>(c) + 0.5F) / scale_ - 0.5F, 0.0F, static_cast<float>(small_.cols - 1)));
    }
    for (int r = 0; r < large.rows; ++r) {
      const float y =
          std::clamp((static_cast<float>(r) + 0.5F) * down_ - 0.5F, 0.0F, static_cast<float>(small_.rows - 1));
      const int j = static_cast<int>(y);
      const std::size_t row = small_.at(0, nearest(y));
      for (int c = 0; c < large.cols; ++c) {
        const float x = columns[static_cast<std::size_t>(c)];
        const int i = static_cast<int>(x);
        const std::size_t there = row + static_cast<std::size_t>(nearest(x)), here = large.at(c, r);
        large.pixels[here] =
            scale_ * (at_step_[there] != 0 ? chosen(x, y, here)
                                           : between(i, j, x - static_cast<float>(i), y - static_cast<float>(j)));
        large.seen[here] = small_.seen[there];
      }
    }
  }

 private:
  void findSteps() {
    at_step_.assign(small_.size(), 0);
    middle_.resize(small_.size());
    std::vector<float> low(small_.size()), high(small_.size());
    for (int r = 0; r < small_.rows; ++r) {  // along rows, then down columns
      for (int c = 0; c < small_.cols; ++c) {
        float least = small_.pixels[small_.at(c, r)], most = least;
        for (int x = std::max(0, c - kReach); x <= std::min(small_.cols - 1, c + kReach); ++x) {
          least = std::min(least, small_.pixels[small_.at(x, r)]);
          most = std::max(most, small_.pixels[small_.at(x, r)]);
        }
        low[small_.at(c, r)] = least;
        high[small_.at(c, r)] = most;
      }
    }
    for (int r = 0; r < small_.rows; ++r) {
      for (int c = 0; c < small_.cols; ++c) {
        float least = low[small_.at(c, r)], most = high[small_.at(c, r)];
        for (int y = std::max(0, r - kReach); y <= std::min(small_.rows - 1, r + kReach); ++y) {
          least = std::min(least, low[small_.at(c, y)]);
          most = std::max(most, high[small_.at(c, y)]);
        }
        at_step_[small_.at(c, r)] = most - least > kStep ? 1 : 0;
        middle_[small_.at(c, r)] = 0.5F * (least + most);
      }
    }
  }
  [[nodiscard]] float between(int i, int j, float u, float v) const {
    const int right = std::min(i + 1, small_.cols - 1), below = std::min(j + 1, small_.rows - 1);
    const float top = (1 - u) * small_.pixels[small_.at(i, j)] + u * small_.pixels[small_.at(right, j)];
    const float bottom = (1 - u) * small_.pixels[small_.at(i, below)] + u * small_.pixels[small_.at(right, below)];
    return (1 - v) * top + v * bottom;
  }
  // The mean of the nearer or the farther side: of the side with more pixels that are near and similar.
  [[nodiscard]] float chosen(float x, float y, std::size_t here) const {
    const int middle_x = nearest(x), middle_y = nearest(y);
    const int left = std::max(0, middle_x - kReach), right = std::min(small_.cols - 1, middle_x + kReach);
    const int top = std::max(0, middle_y - kReach), bottom = std::min(small_.rows - 1, middle_y + kReach);
    const float between = middle_[small_.at(middle_x, middle_y)];
    std::array<float, 2 * kReach + 1> across{};  // the squared distances
    for (int i = left; i <= right; ++i) {
      const float dx = static_cast<float>(i) - x;
      across[static_cast<std::size_t>(i - left)] = dx * dx;
    }
    Side near, far;
    for (int j = top; j <= bottom; ++j) {
      const float dy = static_cast<float>(j) - y;
      for (int i = left; i <= right; ++i) {
        const std::size_t there = small_.at(i, j);
        const float seen = small_.seen[there] != 0 ? 1 : kInferred;
        const float away = across[static_cast<std::size_t>(i - left)] + dy * dy;
        const float weight = seen * of_color_[unlikeness(here, there)] / (1 + away);
        const float of_near = small_.pixels[there] > between ? weight : 0, of_far = weight - of_near;
        near.weight += of_near;
        near.sum += of_near * small_.pixels[there];
        far.weight += of_far;
        far.sum += of_far * small_.pixels[there];
      }
    }
    const Side& side = near.weight > far.weight ? near : far;
    return side.sum / side.weight;
  }
  [[nodiscard]] std::size_t unlikeness(std::size_t here, std::size_t there) const {
    return static_cast<std::size_t>(relievo::unlikeness(left_.pixel(here), small_left_.pixel(there)));
  }

  const DisparityMap& small_;
  const ViewPicture &small_left_, &left_;
  const float scale_, down_;  // pixels of the large map for one of the small one, across; and the other way round, down
  std::vector<std::uint8_t> at_step_;
  std::vector<float> middle_;  // between the nearest and the farthest around
  std::array<float, 3 * 256> of_color_{};
};

}  // namespace

void enlarge(const DisparityMap& small, const ViewPicture& small_left, const ViewPicture& left, DisparityMap& large) {
  if (large.cols != left.cols || large.rows != left.rows) large = DisparityMap(left.cols, left.rows);
  Enlarger(small, small_left, left).fill(large);
}

}  // namespace relievo
