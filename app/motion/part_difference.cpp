// SPDX-License-Identifier: Apache-2.0
#include "app/motion/part_difference.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace relievo {

const GrayPicture& QuarterPictures::at(int fx, int fy) const {
  GrayPicture& made = made_[4 * static_cast<std::size_t>(fy) + static_cast<std::size_t>(fx)];
  if (made.bytes.empty()) made = between(fx, fy);
  return made;
}

GrayPicture QuarterPictures::between(int fx, int fy) const {
  const GrayPicture& p = picture_;
  const int w00 = (4 - fx) * (4 - fy), w01 = fx * (4 - fy), w10 = (4 - fx) * fy, w11 = fx * fy;
  GrayPicture made(p.cols + 2 * kEdge, p.rows + 2 * kEdge);
  std::vector<std::uint8_t> upper, lower = wideRow(-kEdge);
  auto out = made.bytes.begin();
  for (int r = 0; r < made.rows; ++r) {
    upper = std::exchange(lower, wideRow(r + 1 - kEdge));
    const std::uint8_t *const a = upper.data(), *const b = lower.data();
    std::uint8_t* const to = &*out;
    for (int c = 0; c < made.cols; ++c) {
      to[c] = static_cast<std::uint8_t>((w00 * a[c] + w01 * a[c + 1] + w10 * b[c] + w11 * b[c + 1] + 8) >> 4);
    }
    out += made.cols;
  }
  return made;
}

std::vector<std::uint8_t> QuarterPictures::wideRow(int row) const {
  const GrayPicture& p = picture_;
  const int r = std::clamp(row, 0, p.rows - 1);
  const auto first = p.bytes.begin() + static_cast<std::ptrdiff_t>(r) * p.cols;
  std::vector<std::uint8_t> wide(static_cast<std::size_t>(p.cols + 2 * kEdge + 1), first[p.cols - 1]);
  std::fill_n(wide.begin(), kEdge, *first);
  std::copy_n(first, p.cols, wide.begin() + kEdge);
  return wide;
}

namespace {

// Of Size x Size samples, laid in one row, of which the compiler makes vector instructions.
template <int Size>
int squareDifference(const std::uint8_t* a, int a_stride, const std::uint8_t* b, int b_stride) {
  constexpr std::size_t kCount = (Size * Size + 15) / 16 * 16;
  std::array<std::uint8_t, kCount> x{}, y{};
  for (std::size_t r = 0; r < Size; ++r, a += a_stride, b += b_stride) {
    std::memcpy(&x[r * Size], a, Size);
    std::memcpy(&y[r * Size], b, Size);
  }
  int sum = 0;
  for (std::size_t i = 0; i < kCount; ++i) sum += std::abs(x[i] - y[i]);
  return sum;
}

}  // namespace

int differenceOf(const QuarterPictures& before, const GrayPicture& now, const PicturePart& part, const Motion& v,
                 int most) {
  constexpr int kEdge = QuarterPictures::kEdge;
  const int x4 = static_cast<int>(std::floor(4 * v.x + 0.5F)), y4 = static_cast<int>(std::floor(4 * v.y + 0.5F));
  const GrayPicture& then = before.at(x4 & 3, y4 & 3);
  // Farther out all rows, and all columns, are the same.
  const int left = part.left + (x4 >> 2) + kEdge, top = part.top + (y4 >> 2) + kEdge;
  const int width = part.right - part.left, height = part.bottom - part.top;
  if (left >= 0 && left + width <= then.cols && top >= 0 && top + height <= then.rows && width == height) {
    const std::uint8_t* const a = now.bytes.data() + static_cast<std::ptrdiff_t>(part.top) * now.cols + part.left;
    const std::uint8_t* const b = then.bytes.data() + static_cast<std::ptrdiff_t>(top) * then.cols + left;
    if (width == kLargePart) return squareDifference<kLargePart>(a, now.cols, b, then.cols);
    if (width == kSmallPart) return squareDifference<kSmallPart>(a, now.cols, b, then.cols);
  }
  int sum = 0;
  for (int r = part.top; r < part.bottom && sum <= most; ++r) {
    const std::uint8_t* const here = &now.bytes[static_cast<std::size_t>(r) * static_cast<std::size_t>(now.cols)];
    const int row = std::clamp(top + r - part.top, 0, then.rows - 1);
    const std::uint8_t* const there = &then.bytes[static_cast<std::size_t>(row) * static_cast<std::size_t>(then.cols)];
    for (int c = part.left; c < part.right; ++c) {
      sum += std::abs(here[c] - there[std::clamp(left + c - part.left, 0, then.cols - 1)]);
    }
  }
  return sum;
}

}  // namespace relievo
