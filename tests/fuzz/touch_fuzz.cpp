// SPDX-License-Identifier: Apache-2.0
// Random depth, motion and finger; the invariants are checked in every tick.
//   touch_fuzz [SEED [TICKS [METHOD]]]
// A seed defines an episode of 1000 ticks; a failure prints its seed, and `touch_fuzz SEED 1000` reproduces it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/haptics/baseline/methods.h"
#include "app/haptics/method/relievo_method.h"
#include "app/haptics/task/safety.h"
#include "tests/fuzz/random_scene.h"

namespace relievo {
namespace {

constexpr int kTicksOfEpisode = 1000;
constexpr double kTickS = 0.001;

struct Tally {
  std::uint64_t ticks = 0, contact = 0, misses = 0, misses_at_cuts = 0, faults = 0;
};

class Episode {
 public:
  Episode(std::uint64_t seed, const std::string& method, Tally& tally)
      : seed_(seed), tally_(tally), random_(seed), film_(random_), finger_(random_, film_.volume()) {
    stiffness_ = random_.within(0.1, 1.5);
    if (method == kDefaultMethod) {
      RelievoMethod::Config config{.stiffness_n_per_mm = stiffness_};
      const TimeLaw laws[] = {TimeLaw::Hold,   TimeLaw::Linear,  TimeLaw::BSpline,
                              TimeLaw::Fitted, TimeLaw::Adapted, TimeLaw::Mean};
      if (random_.chance(0.5)) {
        config.scale.narrow_mm = random_.within(0.1, 0.4);
        config.scale.wide_mm = random_.within(0.2, 1.0);
        config.scale.clamp_mm = random_.within(0.1, 0.6);
        config.scale.narrow_steady_mm = random_.within(0, 0.1);
        config.scale.wide_steady_mm = random_.within(0, 0.1);
        config.scale.narrow_time = laws[random_.below(std::size(laws))];
        config.scale.wide_time = laws[random_.below(std::size(laws))];
        if (random_.chance(0.5)) {
          config.scale.broad_mm = random_.within(1.2, 3) * config.scale.wide_mm;
          config.scale.broad_even_mm = random_.within(0.01, 0.5);
        }
        if (random_.chance(0.5)) {
          config.scale.middle_mm = random_.within(0.3, 1) * config.scale.wide_mm;
          config.scale.wide_even_mm = random_.within(0.01, 0.5);
        }
      }
      if (random_.chance(0.3)) config.friction = {random_.within(0, 1), random_.within(0, 0.5)};
      auto own = std::make_unique<RelievoMethod>(config);
      relievo_ = own.get();
      method_ = std::move(own);
    } else {
      method_ = makeMethod(method, {.stiffness_n_per_mm = stiffness_});
    }
    safety_ = SafetyFilter({}, stiffness_);
  }

  void run() {
    double media = 0, rate = 1;
    for (tick_ = 0; tick_ < kTicksOfEpisode; ++tick_) {
      if (random_.chance(0.002)) rate = random_.chance(0.5) ? 0 : random_.within(0.2, 3);
      const int missed = random_.chance(0.005) ? random_.below(20) : 0;
      const double elapsed = kTickS * (1 + missed);
      media += rate * elapsed;
      if (random_.chance(0.001)) media -= random_.within(0, 0.05);  // the clock is corrected
      feed(media);
      touch(finger_.next(kTickS), mediaTime(media), elapsed);
    }
  }

 private:
  // Frames come in time, late or never; sometimes all are missing.
  void feed(double media) {
    const double ahead = late_ > 0 ? -0.5 * film_.periodS() : 2.5 * film_.periodS();
    late_ = late_ > 0 ? late_ - 1 : (random_.chance(0.002) ? random_.below(150) : 0);
    bool changed = false;
    while (newest_s_ < media + ahead) {
      newest_s_ = std::max(newest_s_ + film_.periodS(), media - 4 * film_.periodS());
      const TimedSurface frame = film_.next(newest_s_);
      if (random_.chance(0.05) && !frames_.empty()) continue;  // lost
      frames_.push_back(frame);
      changed = true;
    }
    const auto over = [&](std::size_t i) { return i < frames_.size() && toSeconds(frames_[i].time) <= media; };
    while (over(3) || frames_.size() > SurfaceWindow::kCapacity) {
      frames_.pop_front();
      changed = true;
    }
    if (random_.chance(0.001)) {
      ++window_.epoch;
      frames_.clear();
      shots_.forget();
      film_.newScene();
      changed = true;
    }
    if (!changed) return;
    shots_.mark(frames_);
    window_.count = static_cast<int>(frames_.size());
    std::copy(frames_.begin(), frames_.end(), window_.frames.begin());
  }

  void touch(const glm::dvec3& hip, MediaTime now, double elapsed) {
    const Touch touch = method_->update(hip, window_, now);
    const double depth = relievo_ != nullptr ? relievo_->depthMm() : 0;
    const bool buried = relievo_ != nullptr && relievo_->buried();
    method_->upkeep(window_, now);
    const glm::dvec3 sent = safety_.apply(touch.force_n, hip, elapsed);
    ++tally_.ticks;
    tally_.contact += touch.contact ? 1 : 0;

    const bool position = std::isfinite(hip.x);
    if (position && !std::isfinite(glm::dot(touch.proxy_mm, touch.force_n))) fault("not finite", 0);
    const glm::dvec3 spring = stiffness_ * (touch.proxy_mm - hip);
    if (position && glm::distance(touch.force_n, spring) > 1e-6 * (1 + glm::length(spring)))
      fault("not the spring's force", 0);
    const double size = glm::length(sent);
    if (!(size <= 10 * (1 + 1e-9))) fault("over the limit, N", size);
    // The hand's share is measured from the last valid position.
    if (position && had_hip_) {
      const double slew = (glm::distance(sent, sent_) - stiffness_ * glm::distance(hip, hip_)) / elapsed;
      if (!(slew <= 50 * (1 + 1e-6))) fault("slew, N/s", slew);
    }
    const bool cut = window_.epoch != epoch_ || shotAt(now) != shot_;
    if (!touch.contact && position && !buried && depth > 1e-6) {
      ++(cut ? tally_.misses_at_cuts : tally_.misses);
      if (!cut) say("inside but free, mm", depth);
    }
    epoch_ = window_.epoch;
    shot_ = shotAt(now);
    had_hip_ = position;
    hip_ = hip;
    sent_ = sent;
  }

  [[nodiscard]] std::uint32_t shotAt(MediaTime now) const {
    std::uint32_t shot = 0;
    for (int i = 0; i < window_.count; ++i) {
      if (i == 0 || window_.frames[static_cast<std::size_t>(i)].time <= now)
        shot = window_.frames[static_cast<std::size_t>(i)].shot;
    }
    return shot;
  }

  void fault(const char* what, double figure) {
    ++tally_.faults;
    say(what, figure);
  }
  void say(const char* what, double figure) {
    if (tally_.faults + tally_.misses <= 20) {
      std::printf("seed %llu tick %d: %s %g\n", static_cast<unsigned long long>(seed_), tick_, what, figure);
    }
  }

  std::uint64_t seed_;
  Tally& tally_;
  Random random_;
  RandomFilm film_;
  RandomFinger finger_;
  double stiffness_ = 0.5;
  std::unique_ptr<TouchMethod> method_;
  RelievoMethod* relievo_ = nullptr;
  SafetyFilter safety_;
  std::deque<TimedSurface> frames_;
  ShotFinder shots_;
  SurfaceWindow window_;
  double newest_s_ = -1;
  int late_ = 0, tick_ = 0;
  std::uint32_t epoch_ = 0, shot_ = 0;
  bool had_hip_ = false;
  glm::dvec3 hip_{0}, sent_{0};
};

int fuzz(std::uint64_t seed, std::uint64_t ticks, const std::string& method) {
  if (makeMethod(method, {}) == nullptr) {
    std::fprintf(stderr, "touch_fuzz: %s: unknown method\n", method.c_str());
    return 2;
  }
  Tally tally;
  for (; tally.ticks < ticks; ++seed) std::make_unique<Episode>(seed, method, tally)->run();
  std::printf("%s: %llu ticks, %llu in contact, %llu inside but free (and %llu at cuts), %llu other faults\n",
              method.c_str(), static_cast<unsigned long long>(tally.ticks),
              static_cast<unsigned long long>(tally.contact), static_cast<unsigned long long>(tally.misses),
              static_cast<unsigned long long>(tally.misses_at_cuts), static_cast<unsigned long long>(tally.faults));
  return tally.misses + tally.misses_at_cuts + tally.faults == 0 ? 0 : 1;
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  const std::uint64_t ticks = argc > 2 ? static_cast<std::uint64_t>(std::strtod(argv[2], nullptr)) : 300000;
  return relievo::fuzz(seed, ticks, argc > 3 ? argv[3] : relievo::kDefaultMethod);
}
