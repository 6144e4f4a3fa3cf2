// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/small_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/media/samples.h"

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

// The sums of the codes of each cell of a component, a row of cells at a time.
class CellSums {
 public:
  CellSums(const Frame& frame, std::size_t component, ViewSize size, int lower)
      : k_(frame.components[component]),
        plane_(frame.planes[k_.plane]),
        across_(partOf(frame.width, shiftOf(frame, component, frame.chroma_shift_x)), size.cols),
        down_(partOf(frame.height, shiftOf(frame, component, frame.chroma_shift_y)), size.rows,
              lower >> shiftOf(frame, component, frame.chroma_shift_y)),
        sums_(static_cast<std::size_t>(size.cols)) {}

  // The number of codes in each sum.
  [[nodiscard]] std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(across_.taken * down_.taken); }
  // The values of the row's cells, valid until the next call.
  [[nodiscard]] const std::vector<std::uint32_t>& row(int r) {
    std::ranges::fill(sums_, 0U);
    for (int i = 0; i < down_.taken; ++i) {
      const std::ptrdiff_t y =
          down_.at[static_cast<std::size_t>(r) * static_cast<std::size_t>(down_.taken) + static_cast<std::size_t>(i)];
      const std::uint8_t* const from = plane_.data + y * plane_.stride_bytes + k_.offset_bytes;
      if (k_.bits != 8 || k_.shift != 0) add([&](std::ptrdiff_t x) { return codeAt(k_, from + x * k_.step_bytes); });
      else if (k_.step_bytes == 1) add([&](std::ptrdiff_t x) { return from[x]; });
      else add([&](std::ptrdiff_t x) { return from[x * k_.step_bytes]; });
    }
    return sums_;
  }

 private:
  static int shiftOf(const Frame& frame, std::size_t component, int shift) noexcept {
    return frame.model == ColorModel::Yuv && component > 0 ? shift : 0;
  }
  static int partOf(int samples, int shift) noexcept { return (samples + (1 << shift) - 1) >> shift; }
  template <class Code>
  void add(Code&& code) {
    const int* at = across_.at.data();
    if (across_.taken == 1) {
      for (std::uint32_t& sum : sums_) sum += code(*at++);
    } else if (across_.taken == 2) {
      for (std::uint32_t& sum : sums_) {
        sum += code(at[0]) + code(at[1]);
        at += 2;
      }
    } else {
      for (std::uint32_t& sum : sums_) {
        for (int i = 0; i < across_.taken; ++i) sum += code(*at++);
      }
    }
  }

  const Component& k_;
  const Plane& plane_;
  Places across_, down_;
  std::vector<std::uint32_t> sums_;
};

std::uint8_t byteOf(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

// A component of YUV as bytes of full range.
void takeYuv(const Frame& frame, std::size_t component, ViewSize size, int lower, ViewPicture& into) {
  CellSums sums(frame, component, size, lower);
  const int bits = frame.components[component].bits;
  const bool limited = isLimited(frame);
  const bool chroma = component > 0;
  const float unit = static_cast<float>(1U << (bits - 8)) * static_cast<float>(sums.count());
  const float low = chroma ? 128 * unit : limited ? 16 * unit : 0;
  const float scale = (limited ? 255.0F / (chroma ? 224 : 219) : 1.0F) / unit, base = chroma ? 128 : 0;
  const auto byte = [&](std::uint32_t sum) { return byteOf(base + (static_cast<float>(sum) - low) * scale); };
  std::vector<std::uint8_t> bytes;  // of all sums, where those are few
  if (bits <= 10) {
    for (std::uint32_t sum = 0; sum <= sums.count() << bits; ++sum) bytes.push_back(byte(sum));
  }
  std::uint8_t* out = into.bytes.data() + component;
  for (int r = 0; r < size.rows; ++r) {
    for (const std::uint32_t sum : sums.row(r)) {
      *out = sum < bytes.size() ? bytes[sum] : byte(sum);
      out += 3;
    }
  }
}

void takeRgb(const Frame& frame, ViewSize size, int lower, ViewPicture& into) {
  std::array<CellSums, 3> sums{CellSums(frame, 0, size, lower), CellSums(frame, 1, size, lower),
                               CellSums(frame, 2, size, lower)};
  std::array<float, 3> scale{};
  for (std::size_t k = 0; k < 3; ++k) {
    scale[k] = 255.0F / static_cast<float>((1U << frame.components[k].bits) - 1) / static_cast<float>(sums[k].count());
  }
  std::uint8_t* out = into.bytes.data();
  for (int r = 0; r < size.rows; ++r) {
    const auto &reds = sums[0].row(r), &greens = sums[1].row(r), &blues = sums[2].row(r);
    for (std::size_t c = 0; c < reds.size(); ++c, out += 3) {
      const float red = static_cast<float>(reds[c]) * scale[0], green = static_cast<float>(greens[c]) * scale[1],
                  blue = static_cast<float>(blues[c]) * scale[2];
      const float luma = 0.299F * red + 0.587F * green + 0.114F * blue;
      out[0] = byteOf(luma);
      out[1] = byteOf(128 + 0.564F * (blue - luma));
      out[2] = byteOf(128 + 0.713F * (red - luma));
    }
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
