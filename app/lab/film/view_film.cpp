// SPDX-License-Identifier: Apache-2.0
#include "app/lab/film/view_film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "app/lab/film/coded_depth.h"
#include "app/lab/film/parallel.h"
#include "app/lab/film/right_view.h"
#include "app/scene/height_field.h"

namespace relievo {
namespace {

constexpr double kGrain = 3;  // levels: the largest error of a camera
constexpr double kHighest = 65535;

std::uint32_t hashOf(std::uint32_t a, std::uint32_t b, std::uint32_t seed) {
  std::uint32_t h = a * 0x9E3779B1U ^ b * 0x85EBCA77U ^ seed * 0xC2B2AE3DU;
  h = (h ^ h >> 15) * 0x2C1B3C6DU;
  h = (h ^ h >> 12) * 0x297A2D39U;
  return h ^ h >> 15;
}

// -0.5 .. 0.5.
double randomAt(std::uint32_t a, std::uint32_t b, std::uint32_t seed) {
  return static_cast<double>(hashOf(a, b, seed) & 0xffffU) / 65535 - 0.5;
}

// Smooth noise between the points of a lattice.
double cloud(double x, double y, std::uint32_t seed) {
  const double i = std::floor(x), j = std::floor(y), u = x - i, v = y - j;
  const double a = u * u * (3 - 2 * u), b = v * v * (3 - 2 * v);
  const auto at = [&](int di, int dj) {
    return randomAt(static_cast<std::uint32_t>(static_cast<std::int64_t>(i) + di),
                    static_cast<std::uint32_t>(static_cast<std::int64_t>(j) + dj), seed);
  };
  return (1 - b) * ((1 - a) * at(0, 0) + a * at(1, 0)) + b * ((1 - a) * at(0, 1) + a * at(1, 1));
}

// Levels, of one colour component.
double paintAt(double x_mm, double y_mm, bool rich, std::uint32_t component) {
  const double broad = cloud(x_mm / 10, y_mm / 10, 11 + component);
  if (!rich) return 120 + 40 * broad + 25 * cloud(x_mm / 3, y_mm / 3, 7);
  return 120 + 40 * broad + 50 * cloud(x_mm / 3, y_mm / 3, 7) + 50 * cloud(x_mm / 1.2, y_mm / 1.2, 8) +
         40 * cloud(x_mm / 0.5, y_mm / 0.5, 9);
}

std::uint8_t byteOf(double value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

Frame paintedView(const ViewFilmFormat& format) {
  const GridMapping grid(TrueSurface::kVolume, format.cols, format.rows());
  const auto cols = static_cast<std::size_t>(format.cols), rows = static_cast<std::size_t>(format.rows());
  const auto bytes = std::make_shared<std::vector<std::uint8_t>>(3 * cols * rows);
  inParallel(rows, [&](std::size_t r) {
    std::uint8_t* out = bytes->data() + 3 * cols * r;
    for (int c = 0; c < format.cols; ++c) {
      for (std::uint32_t k = 0; k < 3; ++k)
        *out++ = byteOf(paintAt(grid.x(c), grid.y(static_cast<int>(r)), format.rich, k));
    }
  });
  Frame frame;
  frame.width = format.cols;
  frame.height = format.rows();
  frame.model = ColorModel::Rgb;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {bytes->data(), std::ptrdiff_t{3} * format.cols};
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.offset_bytes = i, .step_bytes = 3};
  frame.owner = bytes;
  return frame;
}

// Both views side by side as a camera and 4:2:0 leave them: BT.601, limited range.
Frame sideBySide(const Frame& left, const Frame& right, std::uint32_t picture) {
  const int cols = 2 * left.width, rows = left.height;
  const auto size = static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
  const auto bytes = std::make_shared<std::vector<std::uint8_t>>(size + size / 2);
  std::array<std::uint8_t*, 3> out{bytes->data(), bytes->data() + size, bytes->data() + size + size / 4};
  const auto at = [&](int c, int r) {
    const Frame& view = c < left.width ? left : right;
    return view.planes[0].data + r * view.planes[0].stride_bytes + std::ptrdiff_t{3} * (c % left.width);
  };
  const auto lumaOf = [](const std::uint8_t* p) { return 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]; };
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      const auto a = static_cast<std::uint32_t>(c), b = static_cast<std::uint32_t>(r);
      const double grain = kGrain * (randomAt(a, b, 2 * picture) + randomAt(a, b, 2 * picture + 1));
      *out[0]++ = byteOf(16 + (lumaOf(at(c, r)) + grain) * 219 / 255);
      if (c % 2 != 0 || r % 2 != 0) continue;
      const std::uint8_t* const p = at(c, r);
      *out[1]++ = byteOf(128 + 0.564 * (p[2] - lumaOf(p)) * 224 / 255);
      *out[2]++ = byteOf(128 + 0.713 * (p[0] - lumaOf(p)) * 224 / 255);
    }
  }
  Frame frame;
  frame.width = cols;
  frame.height = rows;
  frame.model = ColorModel::Yuv;
  frame.range = ColorRange::Limited;
  frame.matrix = ColorMatrix::Bt601;
  frame.chroma_shift_x = frame.chroma_shift_y = 1;
  frame.plane_count = 3;
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.plane = i};
  frame.planes[0] = {bytes->data(), cols};
  frame.planes[1] = {bytes->data() + size, cols / 2};
  frame.planes[2] = {bytes->data() + size + size / 4, cols / 2};
  frame.owner = bytes;
  return frame;
}

std::vector<float> disparitiesOf(const TrueSurface& surface, const ViewFilmFormat& format, double t_s) {
  const GridMapping grid(TrueSurface::kVolume, format.cols, format.rows());
  std::vector<double> x_mm, heights(static_cast<std::size_t>(format.cols));
  for (int c = 0; c < format.cols; ++c) x_mm.push_back(grid.x(c));
  std::vector<float> disparities;
  for (int r = 0; r < format.rows(); ++r) {
    surface.heights(x_mm, grid.y(r), t_s, heights);
    for (const double z : heights) disparities.push_back(static_cast<float>(format.cols * format.disparityOf(z)));
  }
  return disparities;
}

}  // namespace

int ViewFilmFormat::rows() const {
  return 2 * static_cast<int>(std::lround(cols * TrueSurface::kVolume.height_mm / TrueSurface::kVolume.width_mm / 2));
}

double ViewFilmFormat::disparityOf(double height_mm) const {
  return reach * (height_mm / TrueSurface::kVolume.depth_mm - kBehind);
}

double ViewFilmFormat::heightOf(double disparity) const {
  return TrueSurface::kVolume.depth_mm * (disparity / reach + kBehind);
}

Result<ViewFilm> ViewFilm::make(const TrueSurface& surface, const ViewFilmFormat& format, int count) {
  const Frame left = paintedView(format);
  std::vector<Frame> pictures(static_cast<std::size_t>(count));
  inParallel(pictures.size(), [&](std::size_t i) {
    const double t_s = static_cast<double>(i) / format.frames_per_s;
    pictures[i] =
        sideBySide(left, rightViewOf(left, disparitiesOf(surface, format, t_s)), static_cast<std::uint32_t>(i));
    pictures[i].pts = mediaTime(t_s);
  });
  if (format.crf) {
    auto coded = codeDepth(pictures, {.crf = *format.crf});
    if (!coded) return std::unexpected(coded.error());
    pictures = std::move(coded->frames);
  }
  ViewFilm film;
  for (const Frame& picture : pictures) {
    film.left.push_back(crop(picture, 0, 0, format.cols, format.rows()));
    film.right.push_back(crop(picture, format.cols, 0, format.cols, format.rows()));
  }
  return film;
}

Frame depthOfDisparity(const ViewFilmFormat& format, int cols, int rows, MediaTime time,
                       const std::function<double(std::size_t i)>& disparity) {
  const auto codes =
      std::make_shared<std::vector<std::uint16_t>>(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < codes->size(); ++i) {
    const double share = format.heightOf(disparity(i)) / TrueSurface::kVolume.depth_mm;
    (*codes)[i] = static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * kHighest));
  }
  Frame depth = grayFrame(codes, cols, rows);
  depth.pts = time;
  return depth;
}

}  // namespace relievo
