// SPDX-License-Identifier: Apache-2.0
// Returns one recorded tick for each `read`. At another rate than the recorded one, it interpolates the finger's
// position between two ticks.
#include "drivers/replay/replay.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace relievo {
namespace {

class Replay final : public HapticDevice {
 public:
  explicit Replay(Recording recording) : recording_(std::move(recording)) {}

  // Without motors the recorded stiffness is stable at every rate, and the forces stay the recorded ones.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    HapticCapabilities now = recording_.capabilities;
    now.rate_hz = rateWithin(std::clamp(now.rate_hz, kLeastRateHz, kMostRateHz), kMostRateHz);
    return now;
  }

 private:
  Result<void> openDevice() override {
    if (recording_.ticks.empty())
      return fail(ErrorCode::InvalidArgument, "the recording has no ticks; record a longer session");
    next_ = 0;
    recorded_per_read_ = recording_.capabilities.rate_hz / capabilities().rate_hz;
    return {};
  }
  Result<void> homeDevice() override { return {}; }
  Result<void> startDevice() override { return {}; }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const double last = static_cast<double>(recording_.ticks.size() - 1);
    const double place = std::min(recorded_per_read_ * static_cast<double>(next_), last);
    if (place < last) ++next_;
    const auto index = static_cast<std::size_t>(place);
    const RecordedTick& tick = recording_.ticks[index];
    if (!tick.answered) return fail(ErrorCode::Io, "the recorded device did not answer at this tick");
    HapticSample sample{.position_mm = tick.position_mm, .buttons = tick.buttons};
    const double beyond = place - static_cast<double>(index);
    // A tick without an answer has no position to go to.
    if (beyond > 0 && recording_.ticks[index + 1].answered) {
      sample.position_mm += beyond * (recording_.ticks[index + 1].position_mm - tick.position_mm);
    }
    return sample;
  }
  Result<void> writeForce(const glm::dvec3& /*force_n*/) RELIEVO_RT override { return {}; }
  void stopDevice() noexcept override {}
  void closeDevice() noexcept override {}

  Recording recording_;
  double recorded_per_read_ = 1;  // ticks
  std::uint64_t next_ = 0;        // read
};

}  // namespace

std::unique_ptr<HapticDevice> makeReplay(Recording recording) {
  return std::make_unique<Replay>(std::move(recording));
}

}  // namespace relievo
