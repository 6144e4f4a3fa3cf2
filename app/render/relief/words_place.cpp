// SPDX-License-Identifier: Apache-2.0
// Examines the triangles as drawn, since they are what the eyes see behind the words.
#include "app/render/relief/words_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace relievo {
namespace {

constexpr double kFarthest = -std::numeric_limits<double>::infinity();
constexpr double kNearest = 0.9;  // of the way from the screen to the eyes: a deep relief reaches beyond them

double eyesOf(const StereoSettings& stereo) noexcept {
  return std::abs(stereo.strength * stereo.eye_distance_mm);
}

// A part of the relief: where it appears in the screen plane, seen from midway between the eyes, and its height.
struct Seen {
  double left = std::numeric_limits<double>::infinity(), right = kFarthest;
  double bottom = std::numeric_limits<double>::infinity(), top = kFarthest;
  double height_mm = kFarthest;  // of the nearest corner, over the screen plane

  void add(double x, double y, double z, const StereoSettings& stereo) noexcept {
    const double height = std::min(z - stereo.screen_z_mm, kNearest * stereo.viewing_distance_mm);
    const double scale = stereo.viewing_distance_mm / (stereo.viewing_distance_mm - height);
    left = std::min(left, scale * x), right = std::max(right, scale * x);
    bottom = std::min(bottom, scale * y), top = std::max(top, scale * y);
    height_mm = std::max(height_mm, height);
  }
  [[nodiscard]] double distanceMm(const WordsBox& box) const noexcept {
    const double across = std::max({0.0, box.left - right, left - box.right});
    const double up = std::max({0.0, box.bottom - top, bottom - box.top});
    return std::max(across, up);
  }
};

// The height of what is seen, and its distance from the words.
class Gaze {
 public:
  Gaze(const WordsBox& box, const StereoSettings& stereo, double pixels_per_mm) noexcept
      : stereo_(stereo), pixels_per_mm_(pixels_per_mm), box_(box) {
    // Each eye sees the words shifted from midway between the eyes: what is that near to the box counts as under it.
    const double beside_mm = 0.5 * eyesOf(stereo) * stereo.screen_z_mm / stereo.viewing_distance_mm;
    box_.left -= beside_mm, box_.right += beside_mm;
  }
  // The nearest under the box, and the nearest of all if each mm of distance takes `slope` px.
  struct Nearest {
    double under = kFarthest, around = kFarthest;
  };
  [[nodiscard]] Nearest at(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices,
                           double slope) const noexcept {
    Nearest nearest;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      Seen triangle;
      for (const std::uint32_t corner : indices.subspan(i, 3)) {
        triangle.add(static_cast<double>(vertices[corner].x), static_cast<double>(vertices[corner].y),
                     static_cast<double>(vertices[corner].z), stereo_);
      }
      count(triangle, slope, nearest);
    }
    return nearest;
  }
  [[nodiscard]] Nearest at(const CoarseRelief& relief, double slope) const noexcept {
    Nearest nearest;
    for (const CoarseRelief::Block& block : relief.blocks()) {
      Seen seen;
      const auto height = static_cast<double>(block.height_mm);
      seen.add(static_cast<double>(block.left), static_cast<double>(block.bottom), height, stereo_);
      seen.add(static_cast<double>(block.right), static_cast<double>(block.top), height, stereo_);
      count(seen, slope, nearest);
    }
    return nearest;
  }

 private:
  void count(const Seen& seen, double slope, Nearest& nearest) const noexcept {
    const double away_mm = seen.distanceMm(box_), height = seen.height_mm;
    const double disparity = eyesOf(stereo_) * pixels_per_mm_ * height / (stereo_.viewing_distance_mm - height);
    if (away_mm == 0) nearest.under = std::max(nearest.under, disparity);
    nearest.around = std::max(nearest.around, disparity - slope * away_mm);
  }
  const StereoSettings& stereo_;
  double pixels_per_mm_;
  WordsBox box_;
};

}  // namespace

// What the words must and should do for the next picture.
struct WordsPlace::Needs {
  double wished = kFarthest;  // their place if no picture needs more than kStep
  // The nearest under the box, in the present picture and in those that come.
  std::array<double, ReliefAhead::kMost + 1> under{};
  std::array<int, ReliefAhead::kMost + 1> pictures{};
  std::size_t count = 0;

  void add(int picture, double nearest) noexcept {
    under[count] = nearest;
    pictures[count++] = picture;
    wished = std::max(wished, nearest - kStep * picture);
  }
};

void WordsPlace::follow(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices,
                        const WordsBox& box, const StereoSettings& stereo, double width_px, double pixels_per_mm,
                        const ReliefAhead& ahead) {
  const Gaze gaze(box, stereo, pixels_per_mm);
  const auto known = ahead.known();
  const double fastest = known.empty() ? kFastestBlind : kFastest;
  const double slope = kStep * pixels_per_mm / (fastest * width_px);  // px of disparity per mm of distance
  const auto present = gaze.at(vertices, indices, slope);
  if (present.around == kFarthest) return stayInScreen();
  Needs needs;
  needs.add(0, present.under);
  double around = present.around;
  for (const ReliefAhead::Coming& coming : known) {
    const auto nearest = gaze.at(*coming.relief, slope);
    needs.add(coming.pictures, nearest.under);
    around = nearest.around - kStep * coming.pictures;
  }
  if (ahead.more) needs.wished = std::max(needs.wished, around);
  behind_ = present.under == kFarthest ? present.around : present.under;
  needs.wished += kInFront * width_px;
  move(needs);
}

void WordsPlace::move(const Needs& needs) noexcept {
  const double last = disparity_;
  if (std::exchange(begins_, false)) {
    disparity_ = std::max(needs.wished, behind_);
    return;
  }
  if (needs.wished != kFarthest) disparity_ += std::clamp(needs.wished - disparity_, -kSink, kStep);
  for (std::size_t i = 0; i < needs.count; ++i) {
    disparity_ = std::max(disparity_, last + (needs.under[i] - last) / (needs.pictures[i] + 1));
  }
  disparity_ = std::max(disparity_, needs.under[0]);
  if (disparity_ > last + kStep + 1e-9) ++lifted_;
}

double WordsPlace::shiftPx(double eye_x_mm, const StereoSettings& stereo) const noexcept {
  const double eyes = eyesOf(stereo);
  return eyes > 0 ? -eye_x_mm * disparity_ / eyes : 0.0;
}

}  // namespace relievo
