// SPDX-License-Identifier: Apache-2.0
// Random depth, random motion, random finger: what must hold in every tick, in every tick.
//   touch_fuzz [SEED [TICKS [METHOD]]]
// A seed is an episode of 1000 ticks; what fails prints its seed, and `touch_fuzz SEED 1000` shows it again.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "app/haptics/methods.h"
#include "app/haptics/relievo_method.h"
#include "app/haptics/safety.h"
#include "app/haptics/shots.h"

namespace relievo {
namespace {

constexpr int kTicksOfEpisode = 1000;
constexpr double kTickS = 0.001;

// Steele, Lea and Flood 2014: a seed is a whole number, neighbours are independent.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15 + 1) {}
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  double within(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  bool chance(double p) { return within(0, 1) < p; }
  int below(int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); }

 private:
  std::uint64_t state_;
};

// A relief that moves, and what spoils its pictures.
class Film {
 public:
  explicit Film(Random& random) : random_(random) {
    cols_ = 32 + random.below(40);
    rows_ = 24 + random.below(30);
    const double pitch = random.chance(0.7) ? 160.0 / 720 : random.within(0.04, 1.2);
    volume_ = {cols_ * pitch, rows_ * pitch, 40};
    bits_ = random.chance(0.5) ? 8 : 16;
    period_s_ = 1 / random.within(10, 120);
    newScene();
  }

  [[nodiscard]] const DisplayVolume& volume() const { return volume_; }
  [[nodiscard]] double periodS() const { return period_s_; }
  // Another picture altogether; the finger is not told.
  void newScene() {
    for (Wave& w : waves_) {
      w = {random_.within(-8, 8), random_.within(-1.5, 1.5), random_.within(-1.5, 1.5), random_.within(0, 6),
           random_.within(-60, 60)};
    }
    level_ = random_.within(5, 35);
    slope_x_ = random_.within(-0.5, 0.5);
    slope_y_ = random_.within(-0.5, 0.5);
    const double speeds[] = {0, 0, 50, 300, 3000};
    const double most = speeds[random_.below(5)];
    speed_ = random_.within(-most, most);
    noise_ = random_.chance(0.5) ? 0 : std::pow(10, random_.within(-3, -0.5));
    holes_ = random_.chance(0.6) ? 0 : random_.within(0, 0.4);
    spikes_ = random_.chance(0.6) ? 0 : random_.within(0, 0.02);
    block_ = random_.chance(0.5);
    white_ = random_.chance(0.05);
  }

  TimedSurface next(double t) {
    if (random_.chance(0.02)) newScene();
    if (random_.chance(0.1)) speed_ = -speed_;
    level_ = std::clamp(level_ + speed_ * period_s_, -10.0, 50.0);
    const GridMapping grid(volume_, cols_, rows_);
    const double full = std::exp2(bits_) - 1;
    const int bytes = bits_ > 8 ? 2 : 1;
    const auto samples = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(cols_) * rows_ * bytes);
    std::uint8_t* out = samples->data();
    const int block_c = random_.below(cols_), block_r = random_.below(rows_), block_z = random_.below(65536);
    for (int r = 0; r < rows_; ++r) {
      for (int c = 0; c < cols_; ++c) {
        auto code =
            static_cast<std::uint32_t>(std::lround(std::clamp(height(grid.x(c), grid.y(r), t) / 40, 0.0, 1.0) * full));
        if (block_ && c > block_c && r > block_r) code = static_cast<std::uint32_t>(block_z) >> (16 - bits_);
        if (white_ || (spikes_ > 0 && random_.chance(spikes_)))
          code = static_cast<std::uint32_t>(random_.bits()) >> (32 - bits_);
        if (holes_ > 0 && random_.chance(holes_)) code = 0;
        *out++ = static_cast<std::uint8_t>(code & 0xff);
        if (bytes == 2) *out++ = static_cast<std::uint8_t>(code >> 8);
      }
    }
    Frame frame;
    frame.pts = mediaTime(t);
    frame.width = cols_;
    frame.height = rows_;
    frame.range = ColorRange::Full;
    frame.plane_count = 1;
    frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(bytes), .bits = static_cast<std::uint8_t>(bits_)};
    frame.planes[0] = {samples->data(), static_cast<std::ptrdiff_t>(cols_) * bytes};
    TimedSurface surface{.time = frame.pts, .owner = samples};
    const DepthCalibration calibration{.bits = bits_, .invalid_code = 0};
    if (const auto field = HeightField::make(frame, calibration, volume_)) surface.field = *field;
    return surface;
  }

 private:
  struct Wave {
    double size, kx, ky, phase, rate;
  };
  double height(double x, double y, double t) {
    double z = level_ + slope_x_ * x + slope_y_ * y;
    for (const Wave& w : waves_) z += w.size * std::sin(w.kx * x + w.ky * y + w.phase + w.rate * t);
    return noise_ > 0 ? z + 40 * noise_ * (random_.within(-2, 2)) : z;
  }

  Random& random_;
  int cols_, rows_, bits_;
  DisplayVolume volume_;
  double period_s_;
  Wave waves_[2]{};
  double level_ = 20, slope_x_ = 0, slope_y_ = 0, speed_ = 0, noise_ = 0, holes_ = 0, spikes_ = 0;
  bool block_ = false, white_ = false;
};

// Rests, strokes, darts; presses into whatever is there, and leaves the picture now and then.
class Finger {
 public:
  Finger(Random& random, const DisplayVolume& volume)
      : random_(random), volume_(volume), at_(0, 0, random.chance(0.9) ? 62 : random.within(0, 40)) {}

  glm::dvec3 next() {
    if (left_-- <= 0) {
      left_ = random_.below(120);
      const double speeds[] = {0, 20, 100, 500, 2000, 5000};
      speed_ = speeds[random_.below(6)];
      target_ = {random_.within(-0.6, 0.6) * volume_.width_mm, random_.within(-0.6, 0.6) * volume_.height_mm,
                 random_.within(-5, 50)};
      if (random_.chance(0.4)) target_.z = at_.z;
    }
    const glm::dvec3 way = target_ - at_;
    const double length = glm::length(way), step = speed_ * kTickS;
    if (length > 0) at_ += way * std::min(1.0, step / length);
    if (random_.chance(2e-4)) return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    if (random_.chance(5e-4))
      return at_ + glm::dvec3(random_.within(-50, 50), random_.within(-50, 50), random_.within(-50, 50));
    return at_;
  }

 private:
  Random& random_;
  DisplayVolume volume_;
  glm::dvec3 at_, target_{0};
  double speed_ = 0;
  int left_ = 0;
};

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
      const TimeLaw laws[] = {TimeLaw::Hold, TimeLaw::Linear, TimeLaw::BSpline, TimeLaw::Fitted};
      if (random_.chance(0.5)) {
        config.scale.narrow_mm = random_.within(0.1, 0.4);
        config.scale.wide_mm = random_.within(0.2, 1.0);
        config.scale.clamp_mm = random_.within(0.1, 0.6);
        config.scale.narrow_time = laws[random_.below(4)];
        config.scale.wide_time = laws[random_.below(4)];
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
      if (random_.chance(0.001)) media -= random_.within(0, 0.05);  // a clock that is set right
      feed(media);
      touch(finger_.next(), mediaTime(media), elapsed);
    }
  }

 private:
  // Frames come in time, or late, or not; sometimes all are gone.
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
    // The hand's share is counted from the last position that was one.
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
  Film film_;
  Finger finger_;
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
    std::fprintf(stderr, "touch_fuzz: %s: no such method\n", method.c_str());
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
