// SPDX-License-Identifier: Apache-2.0
// Weights by colour and distance as in adaptive support weights (Yoon and Kweon, PAMI 2006), for only a few candidates.
#include "app/stereo/edge_snapping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <vector>

namespace relievo {
namespace {

constexpr int kReach = 6;  // pixels: of the neighbours that are examined
constexpr int kWidth = 2 * kReach + 1;
constexpr int kStrideCols = 300;   // columns of a picture in which every neighbour is examined
constexpr int kNear = 5;           // pixels: the farthest that a step may lie from its outline
constexpr float kLeap = 2;         // pixels of disparity between neighbours: a step is near
constexpr float kStep = 1.5F;      // pixels of disparity between two surfaces
constexpr float kColor = 12;       // levels of difference by which a colour's weight falls to 1/e
constexpr float kWorst = 30;       // levels: the most that a pixel counts against a disparity
constexpr float kHidden = 10;      // levels: for a pixel that is hidden behind what the right eye sees there
constexpr float kFront = 2.5F;     // pixels of disparity by which one is in front of the other
constexpr float kInferred = 0.3F;  // weight of a neighbour that was not seen
constexpr float kSupport = 0.5F;   // of the neighbours' disparities, beside how they fit the right view
constexpr float kLight = 0.05F;    // lesser weights are left out
constexpr std::size_t kMostChoices = 6;
constexpr int kPasses = 3;

struct Choice {
  float first = 0, weight = 0, sum = 0;
  [[nodiscard]] float disparity() const { return weight > 0 ? sum / weight : first; }
};

struct Neighbours {
  struct One {
    int c = 0, r = 0;
    float weight = 0;
  };
  std::array<One, std::size_t{kWidth} * kWidth> all;
  std::size_t count = 0;
  std::array<Choice, kMostChoices> choices;
  std::size_t choice_count = 0;
  float weight = 0;      // of all that support a choice
  float fit_weight = 0;  // of all

  void support(float disparity, float by) {
    std::size_t i = 0;
    while (i < choice_count && std::abs(choices[i].first - disparity) > kStep) ++i;
    if (i == kMostChoices) return;
    if (i == choice_count) choices[choice_count++] = {.first = disparity};
    choices[i].weight += by;
    choices[i].sum += by * disparity;
    weight += by;
  }
};

class Snapper {
 public:
  Snapper(const DisparityMap& map, const ViewPicture& left, const ViewPicture& right)
      : map_(map), left_(left), right_(right), stride_(std::max(1, (map.cols + kStrideCols / 2) / kStrideCols)) {
    for (std::size_t i = 0; i < of_color_.size(); ++i) of_color_[i] = std::exp(-static_cast<float>(i) / kColor);
    for (int r = -kReach; r <= kReach; ++r) {
      for (int c = -kReach; c <= kReach; ++c)
        of_place_[place(c, r)] = std::exp(-std::hypot(static_cast<float>(c), static_cast<float>(r)) / kReach);
    }
  }

  // `changed`: what the last pass changed; others stay as they are, but beside those. Empty: the first pass.
  [[nodiscard]] std::vector<float> snapped(const cv::Mat& changed) const {
    cv::Mat near = nearSteps();
    if (!changed.empty()) cv::bitwise_and(near, around(changed, kReach), near);
    std::vector<float> result = map_.pixels;
    cv::parallel_for_(cv::Range(0, map_.rows), [&](const cv::Range& rows) {
      for (int r = rows.start; r < rows.end; ++r) {
        for (int c = 0; c < map_.cols; ++c) {
          if (near.at<std::uint8_t>(r, c) != 0) result[map_.at(c, r)] = best(c, r);
        }
      }
    });
    return result;
  }

 private:
  static std::size_t place(int c, int r) {
    return static_cast<std::size_t>(r + kReach) * kWidth + static_cast<std::size_t>(c + kReach);
  }
  [[nodiscard]] bool leaps(int c, int r, int across, int down) const {
    if (c + across >= map_.cols || r + down >= map_.rows) return false;
    return std::abs(map_.pixels[map_.at(c + across, r + down)] - map_.pixels[map_.at(c, r)]) > kLeap;
  }
  [[nodiscard]] cv::Mat nearSteps() const {
    cv::Mat steps(map_.rows, map_.cols, CV_8U);
    for (int r = 0; r < map_.rows; ++r) {
      for (int c = 0; c < map_.cols; ++c) {
        const bool step = leaps(c, r, 1, 0) || leaps(c, r, 0, 1) || leaps(c, r, 2, 0) || leaps(c, r, 0, 2);
        steps.at<std::uint8_t>(r, c) = step ? 1 : 0;
      }
    }
    return around(steps, kNear);
  }
  // The nonzero pixels, and those up to `reach` strides beside them.
  [[nodiscard]] cv::Mat around(const cv::Mat& marks, int reach) const {
    const int width = 2 * reach * stride_ + 1;
    cv::Mat result;
    cv::dilate(marks, result, cv::getStructuringElement(cv::MORPH_RECT, {width, width}));
    return result;
  }
  [[nodiscard]] int unlikeness(std::size_t a, std::size_t b) const {
    return relievo::unlikeness(left_.pixel(a), left_.pixel(b));
  }
  [[nodiscard]] Neighbours neighboursOf(int c, int r) const {
    Neighbours found;
    const std::size_t here = map_.at(c, r);
    for (int j = -kReach; j <= kReach; ++j) {
      for (int i = -kReach; i <= kReach; ++i) {
        const int x = c + i * stride_, y = r + j * stride_;
        if (x < 0 || x >= map_.cols || y < 0 || y >= map_.rows) continue;
        const std::size_t there = map_.at(x, y);
        const float weight = of_color_[static_cast<std::size_t>(unlikeness(here, there))] * of_place_[place(i, j)];
        if (weight > kLight) {
          found.all[found.count++] = {x, y, weight};
          found.fit_weight += weight;
        }
        found.support(map_.pixels[there], map_.seen[there] != 0 ? weight : kInferred * weight);
      }
    }
    return found;
  }
  // How much nearer the point that both eyes see at that place of the right view is than a point at this disparity.
  // Above 0, it hides the point; below 0, the right eye looks through the point. 0 if there is no such point.
  [[nodiscard]] float standsInFront(int x, int r, float disparity) const {
    const float seen = map_.from_right[map_.at(x, r)];
    if (!std::isfinite(seen)) return 0;
    const int back = x + nearest(seen);
    if (back < 0 || back >= map_.cols) return 0;
    const std::size_t there = map_.at(back, r);
    return map_.seen[there] != 0 && std::abs(map_.pixels[there] - seen) <= 1 ? seen - disparity : 0;
  }
  // How badly one pixel of the left view fits the right view at a disparity. The background at a near object's left
  // edge is hidden from the right eye: at the object's disparity it would fit, since the right view shows the same
  // background there.
  [[nodiscard]] float misfit(int c, int r, int whole, float rest) const {
    const int x = c - whole;
    if (x < 1 || x >= map_.cols) return kWorst;
    const float nearer = standsInFront(x, r, static_cast<float>(whole) + rest);
    if (nearer > kFront) return kHidden;
    if (nearer < -kFront) return kWorst;
    const std::uint8_t* p = left_.pixel(c, r);
    const std::uint8_t* q = right_.pixel(x - 1, r);
    float sum = 0;
    for (int i = 0; i < 3; ++i) {
      const float there = rest * static_cast<float>(q[i]) + (1 - rest) * static_cast<float>(q[i + 3]);
      sum += std::abs(static_cast<float>(p[i]) - there);
    }
    return std::min(sum, kWorst);
  }
  // From 0, where all neighbours fit the right view, to 1; or at least `most`, which ends it early.
  [[nodiscard]] float misfit(const Neighbours& near, float disparity, float most) const {
    const int whole = static_cast<int>(std::floor(disparity));
    const float rest = disparity - static_cast<float>(whole), scale = 1 / (near.fit_weight * kWorst);
    float misfits = 0;
    for (std::size_t i = 0; i < near.count && misfits * scale < most; ++i) {
      const auto& n = near.all[i];
      misfits += n.weight * misfit(n.c, n.r, whole, rest);
    }
    return misfits * scale;
  }
  [[nodiscard]] float best(int c, int r) const {
    Neighbours found = neighboursOf(c, r);
    const float own = map_.pixels[map_.at(c, r)];
    if (found.choice_count == 1) return own;
    // The likeliest first: it ends the others early.
    std::ranges::sort(std::span(found.choices).first(found.choice_count), std::greater(), &Choice::weight);
    float least = 2, chosen = own;
    for (std::size_t i = 0; i < found.choice_count; ++i) {
      const Choice& choice = found.choices[i];
      const float support = kSupport * choice.weight / found.weight;
      const float cost = misfit(found, choice.disparity(), least + support) - support;
      if (cost >= least) continue;
      least = cost;
      chosen = choice.disparity();
    }
    return std::abs(chosen - own) <= kStep ? own : chosen;  // its surface may slant
  }

  const DisparityMap& map_;
  const ViewPicture &left_, &right_;
  int stride_;  // pixels between the neighbours
  std::array<float, 3 * 256> of_color_{};
  std::array<float, std::size_t{kWidth} * kWidth> of_place_{};
};

}  // namespace

void snapEdges(DisparityMap& map, const ViewPicture& left, const ViewPicture& right) {
  cv::Mat changed;
  for (int i = 0; i < kPasses; ++i) {
    std::vector<float> snapped = Snapper(map, left, right).snapped(changed);
    changed.create(map.rows, map.cols, CV_8U);
    std::ranges::transform(snapped, map.pixels, changed.ptr(),
                           [](float now, float before) -> std::uint8_t { return now != before ? 1 : 0; });
    map.pixels = std::move(snapped);
  }
}

}  // namespace relievo
