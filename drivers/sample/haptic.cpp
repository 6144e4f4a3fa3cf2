// SPDX-License-Identifier: Apache-2.0
// Haptic device: one exchange a tick in each direction, and no force that nobody asked for.
#include <optional>

#include "drivers/sample/sample.h"

namespace relievo {
namespace {

constexpr Duration kWatchdog = std::chrono::milliseconds(20);

class SampleHaptic final : public HapticDevice {
 public:
  SampleHaptic(std::unique_ptr<SamplePort> port, const Clock& clock) : port_(std::move(port)), clock_(clock) {}
  ~SampleHaptic() override { close(); }  // of the base class: stops the motors first

  // What the motors can do, measured, not printed: the player never asks for more than the peak.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    return {.name = "sample",
            .workspace_min_mm = {-80, -60, -40},
            .workspace_max_mm = {80, 60, 40},
            .peak_force_n = 8,
            .continuous_force_n = 3,
            .max_stiffness_n_per_mm = 1,
            .rate_hz = 1000};
  }

 private:
  Result<void> openDevice() override { return port_->open(); }

  // Where a device has to be moved by hand to find its zero this waits for it, and answers Cancelled within 100 ms
  // once `cancelled()` is set.
  Result<void> homeDevice() override { return {}; }

  Result<void> startDevice() override {
    last_force_.reset();
    return {};
  }

  // On the real-time thread, as `writeForce`: no allocation, no lock, no log, and never longer than a tick.
  Result<HapticSample> readSample() RELIEVO_RT override {
    const auto position_mm = port_->readPosition();
    if (!position_mm) return std::unexpected(position_mm.error());
    // No force has come for so long: the task hangs. Where it may hang in here as well, a thread of its own watches
    // (drivers/usb/watchdog.h), or the device itself does.
    if (last_force_ && clock_.now() - *last_force_ > kWatchdog) {
      if (auto stopped = push(glm::dvec3(0)); !stopped) return std::unexpected(stopped.error());
      last_force_.reset();
    }
    return HapticSample{.position_mm = *position_mm, .buttons = 0};
  }

  // The base class has refused what is not finite or over the peak, and sends zero in its place.
  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    last_force_ = clock_.now();
    return push(force_n);
  }

  // Into the motors: the device's axes, units and signs belong here, and nowhere else.
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
