// SPDX-License-Identifier: Apache-2.0
// Power spectral density of a force over time.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "platform/error.h"

namespace relievo {

// One-sided density in unit^2/Hz at k / (length x dt), k = 0 .. length/2: the mean over all segments that were added,
// each without its mean and under a Hann window (Welch 1967; Heinzel, Ruediger and Schilling 2002, eq. 23). The sum
// over all k times the step in frequency is the signal's variance.
class Spectrum {
 public:
  // Exhausted if out of memory. FFTW plans only on one thread at a time: call it from one thread.
  [[nodiscard]] static Result<Spectrum> make(std::size_t length, double dt_s);
  Spectrum(Spectrum&&) noexcept;
  Spectrum& operator=(Spectrum&&) noexcept;
  ~Spectrum();

  // `segment` is `length` samples.
  void add(std::span<const double> segment);

  [[nodiscard]] std::vector<double> density() const;
  [[nodiscard]] double stepHz() const;

 private:
  struct State;
  explicit Spectrum(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// dB of a density, relative to 1 unit^2/Hz; -300 for zero.
[[nodiscard]] double toDecibel(double density);

}  // namespace relievo
