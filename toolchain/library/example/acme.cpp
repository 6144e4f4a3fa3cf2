// SPDX-License-Identifier: Apache-2.0
// Acme's arm behind the interface of relievo's HAL.
#include "acme.h"

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>

namespace acme {
namespace {

using relievo::Duration;
using relievo::Result;
using Axes = std::array<std::int16_t, 3>;

constexpr double kCountsPerMm = 50, kMilliampsPerN = 250;
constexpr double kRateHz = 1000, kMostHz = 2000;
constexpr double kStiffnessNPerMm = 1.2;  // that was stable at kRateHz
constexpr Duration kWatchdog = std::chrono::milliseconds(20);
const glm::dvec3 kCradleMm{0, -50, 30};  // where the finger is while the arm rests

// From the arm's axes to those of the HAL: right, up, toward the viewer. And back.
glm::dvec3 toHal(const glm::dvec3& arm) RELIEVO_RT {
  return {-arm.x, arm.z, arm.y};
}
glm::dvec3 toArm(const glm::dvec3& hal) RELIEVO_RT {
  return {-hal.x, hal.z, hal.y};
}

class Arm final : public relievo::HapticDevice {
 public:
  Arm(std::unique_ptr<Wire> wire, const relievo::Clock& clock) : wire_(std::move(wire)), clock_(clock) {}
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
    last_force_.reset();
    return {};
  }

  Result<relievo::HapticSample> readSample() RELIEVO_RT override {
    const auto counts = wire_->counts();
    if (!counts) return std::unexpected(counts.error());
    if (last_force_ && clock_.now() - *last_force_ > kWatchdog) {  // the task hangs
      if (auto stopped = push(glm::dvec3(0)); !stopped) return std::unexpected(stopped.error());
      last_force_.reset();
    }
    glm::dvec3 moved;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      moved[axis] = ((*counts)[i] - zero_[i]) / kCountsPerMm;
    }
    return relievo::HapticSample{.position_mm = kCradleMm + toHal(moved), .buttons = 0};
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    last_force_ = clock_.now();
    return push(force_n);
  }

  Result<void> push(const glm::dvec3& force_n) RELIEVO_RT {
    const glm::dvec3 force = toArm(force_n) * kMilliampsPerN;
    Axes milliamps{};
    for (int axis = 0; axis < 3; ++axis) {
      milliamps[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>(std::lround(force[axis]));
    }
    return wire_->drive(milliamps);
  }

  void stopDevice() noexcept override { static_cast<void>(push(glm::dvec3(0))); }
  void closeDevice() noexcept override { wire_->close(); }

  const std::unique_ptr<Wire> wire_;
  const relievo::Clock& clock_;
  Axes zero_{};
  std::optional<relievo::MonotonicTime> last_force_;
};

}  // namespace

std::unique_ptr<relievo::HapticDevice> makeArm(std::unique_ptr<Wire> wire, const relievo::Clock& clock) {
  return std::make_unique<Arm>(std::move(wire), clock);
}

}  // namespace acme
