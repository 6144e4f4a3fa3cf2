// SPDX-License-Identifier: Apache-2.0
// Each row is a polyline of points moved by their disparity; the nearest piece over a pixel's middle is seen.
#include "app/lab/film/right_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace relievo {
namespace {

constexpr float kUnseen = -std::numeric_limits<float>::infinity();

// One row of the right view: what each of its pixels shows.
class RightRow {
 public:
  explicit RightRow(std::span<const float> disparity)
      : disparity_(disparity), nearest_(disparity.size(), kUnseen), from_(disparity.size()) {
    const auto cols = std::ssize(disparity);
    for (std::ptrdiff_t c = 0; c < cols; ++c) {
      const float here = disparity[static_cast<std::size_t>(c)];
      const float next = disparity[static_cast<std::size_t>(std::min(c + 1, cols - 1))];
      const float before = disparity[static_cast<std::size_t>(std::max<std::ptrdiff_t>(c - 1, 0))];
      const auto x = static_cast<float>(c);
      if (c + 1 < cols && std::abs(next - here) <= kCliff) {
        draw(x, here, x + 1, next);
        if (std::abs(here - before) <= kCliff && c > 0) continue;
        draw(x - 0.5F, here, x, here);  // the outer half of a pixel at an edge
      } else {
        const bool alone = c > 0 && std::abs(here - before) > kCliff;
        draw(alone ? x - 0.5F : x, here, x + 0.5F, here);
      }
    }
    fillUnseen();
  }
  // The place in the left row.
  [[nodiscard]] float from(std::size_t c) const { return from_[c]; }

 private:
  void draw(float x0, float d0, float x1, float d1) {
    const float begin = x0 - d0, end = x1 - d1;
    if (end <= begin) return;  // a piece seen from behind
    const int last = std::min(static_cast<int>(std::floor(end)), static_cast<int>(nearest_.size()) - 1);
    for (int x = std::max(static_cast<int>(std::ceil(begin)), 0); x <= last; ++x) {
      const float t = (static_cast<float>(x) - begin) / (end - begin), d = d0 + t * (d1 - d0);
      const auto place = static_cast<std::size_t>(x);
      if (d <= nearest_[place]) continue;
      nearest_[place] = d;
      from_[place] = x0 + t * (x1 - x0);
    }
  }
  // Fills what the left view does not show between two sides with the colours beside the farther side.
  void fillUnseen() {
    const std::size_t cols = nearest_.size();
    for (std::size_t c = 0; c < cols; ++c) {
      if (nearest_[c] != kUnseen) continue;
      std::size_t end = c;
      while (end < cols && nearest_[end] == kUnseen) ++end;
      const float before = c > 0 ? nearest_[c - 1] : std::numeric_limits<float>::max();
      const float after = end < cols ? nearest_[end] : std::numeric_limits<float>::max();
      for (std::size_t k = c; k < end; ++k) {
        from_[k] = after < before ? from_[end] + static_cast<float>(end - k)
                                  : (c > 0 ? from_[c - 1] : 0) - static_cast<float>(k + 1 - c);
      }
      c = end;
    }
  }

  std::span<const float> disparity_;
  std::vector<float> nearest_, from_;
};

// Catmull and Rom's cubic between the pixels of a row, the outermost repeated.
double cubicAt(const std::uint8_t* row, int cols, double x) {
  const int whole = static_cast<int>(std::floor(x));
  const double t = x - whole;
  const auto at = [&](int k) {
    return static_cast<double>(row[std::ptrdiff_t{3} * std::clamp(whole + k, 0, cols - 1)]);
  };
  const double a = at(-1), b = at(0), c = at(1), d = at(2);
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

}  // namespace

Frame rightViewOf(const Frame& left, std::span<const float> disparity) {
  const auto cols = static_cast<std::size_t>(left.width), rows = static_cast<std::size_t>(left.height);
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(3 * cols * rows);
  std::uint8_t* out = bytes->data();
  for (std::size_t r = 0; r < rows; ++r) {
    const RightRow row(disparity.subspan(r * cols, cols));
    const std::uint8_t* const seen = left.planes[0].data + static_cast<std::ptrdiff_t>(r) * left.planes[0].stride_bytes;
    for (std::size_t c = 0; c < cols; ++c) {
      for (int k = 0; k < 3; ++k) {
        const double value = cubicAt(seen + k, left.width, static_cast<double>(row.from(c)));
        *out++ = static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
      }
    }
  }
  Frame right = left;
  right.planes = {};
  right.planes[0] = {bytes->data(), std::ptrdiff_t{3} * left.width};
  right.owner = bytes;
  return right;
}

}  // namespace relievo
