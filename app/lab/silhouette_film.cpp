// SPDX-License-Identifier: Apache-2.0
// What is nearest at a place counts; the light falls on the slopes of that part alone.
#include "app/lab/silhouette_film.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>

#include "app/lab/true_shapes.h"
#include "app/scene/display_volume.h"

namespace relievo {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr DisplayVolume kVolume = DisplayVolume::forPicture(SilhouetteFilm::kCols, SilhouetteFilm::kRows);
constexpr double kNotHere = -1;
enum Part : std::uint8_t { Wall, Mask, Ball, Rod, kParts };

// Everything moves steadily enough for a film: at most 60 mm/s.
class Moment {
 public:
  explicit Moment(double t_s) : t_s_(t_s) {
    mask_ = {-4 + 4 * std::sin(kTurn * 0.53 * t_s), 2};
    mask_z_mm_ = 7 + 2 * std::sin(kTurn * 0.71 * t_s);
    ball_ = {-52 + 60 * t_s, -26 + 8 * std::sin(kTurn * 0.5 * t_s)};
    rod_ = {44 - 6 * t_s, 10};
  }

  [[nodiscard]] double height(Part part, double x, double y) const {
    switch (part) {
      case Wall:
        return 4.5 + 1.6 * std::sin(0.11 * x + 0.6 * std::sin(0.05 * y)) + std::sin(0.07 * y + 0.09 * x + 0.8 * t_s_);
      case Mask:
        return ofMask(x - mask_.x, y - mask_.y);
      case Ball:
        return ofBall(x - ball_.x, y - ball_.y);
      default:
        return ofRod(x - rod_.x, y - rod_.y);
    }
  }
  [[nodiscard]] Part nearest(double x, double y) const {
    Part found = Wall;
    for (const Part part : {Mask, Ball, Rod}) {
      if (height(part, x, y) > height(found, x, y)) found = part;
    }
    return found;
  }
  // Of the part, where the pattern stands still.
  [[nodiscard]] glm::dvec2 origin(Part part) const {
    const glm::dvec2 origins[kParts] = {glm::dvec2(0), mask_, ball_, rod_};
    return origins[part];
  }

 private:
  [[nodiscard]] double ofMask(double x, double y) const {
    constexpr double kHalfWidthMm = 42, kHalfHeightMm = 40, kFlatter = 0.75;
    const double across = x / kHalfWidthMm, down = y / kHalfHeightMm;
    if (across * across + down * down > 1) return kNotHere;
    return mask_z_mm_ + kFlatter * (shapes::Face{}(x, y) - shapes::Face::kFloorMm);
  }
  // Up to where it slopes 3.4 in 1: its rim stands free.
  [[nodiscard]] static double ofBall(double x, double y) {
    constexpr double kRadiusMm = 12, kRimMm = 0.96 * kRadiusMm, kCentreZMm = 24;
    const double from_middle = x * x + y * y;
    if (from_middle > kRimMm * kRimMm) return kNotHere;
    return kCentreZMm + std::sqrt(kRadiusMm * kRadiusMm - from_middle);
  }
  [[nodiscard]] static double ofRod(double x, double y) {
    constexpr double kAlongX = 0.28, kAlongY = 0.96, kHalfLengthMm = 38, kHalfWidthMm = 2.5, kRadiusMm = 3;
    const double along = kAlongX * x + kAlongY * y, aside = kAlongY * x - kAlongX * y;
    if (std::abs(along) > kHalfLengthMm || std::abs(aside) > kHalfWidthMm) return kNotHere;
    return 26 + 0.15 * along + std::sqrt(kRadiusMm * kRadiusMm - aside * aside);
  }

  double t_s_;
  glm::dvec2 mask_{0}, ball_{0}, rod_{0};
  double mask_z_mm_ = 0;
};

double pattern(const glm::dvec2& at) {
  struct Wave {
    double x_per_mm, y_per_mm, share;
  };
  constexpr Wave kWaves[] = {{0.35, 0.16, 0.20}, {-0.10, 0.23, 0.16}, {0.11, -0.09, 0.12}, {0.04, 0.06, 0.10}};
  double sum = 1;
  for (const Wave& wave : kWaves) sum += wave.share * std::sin(kTurn * (wave.x_per_mm * at.x + wave.y_per_mm * at.y));
  return sum;
}

glm::dvec3 lightAt(const Moment& moment, double x, double y) {
  static const glm::dvec3 kColors[kParts] = {{108, 122, 140}, {150, 116, 96}, {168, 60, 52}, {146, 140, 70}};
  static const glm::dvec3 kToLight = glm::normalize(glm::dvec3(-0.45, 0.5, 0.75));
  constexpr double kAmbient = 0.35, kStepMm = 0.05;
  const Part part = moment.nearest(x, y);
  const double z = moment.height(part, x, y);
  // To the middle of the picture, and of the part if need be: its rim has no slope beyond.
  const auto slope = [&](double dx, double dy) {
    const double ahead = moment.height(part, x + dx, y + dy);
    if (ahead != kNotHere) return (ahead - z) / kStepMm;
    return (z - moment.height(part, x - dx, y - dy)) / kStepMm;
  };
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope(kStepMm, 0), -slope(0, kStepMm), 1));
  const double lit = kAmbient + (1 - kAmbient) * std::max(0.0, glm::dot(normal, kToLight));
  return kColors[part] * (lit * pattern(glm::dvec2(x, y) - moment.origin(part)));
}

// `put` writes the sample at (x, y) into the bytes given.
template <class Put>
Frame render(int index, int bytes_a_sample, Put&& put) {
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(SilhouetteFilm::kCols) * bytes_a_sample;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(stride * SilhouetteFilm::kRows);
  Frame frame;
  frame.pts = mediaTime(index / SilhouetteFilm::kFramesPerSecond);
  frame.duration = mediaTime((index + 1) / SilhouetteFilm::kFramesPerSecond) - frame.pts;
  frame.width = SilhouetteFilm::kCols;
  frame.height = SilhouetteFilm::kRows;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {samples->data(), stride};
  frame.owner = samples;
  const Moment moment(toSeconds(frame.pts));
  const GridMapping grid(kVolume, SilhouetteFilm::kCols, SilhouetteFilm::kRows);
  std::uint8_t* out = samples->data();
  for (int r = 0; r < SilhouetteFilm::kRows; ++r) {
    for (int c = 0; c < SilhouetteFilm::kCols; ++c, out += bytes_a_sample) put(moment, grid.x(c), grid.y(r), out);
  }
  return frame;
}

std::uint8_t toByte(double value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5);
}

}  // namespace

Frame SilhouetteFilm::depth(int index) {
  return render(index, 1, [](const Moment& moment, double x, double y, std::uint8_t* out) {
    *out = toByte(255 * moment.height(moment.nearest(x, y), x, y) / kVolume.depth_mm);
  });
}

Frame SilhouetteFilm::color(int index) {
  Frame frame = render(index, 3, [](const Moment& moment, double x, double y, std::uint8_t* out) {
    const glm::dvec3 light = lightAt(moment, x, y);
    for (int c = 0; c < 3; ++c) out[c] = toByte(light[c]);
  });
  frame.model = ColorModel::Rgb;
  for (std::uint8_t c = 0; c < 3; ++c) frame.components[c] = {.offset_bytes = c, .step_bytes = 3};
  return frame;
}

std::vector<std::uint8_t> nearSilhouettes(const Frame& depth, int reach) {
  constexpr double kJumpMm = 1;
  const int jump = static_cast<int>(kJumpMm * 255 / kVolume.depth_mm);
  const int cols = depth.width, rows = depth.height;
  const auto code = [&](int c, int r) {
    return static_cast<int>(depth.planes[0].data[r * depth.planes[0].stride_bytes + c]);
  };
  std::vector<std::uint8_t> across(static_cast<std::size_t>(cols) * rows, 0), all = across;
  // First along the rows, then down the columns: the same square around every jump.
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const bool beside = c + 1 < cols && std::abs(code(c + 1, r) - code(c, r)) > jump;
      const bool below = r + 1 < rows && std::abs(code(c, r + 1) - code(c, r)) > jump;
      if (!beside && !below) continue;
      for (int k = std::max(0, c - reach); k <= std::min(cols - 1, c + 1 + reach); ++k) across[r * cols + k] = 1;
    }
  }
  for (int r = 0; r < rows; ++r) {
    for (int k = std::max(0, r - reach); k <= std::min(rows - 1, r + 1 + reach); ++k) {
      for (int c = 0; c < cols; ++c) all[k * cols + c] |= across[r * cols + c];
    }
  }
  return all;
}

}  // namespace relievo
