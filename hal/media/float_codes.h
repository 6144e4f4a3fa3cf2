// SPDX-License-Identifier: Apache-2.0
// Converts a depth picture's floating-point samples (distances, disparities, in any unit) to 16-bit codes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

namespace relievo {

// One scale for a whole film, chosen from its first picture that has a number: a code stands for 1, 2 or 5 times a
// power of ten, and the picture's largest value uses a quarter to a half of the codes. Code 0 is a hole: what is not a
// number, not positive, or so large that it means "nothing there" (1e9 and more, or one value, to a thousandth, that
// lies alone, ten times beyond all others). A film whose values are mostly negative, as some disparities are, has its
// sign turned. One whose values go through 0, as heights and a network's relative disparities do, is lifted above 0,
// and its codes begin below its lowest value. A later value beyond the scale gets the highest code, or code 1.
class FloatCodes {
 public:
  static constexpr float kNothingThere = 1e9F;
  static constexpr std::uint16_t kHole = 0, kHighest = 0xffff;

  // `sample(i)` returns the picture's sample `i` of `count`. Nullopt if all are holes: the next picture chooses.
  [[nodiscard]] static std::optional<FloatCodes> chosenFor(const std::function<float(std::size_t)>& sample,
                                                           std::size_t count);
  // Whole numbers up to 65535 that are codes already.
  [[nodiscard]] static FloatCodes identity() noexcept { return {1, {0, kNothingThere}}; }

  [[nodiscard]] std::uint16_t codeOf(float value) const noexcept;
  // What one code stands for, in the unit of the file; negative if the sign was turned.
  [[nodiscard]] double valuePerCode() const noexcept { return value_per_code_; }
  // The value of code 0: not 0 if the film's values were lifted.
  [[nodiscard]] double valueAtZero() const noexcept { return value_at_zero_; }
  // True if the value is no hole but lies beyond the highest code.
  [[nodiscard]] bool isBeyond(float value) const noexcept;

 private:
  struct Valid {
    float above, below;  // a value not between them is a hole
  };
  FloatCodes(double value_per_code, Valid valid, double value_at_zero = 0) noexcept
      : value_per_code_(value_per_code), value_at_zero_(value_at_zero), valid_(valid) {}
  // The code before it is rounded and bounded; nullopt for a hole.
  [[nodiscard]] std::optional<double> placeOf(float value) const noexcept;

  double value_per_code_;
  double value_at_zero_;
  Valid valid_;
};

}  // namespace relievo
