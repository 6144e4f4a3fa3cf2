// SPDX-License-Identifier: Apache-2.0
// Returns one recorded tick for each `read`.
#include "drivers/replay/replay.h"

#include <utility>

namespace relievo {
namespace {

class Replay final : public HapticDevice {
 public:
  explicit Replay(Recording recording) : recording_(std::move(recording)) {}

  [[nodiscard]] HapticCapabilities capabilities() const noexcept override { return recording_.capabilities; }

 private:
  Result<void> openDevice() override {
    if (recording_.ticks.empty())
      return fail(ErrorCode::InvalidArgument, "the recording has no ticks; record a longer session");
    next_ = 0;
    return {};
  }
  Result<void> homeDevice() override { return {}; }
  Result<void> startDevice() override { return {}; }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const RecordedTick& tick = recording_.ticks[next_];
    if (next_ + 1 < recording_.ticks.size()) ++next_;
    if (!tick.answered) return fail(ErrorCode::Io, "the recorded device did not answer at this tick");
    return HapticSample{.position_mm = tick.position_mm, .buttons = tick.buttons};
  }
  Result<void> writeForce(const glm::dvec3& /*force_n*/) RELIEVO_RT override { return {}; }
  void stopDevice() noexcept override {}
  void closeDevice() noexcept override {}

  Recording recording_;
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<HapticDevice> makeReplay(Recording recording) {
  return std::make_unique<Replay>(std::move(recording));
}

}  // namespace relievo
