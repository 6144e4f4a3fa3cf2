// SPDX-License-Identifier: Apache-2.0
// The list of contenders.
#include "app/lab/measure/contenders.h"

#include <algorithm>
#include <array>

#include "app/depth_window/touch_plan.h"
#include "app/haptics/method/frame_weights.h"
#include "app/lab/rival/bullet_proxy.h"
#include "app/lab/rival/smoothed_film.h"

namespace relievo {
namespace {

constexpr MethodConfig with(std::optional<SpaceLaw> space, std::optional<TimeLaw> time) {
  return {.space = space, .time = time, .jump_threshold = false};
}

constexpr MethodConfig onScale(const FeltScale& scale) {
  MethodConfig config{.jump_threshold = false};
  config.scale = scale;
  return config;
}

constexpr MethodConfig oneWidth(double mm) {
  return onScale({.narrow_mm = mm, .wide_mm = mm});
}

constexpr MethodConfig kOwn = with({}, {});
constexpr bool kPlanned = true, kFixed = true, kSmoothed = true;
constexpr const char* kBullet = "bullet";  // not a name for makeMethod

constexpr std::array kContenders{
    Contender{"relievo", "relievo", kOwn, kPlanned},
    Contender{"god-object", "relievo", with(SpaceLaw::Triangles, {})},
    Contender{"god-object-smoothed", "relievo", with(SpaceLaw::Triangles, {}), !kPlanned, !kFixed, kSmoothed},
    Contender{"bullet", kBullet, kOwn},
    Contender{"bullet-smoothed", kBullet, kOwn, !kPlanned, !kFixed, kSmoothed},
    Contender{"modified-proxy-graph", "modified-proxy-graph", kOwn},
    Contender{"proxy-graph", "proxy-graph", kOwn},
    Contender{"proxy-blend", "proxy-blend", kOwn},
    Contender{"penalty", "penalty", kOwn},

    Contender{"relievo quadratic", "relievo", with(SpaceLaw::Quadratic, {}), kPlanned, kFixed},
    Contender{"relievo hold", "relievo", with({}, TimeLaw::Hold), kPlanned, kFixed},
    Contender{"relievo linear", "relievo", with({}, TimeLaw::Linear), kPlanned, kFixed},
    Contender{"relievo bspline", "relievo", with({}, TimeLaw::BSpline), kPlanned, kFixed},
    Contender{"relievo fitted", "relievo", with({}, TimeLaw::Fitted), kPlanned, kFixed},
    Contender{"relievo 0.28 + 0.72", "relievo", onScale({}), !kPlanned, kFixed},
    Contender{"relievo 0.14", "relievo", oneWidth(0.14), !kPlanned, kFixed},
    Contender{"relievo 0.28", "relievo", oneWidth(0.28), !kPlanned, kFixed},
    Contender{"relievo 0.43", "relievo", oneWidth(0.43), !kPlanned, kFixed},
    Contender{"relievo 0.72", "relievo", oneWidth(0.72), !kPlanned, kFixed},
    Contender{"relievo 1.0", "relievo", oneWidth(1.0), !kPlanned, kFixed},
    Contender{"god-object hold", "relievo", with(SpaceLaw::Triangles, TimeLaw::Hold), !kPlanned, kFixed},
    Contender{"modified hold", "modified-proxy-graph", with({}, TimeLaw::Hold), !kPlanned, kFixed},
    Contender{"proxy-graph linear", "proxy-graph", with({}, TimeLaw::Linear), !kPlanned, kFixed},
};

MethodConfig configOn(const MemoryFilm& film, const Contender& who) {
  MethodConfig config = who.config;
  if (who.planned) config.scale = planFilm(film.frames()).scale;
  return config;
}

bool isBullet(const Contender& who) {
  return who.method == std::string_view(kBullet);
}

std::vector<Contender> thoseAtHand() {
  std::vector<Contender> all(kContenders.begin(), kContenders.end());
  if (makeBulletProxy(1) == nullptr) std::erase_if(all, isBullet);
  return all;
}

}  // namespace

std::unique_ptr<TouchMethod> Contender::make(const MemoryFilm& film) const {
  if (isBullet(*this)) return makeBulletProxy(config.stiffness_n_per_mm);
  return makeMethod(method, configOn(film, *this));
}

ContenderParts Contender::parts(const MemoryFilm& film) const {
  const double width =
      smoothed ? blurWidthMm(planFilm(film.frames()).measure) : std::numeric_limits<double>::quiet_NaN();
  if (isBullet(*this)) return {.space = "triangles", .time = "linear", .wide_mm = width, .look_ahead_frames = 1};
  const MethodParts parts = *partsOf(method, configOn(film, *this));  // the list holds such alone
  ContenderParts out{.space = name(parts.space),
                     .time = name(parts.time),
                     .wide_mm = width,
                     .look_ahead_frames = framesAhead(parts.time)};
  if (parts.scale) {
    out.narrow_mm = parts.scale->narrow_mm;
    out.wide_mm = parts.scale->wide_mm;
    out.look_ahead_frames = std::max(out.look_ahead_frames, framesAhead(parts.scale->narrow_time));
  }
  return out;
}

FilmViews::FilmViews(const MemoryFilm& film)
    : raw_(film), sigma_mm_(blurWidthMm(planFilm(film.frames()).measure)), smoothed_(smoothedFilm(film, sigma_mm_)) {}

std::vector<PlayedTick> playPath(const FilmViews& film, const Contender& who, std::span<const HipTick> path,
                                 std::span<const TrueTouch> truth) {
  return playPath(film.of(who), *who.make(film.raw()), path, truth);
}

std::span<const Contender> contenders() {
  static const std::vector<Contender> all = thoseAtHand();
  return all;
}

const Contender* contender(std::string_view label) {
  const auto all = contenders();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Contender& c) { return label == c.label; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace relievo
