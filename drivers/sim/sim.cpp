// SPDX-License-Identifier: Apache-2.0
// Simulates the device (encoders, delay, amplifier, end stops, watchdog) and the hand that holds it.
#include "drivers/sim/sim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "hal/moving_mass.h"

namespace relievo {
namespace {

constexpr Duration kLongestAdvance = std::chrono::milliseconds(20);
constexpr Duration kWatchdog = std::chrono::milliseconds(20);
constexpr double kMargin = 0.8;  // of the bounds

std::size_t delayOf(const DeviceProfile& profile) RELIEVO_RT {
  return static_cast<std::size_t>(std::clamp(profile.delay_ticks, 0, DeviceProfile::kMaxDelayTicks));
}
double jitterOf(const DeviceProfile& profile) RELIEVO_RT {
  return std::clamp(profile.jitter_ticks, 0.0, 1.0);
}

class SimHaptic final : public HapticDevice {
 public:
  SimHaptic(const DeviceProfile& profile, HandPath path, const Clock& clock)
      : profile_(profile), path_(std::move(path)), clock_(clock) {}

  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    DeviceProfile now = profile_;
    now.rate_hz = rate();
    const double bound = std::min(now.viscousBound(), now.frictionBound());
    return {.name = profile_.name,
            .workspace_min_mm = profile_.workspace_min_mm,
            .workspace_max_mm = profile_.workspace_max_mm,
            .peak_force_n = profile_.peak_force_n,
            .continuous_force_n = profile_.continuous_force_n,
            .max_stiffness_n_per_mm = std::min(kMargin * bound, profile_.most_stiffness_n_per_mm),
            .rate_hz = now.rate_hz};
  }

 private:
  Result<void> openDevice() override {
    const bool mass = profile_.moving_mass_kg > 0 && profile_.hand.mass_kg >= 0;
    if (!mass || !(profile_.rate_hz > 0) || profile_.substeps_per_tick < 1) {
      return fail(ErrorCode::InvalidArgument, "a simulated device needs a mass, a rate and at least one step per tick");
    }
    time_s_ = 0;
    random_ = profile_.jitter_seed;
    target_ = path_.at(0);
    mass_ = MovingMass{.mass_kg = profile_.moving_mass_kg + profile_.hand.mass_kg,
                       .damping_n_s_per_mm = profile_.damping_n_s_per_mm + profile_.hand.damping_n_s_per_mm,
                       .coulomb_friction_n = profile_.coulomb_friction_n,
                       .position_mm = target_.position_mm};
    release();
    return {};
  }

  Result<void> homeDevice() override { return {}; }

  Result<void> startDevice() override {
    begun_ = false;
    return {};
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const MonotonicTime now = clock_.now();
    if (!std::exchange(begun_, true)) now_ = last_write_ = now;
    const Duration elapsed = std::clamp(now - now_, Duration(0), kLongestAdvance);
    now_ = now;
    if (elapsed > Duration(0)) advance(toSeconds(elapsed));
    if (now - last_write_ > kWatchdog) release();
    return HapticSample{.position_mm = encode(mass_.position_mm)};
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    std::move_backward(pipeline_.begin(), pipeline_.end() - 1, pipeline_.end());
    pipeline_.front() = force_n;
    last_write_ = now_;
    return {};
  }

  void stopDevice() noexcept override { release(); }
  void closeDevice() noexcept override { release(); }

  [[nodiscard]] double rate() const RELIEVO_RT { return rateWithin(profile_.rate_hz, profile_.most_rate_hz); }

  void release() RELIEVO_RT { pipeline_.fill(glm::dvec3(0)); }

  // 0 to 1; splitmix64 (Steele, Lea and Flood 2014).
  double nextRandom() RELIEVO_RT {
    std::uint64_t z = random_ += 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }

  // Interpolates the hand's target linearly over the tick, so that the path is evaluated once per tick, not per step.
  void advance(double elapsed_s) RELIEVO_RT {
    const auto steps = static_cast<int>(std::ceil(elapsed_s * rate() * profile_.substeps_per_tick - 1e-6));
    const double dt_s = elapsed_s / steps;
    time_s_ += elapsed_s;
    const HandPoint goal = path_.at(time_s_);
    const glm::dvec3 target_step = (goal.position_mm - target_.position_mm) / static_cast<double>(steps);
    const glm::dvec3 target_velocity = target_step / dt_s;
    const glm::dvec3 limit(goal.force_limit_n);
    const HandProfile& hand = profile_.hand;
    const glm::dvec3 pull_n = hand.damping_n_s_per_mm * target_velocity;
    // Until the due force arrives, the previous one acts.
    const double late_s = jitterOf(profile_) * nextRandom() / rate();
    const auto late_steps = static_cast<int>(std::lround(late_s / dt_s));
    const std::size_t due = delayOf(profile_);
    glm::dvec3 target = target_.position_mm;
    for (int i = 0; i < steps; ++i) {
      const glm::dvec3 spring_n = hand.stiffness_n_per_mm * (target - mass_.position_mm);
      const glm::dvec3& motors_n = pipeline_[i < late_steps ? due + 1 : due];
      mass_.step(motors_n + pull_n + glm::clamp(spring_n, -limit, limit), dt_s);
      stopAtEnds();
      target += target_step;
    }
    target_ = goal;
  }

  void stopAtEnds() RELIEVO_RT {
    const glm::dvec3 inside = glm::clamp(mass_.position_mm, profile_.workspace_min_mm, profile_.workspace_max_mm);
    for (int axis = 0; axis < 3; ++axis) {
      if (inside[axis] != mass_.position_mm[axis]) mass_.velocity_mm_per_s[axis] = 0;
    }
    mass_.position_mm = inside;
  }

  [[nodiscard]] glm::dvec3 encode(const glm::dvec3& position_mm) const RELIEVO_RT {
    const double step = profile_.encoder_step_mm;
    if (!(step > 0)) return position_mm;
    return glm::round(position_mm / step) * step;
  }

  DeviceProfile profile_;
  HandPath path_;
  const Clock& clock_;
  bool begun_ = false;  // it begins with the first reading: a tick does not simulate what was before
  MonotonicTime now_;   // the simulation's time
  MonotonicTime last_write_;
  double time_s_ = 0;  // on the hand's path
  std::uint64_t random_ = 0;
  HandPoint target_;
  MovingMass mass_;
  std::array<glm::dvec3, DeviceProfile::kMaxDelayTicks + 2> pipeline_{};  // [0] is the newest force
};

}  // namespace

std::unique_ptr<HapticDevice> makeSimHaptic(const DeviceProfile& profile, HandPath path, const Clock& clock) {
  return std::make_unique<SimHaptic>(profile, std::move(path), clock);
}

}  // namespace relievo
