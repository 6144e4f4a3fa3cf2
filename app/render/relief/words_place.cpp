// SPDX-License-Identifier: Apache-2.0
// Looks at the triangles as drawn, since they are what the eyes see behind the words.
#include "app/render/relief/words_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relievo {
namespace {

constexpr double kFarthest = -std::numeric_limits<double>::infinity();

double eyesOf(const StereoSettings& stereo) noexcept {
  return std::abs(stereo.strength * stereo.eye_distance_mm);
}

// Three corners as they lie in the screen plane, seen from between the eyes.
struct Seen {
  double left = 0, right = 0, bottom = 0, top = 0;
  double height_mm = 0;  // of the nearest corner, over the screen plane

  Seen(std::span<const TexturedVertex> vertices, const std::uint32_t* corners, const StereoSettings& stereo) noexcept {
    left = bottom = std::numeric_limits<double>::infinity();
    right = top = height_mm = kFarthest;
    const double distance = stereo.viewing_distance_mm;
    for (int k = 0; k < 3; ++k) {
      const TexturedVertex& corner = vertices[corners[k]];
      const double height = static_cast<double>(corner.z) - stereo.screen_z_mm;
      const double scale = distance / (distance - height);
      left = std::min(left, scale * static_cast<double>(corner.x));
      right = std::max(right, scale * static_cast<double>(corner.x));
      bottom = std::min(bottom, scale * static_cast<double>(corner.y));
      top = std::max(top, scale * static_cast<double>(corner.y));
      height_mm = std::max(height_mm, height);
    }
  }
  [[nodiscard]] double distanceMm(const WordsBox& box) const noexcept {
    const double across = std::max({0.0, box.left - right, left - box.right});
    const double up = std::max({0.0, box.bottom - top, bottom - box.top});
    return std::max(across, up);
  }
};

}  // namespace

void WordsPlace::follow(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices,
                        const WordsBox& box, const StereoSettings& stereo, double width_px, double pixels_per_mm) {
  const double distance = stereo.viewing_distance_mm, eyes = eyesOf(stereo);
  const auto disparityOf = [&](double height_mm) { return eyes * pixels_per_mm * height_mm / (distance - height_mm); };
  // Each eye sees the words beside where the middle sees them: what is that near to the box is under it as well.
  const double beside_mm = 0.5 * eyes * stereo.screen_z_mm / distance;
  const WordsBox wide{box.left - beside_mm, box.bottom, box.right + beside_mm, box.top};
  const double slope = kStep * pixels_per_mm / (kFastest * width_px);  // px of disparity per mm of distance
  double behind = kFarthest, wished = kFarthest;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Seen triangle(vertices, &indices[i], stereo);
    const double away_mm = triangle.distanceMm(wide);
    const double disparity = disparityOf(triangle.height_mm);
    if (away_mm == 0) behind = std::max(behind, disparity);
    wished = std::max(wished, disparity - slope * away_mm);
  }
  if (wished == kFarthest) return stayInScreen();
  behind_ = behind == kFarthest ? wished : behind;
  wished += kInFront * width_px;
  if (begins_) disparity_ = wished;
  else disparity_ += std::clamp(wished - disparity_, -kSink, kStep);
  begins_ = false;
  if (disparity_ >= behind_) return;
  disparity_ = behind_;
  ++lifted_;
}

double WordsPlace::shiftPx(double eye_x_mm, const StereoSettings& stereo) const noexcept {
  const double eyes = eyesOf(stereo);
  return eyes > 0 ? -eye_x_mm * disparity_ / eyes : 0.0;
}

}  // namespace relievo
