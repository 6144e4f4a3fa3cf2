// SPDX-License-Identifier: Apache-2.0
// Haptic device: one exchange per tick in each direction, and zero force unless one is requested.
#include <optional>

#include "drivers/sample/sample.h"

namespace relievo {
namespace {

constexpr double kRateHz = 1000, kMostHz = 1000;  // its own best; the most that --rate can have
constexpr double kStiffnessNPerMm = 1;            // the highest that was stable at kRateHz
constexpr Duration kWatchdog = std::chrono::milliseconds(20);

class SampleHaptic final : public HapticDevice {
 public:
  SampleHaptic(std::unique_ptr<SamplePort> port, const Clock& clock) : port_(std::move(port)), clock_(clock) {}
  ~SampleHaptic() override { close(); }  // the base class's `close` stops the motors first

  // Measured figures of the motors, not those of a data sheet: the player never requests more than the peak.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    const double rate_hz = rateWithin(kRateHz, kMostHz);
    return {.name = "sample",
            .workspace_min_mm = {-80, -60, -40},
            .workspace_max_mm = {80, 60, 40},
            .peak_force_n = 8,
            .continuous_force_n = 3,
            .max_stiffness_n_per_mm = stiffnessAtRate(kStiffnessNPerMm, kRateHz, rate_hz),
            .rate_hz = rate_hz};
  }

 private:
  Result<void> openDevice() override { return port_->open(); }

  // If the user must move the device to find its zero, wait for that here, and return Cancelled within 100 ms once
  // `cancelled()` is set.
  Result<void> homeDevice() override { return {}; }

  Result<void> startDevice() override {
    last_force_.reset();
    return {};
  }

  // On the real-time thread, like `writeForce`: no allocation, no lock, no log, and never longer than a tick.
  Result<HapticSample> readSample() RELIEVO_RT override {
    const auto position_mm = port_->readPosition();
    if (!position_mm) return std::unexpected(position_mm.error());
    // Without a force for that long, the task hangs. One that hangs between two ticks does not come here: where there
    // are motors, a thread (drivers/force/watchdog.h) or the device itself watches.
    if (last_force_ && clock_.now() - *last_force_ > kWatchdog) {
      if (auto stopped = push(glm::dvec3(0)); !stopped) return std::unexpected(stopped.error());
      last_force_.reset();
    }
    return HapticSample{.position_mm = *position_mm, .buttons = 0};
  }

  // The base class has replaced a force that is not finite or over the peak by zero.
  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    last_force_ = clock_.now();
    return push(force_n);
  }

  // Convert to the device's axes, units and signs here, and nowhere else.
  Result<void> push(const glm::dvec3& force_n) RELIEVO_RT { return port_->writeForce(force_n); }

  void stopDevice() noexcept override { static_cast<void>(push(glm::dvec3(0))); }
  void closeDevice() noexcept override { port_->close(); }

  const std::unique_ptr<SamplePort> port_;
  const Clock& clock_;
  std::optional<MonotonicTime> last_force_;
};

}  // namespace

std::unique_ptr<HapticDevice> makeSampleHaptic(std::unique_ptr<SamplePort> port, const Clock& clock) {
  return std::make_unique<SampleHaptic>(std::move(port), clock);
}

}  // namespace relievo
