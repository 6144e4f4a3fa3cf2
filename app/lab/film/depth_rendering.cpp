// SPDX-License-Identifier: Apache-2.0
// Renders one row of heights at a time.
#include "app/lab/film/depth_rendering.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "platform/memory/huge_pages.h"

namespace relievo {
namespace {

// Steele, Lea and Flood, Fast Splittable Pseudorandom Number Generators (2014), and the transform of Box and Muller.
class GaussianNoise {
 public:
  explicit GaussianNoise(std::uint64_t seed) : state_(seed) {}

  double next() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(uniform()));
    const double angle = 2 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  // In (0, 1].
  double uniform() { return static_cast<double>((mixed() >> 11) + 1) * 0x1p-53; }
  std::uint64_t mixed() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

template <class Sample>
void quantise(const std::vector<double>& codes, double highest, std::uint8_t* row) {
  auto* out = reinterpret_cast<Sample*>(row);  // aligned: rows begin at multiples of the sample's size
  for (const double code : codes) {
    const double shifted = std::clamp(code, 0.0, highest) + 0.5;
    *out++ = static_cast<Sample>(shifted);  // rounds non-negative values; faster than lround
  }
}

}  // namespace

Frame renderDepth(const TrueSurface& surface, const DepthFormat& format, int index) {
  const std::size_t sample_bytes = format.bits > 8 ? 2 : 1;
  const std::size_t stride = format.cols * sample_bytes;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>();
  samples->reserve(stride * format.rows);
  askForHugePages(samples->data(), samples->capacity());  // as the player's decoder does
  samples->resize(stride * format.rows);

  Frame frame;
  frame.pts = mediaTime(index / format.frames_per_s);
  frame.duration = mediaTime((index + 1) / format.frames_per_s) - frame.pts;
  frame.width = format.cols;
  frame.height = format.rows;
  frame.model = ColorModel::Gray;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(sample_bytes),
                         .bits = static_cast<std::uint8_t>(format.bits)};
  frame.planes[0] = {samples->data(), static_cast<std::ptrdiff_t>(stride)};
  frame.owner = samples;

  const GridMapping grid(TrueSurface::kVolume, format.cols, format.rows);
  std::vector<double> x_mm(format.cols), row(format.cols);
  for (int c = 0; c < format.cols; ++c) x_mm[c] = grid.x(c);
  const double highest = std::exp2(format.bits) - 1;
  const double per_mm = highest / TrueSurface::kVolume.depth_mm, sigma = format.noise_share * highest;
  GaussianNoise noise(format.noise_seed ^ (static_cast<std::uint64_t>(index) << 32));
  for (int r = 0; r < format.rows; ++r) {
    surface.heights(x_mm, grid.y(r), toSeconds(frame.pts), row);
    for (double& value : row) value *= per_mm;
    if (sigma > 0) {
      for (double& value : row) value += sigma * noise.next();
    }
    std::uint8_t* const out = samples->data() + r * stride;
    if (sample_bytes == 2) {
      quantise<std::uint16_t>(row, highest, out);
    } else {
      quantise<std::uint8_t>(row, highest, out);
    }
  }
  return frame;
}

std::vector<Frame> renderDepthFilm(const TrueSurface& surface, const DepthFormat& format, int count) {
  std::vector<Frame> film;
  film.reserve(count);
  for (int i = 0; i < count; ++i) film.push_back(renderDepth(surface, format, i));
  return film;
}

}  // namespace relievo
