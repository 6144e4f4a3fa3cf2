// SPDX-License-Identifier: Apache-2.0
// Frames from the front, and pictures along the lines of sight of the renderer's own cameras.
#include "app/lab/detail/silhouette_film.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>
#include <memory>

#include "app/lab/film/parallel.h"
#include "app/lab/truth/silhouette_scene.h"
#include "app/scene/display_volume.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume = DisplayVolume::forPicture(SilhouetteFilm::kCols, SilhouetteFilm::kRows);

double timeOf(int index) {
  return index / SilhouetteFilm::kFramesPerSecond;
}

std::uint8_t toByte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

// `put(c, r, out)` writes the sample's bytes.
template <class Put>
Frame makeFrame(MediaTime pts, int bytes_a_sample, Put&& put) {
  const int cols = SilhouetteFilm::kCols, rows = SilhouetteFilm::kRows;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(cols) * rows *
                                                                   static_cast<std::size_t>(bytes_a_sample));
  Frame frame;
  frame.pts = pts;
  frame.width = cols;
  frame.height = rows;
  frame.model = bytes_a_sample == 3 ? ColorModel::Rgb : ColorModel::Gray;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  for (int i = 0; i < bytes_a_sample; ++i) {
    frame.components[i] = {.offset_bytes = static_cast<std::uint8_t>(i),
                           .step_bytes = static_cast<std::uint8_t>(bytes_a_sample)};
  }
  frame.planes[0] = {samples->data(), std::ptrdiff_t{cols} * bytes_a_sample};
  frame.owner = samples;
  std::uint8_t* out = samples->data();
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c, out += bytes_a_sample) put(c, r, out);
  }
  return frame;
}

// The line of sight through a place of a view, 0 to 1 from its bottom left.
class Sight {
 public:
  explicit Sight(const EyeView& view) : back_(glm::inverse(view.view_projection)) {}
  [[nodiscard]] glm::dvec3 at(double x, double y, double depth) const {
    const glm::dvec4 point = back_ * glm::dvec4(2 * x - 1, 2 * y - 1, depth, 1);
    return glm::dvec3(point) / point.w;
  }

 private:
  glm::dmat4 back_;
};

}  // namespace

Frame SilhouetteFilm::depth(int index) {
  const SilhouetteScene scene(timeOf(index));
  const GridMapping grid(kVolume, kCols, kRows);
  return makeFrame(mediaTime(timeOf(index)), 1, [&](int c, int r, std::uint8_t* out) {
    *out = toByte(255 * scene.height(grid.x(c), grid.y(r)) / kVolume.depth_mm);
  });
}

Frame SilhouetteFilm::color(int index) {
  const SilhouetteScene scene(timeOf(index));
  const GridMapping grid(kVolume, kCols, kRows);
  return makeFrame(mediaTime(timeOf(index)), 3, [&](int c, int r, std::uint8_t* out) {
    const glm::dvec3 color = scene.color(grid.x(c), grid.y(r));
    for (int i = 0; i < 3; ++i) out[i] = toByte(color[i]);
  });
}

DrawnPicture SilhouetteFilm::seen(int index, const EyeViews& eyes, int width, int height, int finer) {
  const SilhouetteScene scene(timeOf(index));
  DrawnPicture picture{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 4, 255)};
  for (const EyeView& view : eyes.views) {
    const Sight sight(view);
    inParallel(static_cast<std::size_t>(view.area.height), [&](std::size_t row) {
      const int y = view.area.y + static_cast<int>(row);  // from the bottom
      std::uint8_t* out = picture.rgba.data() + (static_cast<std::size_t>(height - 1 - y) * width + view.area.x) * 4;
      for (int x = 0; x < view.area.width; ++x, out += 4) {
        glm::dvec3 sum(0);
        for (int k = 0; k < finer * finer; ++k) {
          const int aside = k % finer, up = k / finer;
          const double at_x = (x + (aside + 0.5) / finer) / view.area.width;
          const double at_y = (static_cast<double>(row) + (up + 0.5) / finer) / view.area.height;
          sum += glm::clamp(scene.colorAlong(sight.at(at_x, at_y, -1), sight.at(at_x, at_y, 1)), 0.0, 255.0);
        }
        for (int i = 0; i < 3; ++i) out[i] = toByte(sum[i] / (finer * finer));
      }
    });
  }
  return picture;
}

Frame SilhouetteFilm::marks(const Frame& depth, int reach) {
  constexpr double kJumpMm = 1;
  constexpr int kRim = 2;
  const int jump = static_cast<int>(kJumpMm * 255 / kVolume.depth_mm);
  const auto code = [&](int c, int r) {
    return static_cast<int>(depth.planes[0].data[r * depth.planes[0].stride_bytes + c]);
  };
  std::vector<std::uint8_t> near_jump(static_cast<std::size_t>(kCols) * kRows, 0);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const bool beside = c + 1 < kCols && std::abs(code(c + 1, r) - code(c, r)) > jump;
      const bool below = r + 1 < kRows && std::abs(code(c, r + 1) - code(c, r)) > jump;
      if (!beside && !below) continue;
      for (int k = std::max(0, r - reach); k <= std::min(kRows - 1, r + 1 + reach); ++k) {
        const auto row = near_jump.begin() + std::ptrdiff_t{k} * kCols;
        std::fill(row + std::max(0, c - reach), row + std::min(kCols, c + 2 + reach), std::uint8_t{1});
      }
    }
  }
  return makeFrame(depth.pts, 3, [&](int c, int r, std::uint8_t* out) {
    const bool rim = c < kRim || r < kRim || c >= kCols - kRim || r >= kRows - kRim;
    const std::uint8_t other = near_jump[static_cast<std::size_t>(r) * kCols + c] != 0 ? 0 : 255;
    out[0] = rim ? 0 : 255;
    out[1] = out[2] = rim ? 0 : other;
  });
}

}  // namespace relievo
