// SPDX-License-Identifier: Apache-2.0
// Two levels of tensor-product B-splines on cached block means, and the soft clamp between them.
#include "app/haptics/felt_surface.h"

#include <algorithm>
#include <cmath>

namespace relievo {
namespace {

constexpr double kSigmaPerPitch = 0.645497;  // sqrt(5/12)
constexpr int kNarrowSamples = 3, kWideSamples = 5;

// Basis functions of four control points and their first and second derivatives, in units of the pitch.
struct Basis {
  Float4 value, slope, bend;
};

Basis cubicBasis(double s) RELIEVO_RT {
  const auto t = static_cast<float>(s);
  const float r = 1 - t, t2 = t * t, t3 = t2 * t;
  return {Float4{r * r * r / 6, (4 - 6 * t2 + 3 * t3) / 6, (1 + 3 * t + 3 * t2 - 3 * t3) / 6, t3 / 6},
          Float4{-r * r / 2, (3 * t2 - 4 * t) / 2, (1 + 2 * t - 3 * t2) / 2, t2 / 2},
          Float4{r, 3 * t - 2, 1 - 3 * t, t}};
}
// Three points: the fourth has no weight. s in [-1/2, 1/2) from the middle one.
Basis quadraticBasis(double s) RELIEVO_RT {
  const auto t = static_cast<float>(s);
  const float l = 0.5F - t, h = 0.5F + t;
  return {Float4{l * l / 2, 0.75F - t * t, h * h / 2, 0}, Float4{-l, -2 * t, h, 0}, Float4{1, -2, 1, 0}};
}

float sum(const Float4& v) RELIEVO_RT {
  return (v[0] + v[1]) + (v[2] + v[3]);
}

// c(u) = u/(1 + (u/d)^4)^(1/4) and its derivatives: u while small, d while large.
struct SoftClamp {
  double value, slope, bend;
  SoftClamp(double u, double d) RELIEVO_RT {
    const double q = u / d, q2 = q * q, base = 1 + q2 * q2;
    const double root = std::sqrt(std::sqrt(base));
    value = u / root;
    slope = 1 / (base * root);
    bend = -5 * q2 * q / (d * base * base * root);
  }
};

}  // namespace

FeltSurface::Level::Level(double sigma_mm, int most_samples, TimeLaw law) noexcept
    : grid(sigma_mm / kSigmaPerPitch, most_samples), time(law) {}

FeltSurface::FeltSurface(const FeltScale& scale) noexcept
    : scale_(scale),
      narrow_(scale.narrow_mm, kNarrowSamples, scale.narrow_time),
      wide_(scale.wide_mm, kWideSamples, scale.wide_time),
      two_levels_(scale.wide_mm > scale.narrow_mm),
      cubic_(scale.space != SpaceLaw::Quadratic) {}

void FeltSurface::forget() RELIEVO_RT {
  slots_in_use_ = 0;
  count_ = 0;
}

bool FeltSurface::moment(const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  narrow_.patched = wide_.patched = false;
  if (window.count == 0) return false;
  const HeightField& field = window.frames[0].field;
  if (window.epoch != epoch_ || field.cols() != cols_ || field.rows() != rows_ || slots_in_use_ == 0) {
    epoch_ = window.epoch;
    cols_ = field.cols();
    rows_ = field.rows();
    depth_mm_ = field.depthMm();
    slots_in_use_ = 0;
    count_ = 0;
    narrow_.grid.setPicture(field);
    wide_.grid.setPicture(field);
    two_levels_ = scale_.wide_mm > scale_.narrow_mm && (wide_.grid.blockCols() > narrow_.grid.blockCols() ||
                                                        wide_.grid.blockRows() > narrow_.grid.blockRows());
    sample_mm_ = 0.5 / std::max(std::abs(narrow_.grid.aPerMm()), std::abs(narrow_.grid.bPerMm()));
  }
  placeFrames(window);
  weigh(narrow_, window, now);
  if (two_levels_) weigh(wide_, window, now);
  return true;
}

// Gives every frame of the window a slot of the caches, the one it had if it had one.
void FeltSurface::placeFrames(const SurfaceWindow& window) RELIEVO_RT {
  const auto last = static_cast<std::size_t>(window.count - 1);
  if (window.count == count_ && window.frames[0].time == first_time_ && window.frames[last].time == last_time_) return;
  count_ = window.count;
  first_time_ = window.frames[0].time;
  last_time_ = window.frames[last].time;

  std::uint32_t kept = 0;
  std::array<bool, ControlGrid::kFrames> placed{};
  for (std::size_t f = 0; f <= last; ++f) {
    for (std::size_t s = 0; s < ControlGrid::kFrames; ++s) {
      if ((slots_in_use_ >> s & 1U) == 0 || time_of_slot_[s] != window.frames[f].time) continue;
      kept |= 1U << s;
      slot_[f] = static_cast<std::uint8_t>(s);
      placed[f] = true;
    }
  }
  slots_in_use_ = kept;
  for (std::size_t f = 0; f <= last; ++f) {
    if (!placed[f]) {
      const auto s = static_cast<std::size_t>(__builtin_ctz(~slots_in_use_));
      slots_in_use_ |= 1U << s;
      slot_[f] = static_cast<std::uint8_t>(s);
      time_of_slot_[s] = window.frames[f].time;
      narrow_.grid.forgetFrame(static_cast<int>(s));
      wide_.grid.forgetFrame(static_cast<int>(s));
    }
    frame_of_slot_[slot_[f]] = static_cast<std::int8_t>(f);
  }
}

void FeltSurface::weigh(Level& level, const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  const FrameWeights weights(window, now, level.time);
  shot_ = window.frames[static_cast<std::size_t>(weights.present)].shot;
  level.frames.window = &window;
  level.frames.frame_of_slot = frame_of_slot_;
  level.frames.weight.fill(0);
  level.frames.wanted = 0;
  for (std::size_t f = 0; f < static_cast<std::size_t>(window.count); ++f) {
    if (weights.weight[f] == 0) continue;
    level.frames.weight[slot_[f]] = weights.weight[f];
    level.frames.wanted |= 1U << slot_[f];
  }
}

SurfacePoint FeltSurface::at(Level& level, double x_mm, double y_mm) RELIEVO_RT {
  const ControlGrid& grid = level.grid;
  const double a = grid.a(x_mm), b = grid.b(y_mm);
  const double fa = std::floor(cubic_ ? a : a + 0.5), fb = std::floor(cubic_ ? b : b + 0.5);
  const int i = static_cast<int>(fa) - 1, j = static_cast<int>(fb) - 1;
  if (!level.patched || i != level.i || j != level.j) {
    level.grid.patch(i, j, level.frames, level.patch);
    level.i = i;
    level.j = j;
    level.patched = true;
  }
  const Basis h = cubic_ ? cubicBasis(a - fa) : quadraticBasis(a - fa);
  const Basis v = cubic_ ? cubicBasis(b - fb) : quadraticBasis(b - fb);
  const Patch& p = level.patch;
  const Float4 row = p[0] * v.value[0] + p[1] * v.value[1] + p[2] * v.value[2] + p[3] * v.value[3];
  const Float4 row_slope = p[0] * v.slope[0] + p[1] * v.slope[1] + p[2] * v.slope[2] + p[3] * v.slope[3];
  const Float4 row_bend = p[0] * v.bend[0] + p[1] * v.bend[1] + p[2] * v.bend[2] + p[3] * v.bend[3];
  const double da = grid.aPerMm(), db = grid.bPerMm();
  const auto dot = [](const Float4& l, const Float4& r) { return static_cast<double>(sum(l * r)); };
  return {dot(row, h.value),
          dot(row, h.slope) * da,
          dot(row_slope, h.value) * db,
          dot(row, h.bend) * da * da,
          dot(row_slope, h.slope) * da * db,
          dot(row_bend, h.value) * db * db};
}

SurfacePoint FeltSurface::at(double x_mm, double y_mm) RELIEVO_RT {
  // Far outside the picture every place is alike, and a number too large for a grid index would be undefined.
  constexpr double kFar = 1e6;
  x_mm = std::min(std::max(x_mm, -kFar), kFar);
  y_mm = std::min(std::max(y_mm, -kFar), kFar);
  const SurfacePoint n = at(narrow_, x_mm, y_mm);
  if (!two_levels_) return n;
  const SurfacePoint w = at(wide_, x_mm, y_mm);
  const SoftClamp c(w.z - n.z, scale_.clamp_mm);
  const double ux = w.zx - n.zx, uy = w.zy - n.zy;
  return {n.z + c.value,
          n.zx + c.slope * ux,
          n.zy + c.slope * uy,
          n.zxx + c.slope * (w.zxx - n.zxx) + c.bend * ux * ux,
          n.zxy + c.slope * (w.zxy - n.zxy) + c.bend * ux * uy,
          n.zyy + c.slope * (w.zyy - n.zyy) + c.bend * uy * uy};
}

void FeltSurface::prepare(double x_mm, double y_mm, int points) RELIEVO_RT {
  prepare(narrow_, x_mm, y_mm, points);
  if (two_levels_) prepare(wide_, x_mm, y_mm, points);
}

void FeltSurface::prepare(Level& level, double x_mm, double y_mm, int points) RELIEVO_RT {
  const int i0 = static_cast<int>(std::floor(level.grid.a(x_mm))) - 1;
  const int j0 = static_cast<int>(std::floor(level.grid.b(y_mm))) - 1;
  for (int j = j0; j < j0 + 4; ++j) {
    for (int i = i0; i < i0 + 4; ++i) {
      if (level.grid.fill(i, j, level.frames, level.frames.wanted)) continue;
      if (points > 0 && level.grid.fill(i, j, level.frames, slots_in_use_)) --points;
    }
  }
}

}  // namespace relievo
