// SPDX-License-Identifier: Apache-2.0
// FFTW, real to complex.
#include "app/lab/numbers/spectrum.h"

#include <fftw3.h>

#include <cerrno>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace relievo {
namespace {

struct FreeFftw {
  void operator()(void* memory) const noexcept { fftw_free(memory); }
  void operator()(fftw_plan plan) const noexcept { fftw_destroy_plan(plan); }
};
template <class T>
using FftwMemory = std::unique_ptr<T[], FreeFftw>;

}  // namespace

struct Spectrum::State {
  std::size_t length = 0, segments = 0;
  double dt_s = 0, window_power = 0;
  std::vector<double> window, sum;
  FftwMemory<double> in;
  FftwMemory<fftw_complex> out;
  std::unique_ptr<fftw_plan_s, FreeFftw> plan;
};

Result<Spectrum> Spectrum::make(std::size_t length, double dt_s) {
  auto state = std::make_unique<State>();
  state->length = length;
  state->dt_s = dt_s;
  for (std::size_t i = 0; i < length; ++i) {
    const double phase = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length);
    state->window.push_back(0.5 - 0.5 * std::cos(phase));
    state->window_power += state->window.back() * state->window.back();
  }
  state->sum.assign(length / 2 + 1, 0);
  state->in.reset(fftw_alloc_real(length));
  state->out.reset(fftw_alloc_complex(length / 2 + 1));
  if (state->in && state->out) {
    state->plan.reset(fftw_plan_dft_r2c_1d(static_cast<int>(length), state->in.get(), state->out.get(), FFTW_ESTIMATE));
  }
  if (!state->plan) return fail(ErrorCode::Exhausted, "no memory for a spectrum; close other programs", ENOMEM);
  return Spectrum(std::move(state));
}

Spectrum::Spectrum(std::unique_ptr<State> state) : state_(std::move(state)) {}
Spectrum::Spectrum(Spectrum&&) noexcept = default;
Spectrum& Spectrum::operator=(Spectrum&&) noexcept = default;
Spectrum::~Spectrum() = default;

void Spectrum::add(std::span<const double> segment) {
  State& s = *state_;
  double mean = 0;
  for (const double value : segment) mean += value / static_cast<double>(s.length);
  for (std::size_t i = 0; i < s.length; ++i) s.in[i] = (segment[i] - mean) * s.window[i];
  fftw_execute(s.plan.get());
  for (std::size_t k = 0; k < s.sum.size(); ++k) {
    s.sum[k] += s.out[k][0] * s.out[k][0] + s.out[k][1] * s.out[k][1];
  }
  ++s.segments;
}

std::vector<double> Spectrum::density() const {
  const State& s = *state_;
  std::vector<double> density = s.sum;
  if (s.segments == 0) return density;
  const double scale = s.dt_s / (s.window_power * static_cast<double>(s.segments));
  for (std::size_t k = 0; k < density.size(); ++k) {
    // Every frequency except zero and the highest also counts for its negative.
    const bool alone = k == 0 || 2 * k == s.length;
    density[k] *= scale * (alone ? 1 : 2);
  }
  return density;
}

double Spectrum::stepHz() const {
  return 1 / (static_cast<double>(state_->length) * state_->dt_s);
}

double toDecibel(double density) {
  constexpr double kNothing = 1e-30;
  return 10 * std::log10(density > kNothing ? density : kNothing);
}

}  // namespace relievo
