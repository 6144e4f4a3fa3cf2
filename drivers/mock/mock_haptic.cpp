// SPDX-License-Identifier: Apache-2.0
// A virtual haptic device that follows its profile's path whatever the force, and shows the force on its bench.
#include <algorithm>

#include "drivers/mock/mock.h"

namespace relievo {
namespace {

constexpr Duration kWatchdog = std::chrono::milliseconds(20);

class MockHaptic final : public HapticDevice {
 public:
  MockHaptic(MockHapticProfile profile, const Clock& clock, std::shared_ptr<MockHapticBench> bench)
      : profile_(std::move(profile)),
        clock_(clock),
        bench_(bench ? std::move(bench) : std::make_shared<MockHapticBench>()) {}
  ~MockHaptic() override { close(); }

  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    HapticCapabilities now = profile_.capabilities;
    now.rate_hz = rateWithin(now.rate_hz, profile_.most_rate_hz);
    now.max_stiffness_n_per_mm =
        stiffnessAtRate(now.max_stiffness_n_per_mm, profile_.capabilities.rate_hz, now.rate_hz);
    return now;
  }

 private:
  Result<void> openDevice() override {
    if (profile_.fail_open) return fail(*profile_.fail_open, "the mock device was told not to open");
    if (bench_->unplugged) return fail(ErrorCode::NotFound, "the mock device is unplugged");
    ticks_ = 0;
    return {};
  }

  Result<void> homeDevice() override {
    if (gone()) return fail(ErrorCode::Lost, "the mock device has gone away");
    if (homings_++ >= profile_.fail_homing_after) {
      return fail(ErrorCode::Timeout, "the mock device was told not to home");
    }
    return {};
  }

  Result<void> startDevice() override {
    if (gone()) return fail(ErrorCode::Lost, "the mock device has gone away");
    started_ = last_write_ = clock_.now();
    return {};
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    bench_->reads.fetch_add(1, std::memory_order_relaxed);
    const std::uint64_t tick = ticks_++;
    if (tick >= profile_.lose_after_ticks || bench_->unplugged) return lose();
    const MonotonicTime now = clock_.now();
    if (now - last_write_ > kWatchdog) apply(glm::dvec3(0));
    if (tick == profile_.glitch_after_ticks || bench_->glitch.exchange(false, std::memory_order_relaxed))
      return fail(ErrorCode::Io, "one exchange with the mock device failed");
    return HapticSample{.position_mm = positionAt(tick, now), .buttons = profile_.buttons};
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    bench_->writes.fetch_add(1, std::memory_order_relaxed);
    if (gone()) return std::unexpected(lose().error());
    if (profile_.refuses_force) return fail(ErrorCode::Io, "the mock device was told to refuse forces");
    last_write_ = clock_.now();
    apply(force_n);
    return {};
  }

  void stopDevice() noexcept override { apply(glm::dvec3(0)); }
  void closeDevice() noexcept override { apply(glm::dvec3(0)); }

  [[nodiscard]] glm::dvec3 positionAt(std::uint64_t tick, MonotonicTime now) const RELIEVO_RT {
    const auto& path = profile_.path_mm;
    if (!path.empty()) return path[std::min<std::size_t>(static_cast<std::size_t>(tick), path.size() - 1)];
    if (profile_.position_mm) return profile_.position_mm(toSeconds(now - started_));
    return 0.5 * (profile_.capabilities.workspace_min_mm + profile_.capabilities.workspace_max_mm);
  }

  [[nodiscard]] bool gone() const RELIEVO_RT { return ticks_ > profile_.lose_after_ticks || bench_->unplugged; }

  // A device without a cable has no force.
  Result<HapticSample> lose() RELIEVO_RT {
    apply(glm::dvec3(0));
    return fail(ErrorCode::Lost, "the mock device has gone away");
  }

  void apply(const glm::dvec3& force_n) RELIEVO_RT {
    bench_->force_x_n.store(force_n.x, std::memory_order_relaxed);
    bench_->force_y_n.store(force_n.y, std::memory_order_relaxed);
    bench_->force_z_n.store(force_n.z, std::memory_order_relaxed);
  }

  MockHapticProfile profile_;
  const Clock& clock_;
  std::shared_ptr<MockHapticBench> bench_;
  std::uint64_t homings_ = 0;
  std::uint64_t ticks_ = 0;
  MonotonicTime started_;
  MonotonicTime last_write_;
};

}  // namespace

std::unique_ptr<HapticDevice> makeMockHaptic(MockHapticProfile profile, const Clock& clock,
                                             std::shared_ptr<MockHapticBench> bench) {
  return std::make_unique<MockHaptic>(std::move(profile), clock, std::move(bench));
}

}  // namespace relievo
