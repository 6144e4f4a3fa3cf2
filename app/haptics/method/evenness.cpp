// SPDX-License-Identifier: Apache-2.0
// Fourth differences of thirteen means, or second ones of twenty-one.
#include "app/haptics/method/evenness.h"

#include <algorithm>
#include <cmath>

#include "platform/prefetch.h"

namespace relievo {
namespace {

int below(double v) RELIEVO_RT {
  const int whole = static_cast<int>(v);
  return v < whole ? whole - 1 : whole;
}
constexpr double kFar = 1e6;

// The greatest second difference of the nine points around a place; NaN beside a hole.
template <class At>
float mostBent(At&& at) RELIEVO_RT {
  float most = 0;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const float twice = 2 * at(i, j);
      const float bend =
          std::max(std::abs(at(i - 1, j) - twice + at(i + 1, j)), std::abs(at(i, j - 1) - twice + at(i, j + 1)));
      if (!(bend <= most)) most = bend;
      if (std::isnan(most)) return most;
    }
  }
  return most;
}

}  // namespace

float Evenness::evennessOf(ControlGrid& grid, int i, int j, const ControlGrid::Frames& one) const RELIEVO_RT {
  const auto at = [&](int di, int dj) RELIEVO_RT { return grid.mean(i + di, j + dj, one); };
  const float here = at(0, 0), left = at(-1, 0), right = at(1, 0), above = at(0, -1), under = at(0, 1);
  const float across = at(-2, 0) + at(2, 0) - 4 * (left + right) + 6 * here;
  const float down = at(0, -2) + at(0, 2) - 4 * (above + under) + 6 * here;
  const float both = at(-1, -1) + at(1, -1) + at(-1, 1) + at(1, 1) - 2 * (left + right + above + under) + 4 * here;
  if (std::isnan(across + down + both)) return edges_ == Edges::Even ? 1 : 0;  // beside a hole
  float most = std::max({std::abs(across), std::abs(down), std::abs(both)});
  if (edges_ == Edges::Uneven) most = mostBent(at);
  if (std::isnan(most)) return 0;
  const auto within01 = [](float v) RELIEVO_RT { return std::min(std::max(v, 0.F), 1.F); };
  const float none_mm = (edges_ == Edges::Even ? kUneven : kBent) * most_mm_;
  const float even = within01((none_mm - most) / (none_mm - most_mm_));
  if (edges_ == Edges::Uneven) return even;
  return std::min(even + within01((most - kLeastEdgeMm) / (kEdgeMm - kLeastEdgeMm)), 1.F);
}

RELIEVO_TICK_CODE void Evenness::begin(const FrameSlots& slots, const FrameMoment& moment) RELIEVO_RT {
  slots_ = &slots;
  frames_ = {slots.of_frame[static_cast<std::size_t>(moment.present)],
             slots.of_frame[static_cast<std::size_t>(std::min(moment.present + 1, moment.last))]};
  share_ = static_cast<float>(moment.share);
}

void Evenness::judgeAnew(ControlGrid& grid, double x_mm, double y_mm) RELIEVO_RT {
  const auto bounded = [](double v) RELIEVO_RT { return std::min(std::max(v, -kFar), kFar); };
  judged_ = frames_;
  place_ = {below(bounded(grid.a(x_mm))), below(bounded(grid.b(y_mm)))};
  ControlGrid::Frames one{.window = slots_->window, .frame_of_slot = slots_->frame};
  const auto judgeIn = [&](int slot) RELIEVO_RT {
    one.wanted = 1U << slot;
    const int i = place_.i, j = place_.j;
    return Float4{evennessOf(grid, i, j, one), evennessOf(grid, i + 1, j, one), evennessOf(grid, i, j + 1, one),
                  evennessOf(grid, i + 1, j + 1, one)};
  };
  present_ = judgeIn(frames_.present);
  next_ = frames_ == TwoFrames{frames_.present, frames_.present} ? present_ : judgeIn(frames_.next);
  all_ = none_ = true;
  for (int k = 0; k < 4; ++k) {
    all_ = all_ && present_[k] >= 1 && next_[k] >= 1;
    none_ = none_ && present_[k] <= 0 && next_[k] <= 0;
  }
}

RELIEVO_TICK_CODE SurfacePoint Evenness::at(const ControlGrid& grid, double x_mm, double y_mm) const RELIEVO_RT {
  struct Rise {
    double value, slope, bend;  // t^3 (6 t^2 - 15 t + 10)
    explicit Rise(double v) RELIEVO_RT {
      const double t = std::min(std::max(v, 0.0), 1.0), rest = 1 - t;
      value = t * t * t * (10 + t * (6 * t - 15));
      slope = 30 * t * t * rest * rest;
      bend = 60 * t * rest * (rest - t);
    }
  };
  const Rise a(grid.a(x_mm) - place_.i), b(grid.b(y_mm) - place_.j);
  const Float4 v = present_ + (next_ - present_) * share_;
  const double from = static_cast<double>(v[0]), da = static_cast<double>(v[1]) - from,
               db = static_cast<double>(v[2]) - from, dab = static_cast<double>(v[3]) - from - da - db;
  const double pa = grid.aPerMm(), pb = grid.bPerMm();
  const double by_a = da + dab * b.value, by_b = db + dab * a.value;
  return {from + by_a * a.value + db * b.value, by_a * a.slope * pa,    by_b * b.slope * pb, by_a * a.bend * pa * pa,
          dab * a.slope * b.slope * pa * pb,    by_b * b.bend * pb * pb};
}

}  // namespace relievo
