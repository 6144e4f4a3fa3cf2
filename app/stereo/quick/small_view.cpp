// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/small_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace relievo {
namespace {

constexpr int kMostTaken = 4;  // samples of a cell, across and down

// Where the samples of each cell lie along one side.
struct Places {
  int taken = 1;
  std::vector<int> at;  // `taken` a cell

  Places(int samples, int cells, int further = 0) : taken(std::clamp(samples / cells, 1, kMostTaken)) {
    const std::int64_t all = std::int64_t{cells} * taken;
    for (std::int64_t i = 0; i < all; ++i) {
      const auto place = static_cast<int>((2 * i + 1) * samples / (2 * all));
      at.push_back(std::clamp(place + further, 0, samples - 1));
    }
  }
};

// Sums of the codes of each cell of a component, `count` codes each.
struct Sums {
  std::vector<std::uint32_t> cells;
  int count = 1;
};

void sumRow(const Component& k, const std::uint8_t* row, const Places& across, std::uint32_t* sums) {
  const int* at = across.at.data();
  const std::size_t cells = across.at.size() / static_cast<std::size_t>(across.taken);
  const bool bytes = k.bits == 8 && k.shift == 0;
  for (std::size_t c = 0; c < cells; ++c) {
    for (int i = 0; i < across.taken; ++i, ++at) {
      const std::uint8_t* sample = row + std::ptrdiff_t{*at} * k.step_bytes;
      sums[c] += bytes ? *sample : codeAt(k, sample);
    }
  }
}

Sums sumsOf(const Frame& frame, std::size_t component, ViewSize size, int lower) {
  const Component& k = frame.components[component];
  const bool chroma = frame.model == ColorModel::Yuv && component > 0;
  const int shift_x = chroma ? frame.chroma_shift_x : 0, shift_y = chroma ? frame.chroma_shift_y : 0;
  const Places across((frame.width + (1 << shift_x) - 1) >> shift_x, size.cols);
  const Places down((frame.height + (1 << shift_y) - 1) >> shift_y, size.rows, lower >> shift_y);
  Sums sums{std::vector<std::uint32_t>(static_cast<std::size_t>(size.cols) * static_cast<std::size_t>(size.rows)),
            across.taken * down.taken};
  const Plane& plane = frame.planes[k.plane];
  for (int r = 0; r < size.rows; ++r) {
    for (int i = 0; i < down.taken; ++i) {
      const std::ptrdiff_t y =
          down.at[static_cast<std::size_t>(r) * static_cast<std::size_t>(down.taken) + static_cast<std::size_t>(i)];
      sumRow(k, plane.data + y * plane.stride_bytes + k.offset_bytes, across,
             sums.cells.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(size.cols));
    }
  }
  return sums;
}

std::uint8_t byteOf(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

// A component of YUV as bytes of full range.
void takeYuv(const Frame& frame, std::size_t component, ViewSize size, int lower, ViewPicture& into) {
  const Sums sums = sumsOf(frame, component, size, lower);
  const bool limited =
      frame.range == ColorRange::Limited || (frame.model == ColorModel::Yuv && frame.range == ColorRange::Unspecified);
  const bool chroma = component > 0;
  const float unit = static_cast<float>(1U << (frame.components[component].bits - 8)) * static_cast<float>(sums.count);
  const float low = chroma ? 128 * unit : limited ? 16 * unit : 0;
  const float scale = (limited ? 255.0F / (chroma ? 224 : 219) : 1.0F) / unit, base = chroma ? 128 : 0;
  for (std::size_t i = 0; i < sums.cells.size(); ++i)
    into.bytes[3 * i + component] = byteOf(base + (static_cast<float>(sums.cells[i]) - low) * scale);
}

void takeRgb(const Frame& frame, ViewSize size, int lower, ViewPicture& into) {
  std::array<Sums, 3> sums;
  std::array<float, 3> scale{};
  for (std::size_t k = 0; k < 3; ++k) {
    sums[k] = sumsOf(frame, k, size, lower);
    scale[k] = 255.0F / static_cast<float>((1U << frame.components[k].bits) - 1) / static_cast<float>(sums[k].count);
  }
  for (std::size_t i = 0; i < into.size(); ++i) {
    const float red = static_cast<float>(sums[0].cells[i]) * scale[0],
                green = static_cast<float>(sums[1].cells[i]) * scale[1],
                blue = static_cast<float>(sums[2].cells[i]) * scale[2];
    const float luma = 0.299F * red + 0.587F * green + 0.114F * blue;
    into.bytes[3 * i] = byteOf(luma);
    into.bytes[3 * i + 1] = byteOf(128 + 0.564F * (blue - luma));
    into.bytes[3 * i + 2] = byteOf(128 + 0.713F * (red - luma));
  }
}

void fit(ViewPicture& picture, ViewSize size) {
  picture.cols = size.cols;
  picture.rows = size.rows;
  picture.bytes.resize(LumaAndColor::kCount * picture.size());
}

}  // namespace

ViewSize reducedSize(const Frame& view, int cols) noexcept {
  constexpr int kLeastRows = 8;
  const int width = std::min(cols, view.width);
  const double shape = view.width * view.sample_aspect / view.height;
  const int rows = static_cast<int>(std::lround(width / shape));
  return {width, std::clamp(rows, std::min(kLeastRows, view.height), view.height)};
}

void readSmall(const Frame& view, ViewSize size, ViewPicture& into, int lower) {
  fit(into, size);
  if (view.model == ColorModel::Rgb) return takeRgb(view, size, lower, into);
  takeYuv(view, 0, size, lower, into);
  for (std::size_t k = 1; k < 3; ++k) {
    if (view.model == ColorModel::Yuv) {
      takeYuv(view, k, size, lower, into);
      continue;
    }
    for (std::size_t i = 0; i < into.size(); ++i) into.bytes[3 * i + k] = 128;
  }
}

void reduce(const ViewPicture& view, ViewSize size, ViewPicture& into) {
  fit(into, size);
  const auto edge = [](int cell, int cells, int samples) {
    return static_cast<int>(std::int64_t{cell} * samples / cells);
  };
  for (int r = 0; r < size.rows; ++r) {
    const int top = edge(r, size.rows, view.rows), bottom = edge(r + 1, size.rows, view.rows);
    for (int c = 0; c < size.cols; ++c) {
      const int first = edge(c, size.cols, view.cols), last = edge(c + 1, size.cols, view.cols);
      std::array<std::uint32_t, 3> sums{};
      for (int y = top; y < bottom; ++y) {
        const std::uint8_t* p = view.pixel(first, y);
        for (int x = first; x < last; ++x, p += 3) {
          for (std::size_t k = 0; k < 3; ++k) sums[k] += p[k];
        }
      }
      const auto count = static_cast<std::uint32_t>((bottom - top) * (last - first));
      std::uint8_t* const out = into.pixel(into.indexOf(c, r));
      for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<std::uint8_t>((sums[k] + count / 2) / count);
    }
  }
}

void mirror(ViewPicture& view) {
  const auto cols = static_cast<std::size_t>(view.cols);
  for (std::size_t row = 0; row < view.size(); row += cols) {
    for (std::size_t a = row, b = row + cols - 1; a < b; ++a, --b) {
      std::swap_ranges(&view.bytes[3 * a], &view.bytes[3 * a] + 3, &view.bytes[3 * b]);
    }
  }
}

}  // namespace relievo
