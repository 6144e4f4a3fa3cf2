// SPDX-License-Identifier: Apache-2.0
// Acme's arm behind the interface of relievo's HAL.
#include "acme.h"

#include <atomic>
#include <cmath>
#include <glm/vec3.hpp>
#include <utility>

#include "platform/cyclic_thread.h"

namespace acme {
namespace {

using relievo::Duration;
using relievo::MonotonicTime;
using relievo::Result;
using Axes = std::array<std::int16_t, 3>;

constexpr double kCountsPerMm = 50, kMilliampsPerN = 250;
constexpr double kRateHz = 1000, kMostHz = 2000;
constexpr double kStiffnessNPerMm = 1.2;  // that was stable at kRateHz
constexpr Duration kWatchdog = std::chrono::milliseconds(20);
constexpr int kWatchPriority = 85;       // above the haptic task's
const glm::dvec3 kCradleMm{0, -50, 30};  // where the finger is while the arm rests

// From the arm's axes to those of the HAL: right, up, toward the viewer. And back.
glm::dvec3 toHal(const glm::dvec3& arm) RELIEVO_RT {
  return {-arm.x, arm.z, arm.y};
}
glm::dvec3 toArm(const glm::dvec3& hal) RELIEVO_RT {
  return {-hal.x, hal.z, hal.y};
}

// The task that reads and writes may hang, with the last force in the motors: a thread of the driver's own watches it.
class Arm final : public relievo::HapticDevice, private relievo::CyclicTask {
 public:
  Arm(std::unique_ptr<Wire> wire, const relievo::Clock& clock, bool watchdog_thread)
      : wire_(std::move(wire)), clock_(clock), watchdog_thread_(watchdog_thread), watchdog_(system_clock_) {}
  ~Arm() override { close(); }  // the base class's `close` stops the motors first

  [[nodiscard]] relievo::HapticCapabilities capabilities() const noexcept override {
    const double rate_hz = rateWithin(kRateHz, kMostHz);
    return {.name = "acme",
            .workspace_min_mm = {-100, -60, -60},
            .workspace_max_mm = {100, 60, 60},
            .peak_force_n = 6,
            .continuous_force_n = 2,
            .max_stiffness_n_per_mm = relievo::stiffnessAtRate(kStiffnessNPerMm, kRateHz, rate_hz),
            .rate_hz = rate_hz};
  }

 private:
  Result<void> openDevice() override { return wire_->open(); }

  // The arm rests in its cradle: here its encoders have their zero.
  Result<void> homeDevice() override {
    const auto counts = wire_->counts();
    if (!counts) return std::unexpected(counts.error());
    zero_ = *counts;
    return {};
  }

  Result<void> startDevice() override {
    last_force_ = kNone;
    if (!watchdog_thread_) return {};
    const auto started =
        watchdog_.start({.name = "acme-watch", .period = kWatchdog / 4, .priority = kWatchPriority}, *this);
    if (!started) return std::unexpected(started.error());
    return {};
  }

  Result<relievo::HapticSample> readSample() RELIEVO_RT override {
    const auto counts = wire_->counts();
    if (!counts) return std::unexpected(counts.error());
    if (!watchdog_thread_) watch(clock_.now());
    glm::dvec3 moved;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      moved[axis] = ((*counts)[i] - zero_[i]) / kCountsPerMm;
    }
    return relievo::HapticSample{.position_mm = kCradleMm + toHal(moved), .buttons = 0};
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    last_force_ = clock_.now().time_since_epoch().count();
    return push(force_n);
  }

  relievo::LoopControl loop(const relievo::Cycle& cycle) RELIEVO_RT override {
    watch(cycle.woken);
    return relievo::LoopControl::Continue;
  }
  void watch(MonotonicTime now) RELIEVO_RT {
    Duration::rep last = last_force_;
    if (last == kNone || now.time_since_epoch().count() - last <= kWatchdog.count()) return;
    if (!last_force_.compare_exchange_strong(last, kNone) || wire_->drive({})) return;
    Duration::rep none = kNone;
    last_force_.compare_exchange_strong(none, last);  // the arm did not take it: once more at the next look
  }

  Result<void> push(const glm::dvec3& force_n) RELIEVO_RT {
    const glm::dvec3 force = toArm(force_n) * kMilliampsPerN;
    Axes milliamps{};
    for (int axis = 0; axis < 3; ++axis) {
      milliamps[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>(std::lround(force[axis]));
    }
    return wire_->drive(milliamps);
  }

  void stopDevice() noexcept override {
    watchdog_.stop();
    static_cast<void>(push(glm::dvec3(0)));
  }
  void closeDevice() noexcept override {
    watchdog_.stop();  // it runs on if the arm was lost
    wire_->close();
  }

  const std::unique_ptr<Wire> wire_;
  const relievo::Clock& clock_;
  const bool watchdog_thread_;
  Axes zero_{};
  static constexpr Duration::rep kNone = -1;      // instead of a time: the motors are stopped
  std::atomic<Duration::rep> last_force_{kNone};  // on `clock_`
  relievo::MonotonicClock system_clock_;
  relievo::CyclicThread watchdog_;
};

}  // namespace

std::unique_ptr<relievo::HapticDevice> makeArm(std::unique_ptr<Wire> wire, const relievo::Clock& clock,
                                               bool watchdog_thread) {
  return std::make_unique<Arm>(std::move(wire), clock, watchdog_thread);
}

}  // namespace acme
