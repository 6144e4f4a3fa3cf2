// SPDX-License-Identifier: Apache-2.0
// Finds where a shot begins, from one view's pictures.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace relievo {

// A picture begins a shot if it differs much from the one before, and much more than that one did from its predecessor:
// fast motion changes every picture equally.
class CutFinder {
 public:
  // The next picture's brightness(x, y), 0 .. 255. True if it begins a shot, as the first one does.
  template <class Brightness>
  [[nodiscard]] bool begins(int cols, int rows, Brightness&& brightness) {
    const Thumb now = thumbOf(cols, rows, brightness);
    const bool first = !before_;
    float change = 0;
    for (std::size_t i = 0; i < now.size() && !first; ++i) {
      change += std::abs(now[i] - (*before_)[i]) / static_cast<float>(now.size());
    }
    const bool cut = change > kCut && change > kCutOver * change_;
    change_ = change;
    before_ = now;
    return first || cut;
  }
  // Call if the next picture does not continue the last one.
  void forget() noexcept { before_.reset(); }

 private:
  static constexpr int kCols = 32, kRows = 18, kTaken = 4;  // samples of a cell, in each direction
  static constexpr float kCut = 18;                         // levels between two pictures, on average
  static constexpr float kCutOver = 3;                      // times the change before
  using Thumb = std::array<float, std::size_t{kCols} * kRows>;

  template <class Brightness>
  static Thumb thumbOf(int cols, int rows, Brightness& brightness) {
    Thumb thumb{};
    for (int r = 0; r < kRows * kTaken; ++r) {
      for (int c = 0; c < kCols * kTaken; ++c) {
        const float level = brightness(c * cols / (kCols * kTaken), r * rows / (kRows * kTaken));
        thumb[static_cast<std::size_t>(r / kTaken) * kCols + static_cast<std::size_t>(c / kTaken)] +=
            level / (kTaken * kTaken);
      }
    }
    return thumb;
  }

  std::optional<Thumb> before_;
  float change_ = 0;  // between the last two pictures
};

}  // namespace relievo
