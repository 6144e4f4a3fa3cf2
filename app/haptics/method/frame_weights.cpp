// SPDX-License-Identifier: Apache-2.0
// Five laws of time as weights of six frames: two before the present one, itself, three after it.
#include "app/haptics/method/frame_weights.h"

#include <algorithm>

#include "platform/prefetch.h"

namespace relievo {
namespace {

using Taps = std::array<double, 6>;  // frames present-2 .. present+3

// Uniform cubic B-spline at s in [0, 1) after the present frame (de Boor, A Practical Guide to Splines).
Taps bspline(double s) RELIEVO_RT {
  const double r = 1 - s, s2 = s * s, s3 = s2 * s;
  return {0, r * r * r / 6, (4 - 6 * s2 + 3 * s3) / 6, (1 + 3 * s + 3 * s2 - 3 * s3) / 6, s3 / 6, 0};
}

// The same B-spline on coefficients c_k = f_k - (f_{k-1} - 2 f_k + f_{k+1})/6, which reproduces cubics exactly (de Boor
// and Fix 1973, spline approximation by quasi-interpolants), expressed as weights of the frames.
Taps fitted(double s) RELIEVO_RT {
  const Taps b = bspline(s);
  Taps taps{};
  for (std::size_t i = 1; i <= 4; ++i) {
    taps[i - 1] -= b[i] / 6;
    taps[i] += b[i] * 4 / 3;
    taps[i + 1] -= b[i] / 6;
  }
  return taps;
}

// Five periods around the present: the oldest frame leaves as the newest comes.
Taps mean(double s) RELIEVO_RT {
  return {(1 - s) / 5, 0.2, 0.2, 0.2, 0.2, s / 5};
}

Taps tapsOf(TimeLaw law, double s) RELIEVO_RT {
  return law == TimeLaw::BSpline ? bspline(s) : law == TimeLaw::Fitted ? fitted(s) : mean(s);
}

}  // namespace

RELIEVO_TICK_CODE FrameMoment::FrameMoment(const SurfaceWindow& window, MediaTime now) RELIEVO_RT {
  if (window.count == 0) return;
  const auto frame = [&](int i) -> const TimedSurface& { return window.frames[static_cast<std::size_t>(i)]; };
  present = window.count - 1;
  while (present > 0 && frame(present).time > now) --present;
  first = last = present;
  while (first > 0 && frame(first - 1).shot == frame(present).shot) --first;
  while (last + 1 < window.count && frame(last + 1).shot == frame(present).shot) ++last;
  if (now <= frame(present).time) return;
  // After the last frame the spline settles within one period, as long as the previous one, and then holds.
  const Duration period = present + 1 < window.count ? frame(present + 1).time - frame(present).time
                          : present > 0              ? frame(present).time - frame(present - 1).time
                                                     : Duration(0);
  if (period > Duration(0)) share = std::min(toSeconds(now - frame(present).time) / toSeconds(period), 1.0);
}

FrameWeights frameWeights(const FrameMoment& moment, TimeLaw law) RELIEVO_RT {
  FrameWeights weight{};
  if (moment.present < 0) return weight;
  const auto give = [&](int i, double share) {
    weight[static_cast<std::size_t>(std::clamp(i, moment.first, moment.last))] += static_cast<float>(share);
  };
  const double s = moment.share;
  switch (law) {
    case TimeLaw::Hold:
      give(moment.present, 1);
      break;
    case TimeLaw::Linear:
      give(moment.present, 1 - s);
      give(moment.present + 1, s);
      break;
    case TimeLaw::BSpline:
    case TimeLaw::Fitted:
    case TimeLaw::Mean: {
      const Taps taps = tapsOf(law, s);
      for (int i = 0; i < 6; ++i) give(moment.present - 2 + i, taps[static_cast<std::size_t>(i)]);
      break;
    }
  }
  return weight;
}

FrameWeights carriedWeights(const SurfaceWindow& window, const FrameMoment& moment, TimeLaw law,
                            Duration carried) RELIEVO_RT {
  FrameWeights weight = frameWeights(moment, law);
  if (moment.present < 0) return weight;
  // The slope from frame i - 1 to frame i, times `share` of the duration.
  const auto go = [&](int i, double share) RELIEVO_RT {
    if (i - 1 < moment.first || i > moment.last) return;
    const auto at = static_cast<std::size_t>(i);
    const Duration period = window.frames[at].time - window.frames[at - 1].time;
    const auto periods = static_cast<float>(share * toSeconds(carried) / toSeconds(period));
    weight[at] += periods;
    weight[at - 1] -= periods;
  };
  go(moment.present, 1 - moment.share);
  go(moment.present + 1, moment.share);
  return weight;
}

}  // namespace relievo
