// SPDX-License-Identifier: Apache-2.0
// The laws of time as polynomials for six frames: two before the present one, itself, three after it.
#include "app/haptics/method/frame_weights.h"

#include <algorithm>

#include "app/haptics/method/float4.h"
#include "platform/prefetch.h"

namespace relievo {
namespace {

constexpr std::size_t kTaps = FrameTaps::kCount;
// Polynomials in the share s, 0 .. 1, of the way from the present frame to the next: of[k][i] is the factor of s^k in
// the weight of frame present - 2 + i.
struct TapTable {
  alignas(16) std::array<std::array<float, 8>, 4> of{};
};

constexpr TapTable kHold{{{{0, 0, 1}}}};
constexpr TapTable kLinear{{{{0, 0, 1}, {0, 0, -1, 1}}}};
// Uniform cubic B-spline (de Boor, A Practical Guide to Splines).
constexpr TapTable kBSpline{
    {{{0, 1.F / 6, 4.F / 6, 1.F / 6}, {0, -0.5F, 0, 0.5F}, {0, 0.5F, -1, 0.5F}, {0, -1.F / 6, 0.5F, -0.5F, 1.F / 6}}}};
// Five periods around the present: the oldest frame leaves as the newest comes.
constexpr TapTable kMean{{{{0.2F, 0.2F, 0.2F, 0.2F, 0.2F}, {-0.2F, 0, 0, 0, 0, 0.2F}}}};

// The same B-spline on coefficients c_k = f_k - (f_{k-1} - 2 f_k + f_{k+1})/6 reproduces cubics exactly (de Boor and
// Fix 1973, spline approximation by quasi-interpolants). What this adds, expressed as weights of the frames.
constexpr TapTable kAdded = [] {
  TapTable added;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& b = kBSpline.of[k];
    for (std::size_t i = 0; i < kTaps; ++i) {
      added.of[k][i] = ((i == 0 ? 0 : -b[i - 1]) + 2 * b[i] - b[i + 1]) / 6;
    }
  }
  return added;
}();
constexpr TapTable kFitted = [] {
  TapTable fitted;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < kTaps; ++i) fitted.of[k][i] = kBSpline.of[k][i] + kAdded.of[k][i];
  }
  return fitted;
}();

const TapTable& tableOf(TimeLaw law) RELIEVO_RT {
  switch (law) {
    case TimeLaw::Hold:
      return kHold;
    case TimeLaw::Linear:
      return kLinear;
    case TimeLaw::BSpline:
    case TimeLaw::Adapted:
      return kBSpline;
    case TimeLaw::Fitted:
      return kFitted;
    case TimeLaw::Mean:
      break;
  }
  return kMean;
}

void evaluate(const TapTable& table, double share, FrameTaps& out) RELIEVO_RT {
  const auto s = static_cast<float>(share);
  for (std::size_t half = 0; half < 8; half += 4) {
    const auto of = [&](std::size_t k) RELIEVO_RT { return load4(&table.of[k][half]); };
    store4(&out.weight[half], ((of(3) * s + of(2)) * s + of(1)) * s + of(0));
  }
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
  *this = at(window, now);
}

RELIEVO_TICK_CODE FrameMoment FrameMoment::at(const SurfaceWindow& window, MediaTime now) const RELIEVO_RT {
  const auto time = [&](int i) { return window.frames[static_cast<std::size_t>(i)].time; };
  FrameMoment moment = *this;
  moment.share = 0;
  if (now <= time(present)) return moment;
  // After the last frame the spline settles within one period, as long as the previous one, and then holds.
  const Duration period = present + 1 < window.count ? time(present + 1) - time(present)
                          : present > 0              ? time(present) - time(present - 1)
                                                     : Duration(0);
  if (period > Duration(0)) moment.share = std::min(toSeconds(now - time(present)) / toSeconds(period), 1.0);
  return moment;
}

FrameTaps::FrameTaps(const FrameMoment& moment, TimeLaw law) RELIEVO_RT {
  evaluate(tableOf(law), moment.share, *this);
}

FrameTaps FrameTaps::addedByFitted(const FrameMoment& moment) RELIEVO_RT {
  FrameTaps added;
  evaluate(kAdded, moment.share, added);
  return added;
}

FrameWeights frameWeights(const FrameMoment& moment, const FrameTaps& taps) RELIEVO_RT {
  FrameWeights weight{};
  if (moment.present < 0) return weight;
  for (int i = 0; i < static_cast<int>(kTaps); ++i) {
    weight[FrameTaps::frame(moment, i)] += taps.weight[static_cast<std::size_t>(i)];
  }
  return weight;
}

FrameWeights carriedWeights(const SurfaceWindow& window, const FrameMoment& moment, TimeLaw law,
                            Duration carried) RELIEVO_RT {
  FrameWeights weight = frameWeights(moment, FrameTaps(moment, law));
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
