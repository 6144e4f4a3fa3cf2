// SPDX-License-Identifier: Apache-2.0
// A simulated WoodenHaptics board and its arm: counters, commands, watchdog, motors. The arm is composed of rotated
// bodies and its forces come from differences, so that it shares no formula with the driver.
#pragma once

#include <deque>
#include <glm/vec3.hpp>
#include <vector>

#include "drivers/polhem/description.h"
#include "drivers/polhem/report.h"
#include "tests/support/device/haptic_model.h"

namespace relievo::test {

struct PolhemFaults {
  std::size_t report_bytes = polhem::kReportBytes;  // length of its reports; kReportBytes: rejects any other length
  bool deaf_to_calibrate = false;                   // a board that does not know the command
  Duration calibrates_in{0};                        // delay of the calibration
};

class PolhemModel final : public HapticModel {
 public:
  explicit PolhemModel(const polhem::Description& description = polhem::kWoodenHaptics2019, PolhemFaults faults = {});

  void control(std::uint8_t request, std::uint16_t value, MonotonicTime now) override;
  void write(UsbBytes bytes, MonotonicTime now) override;
  std::optional<UsbPacket> read(MonotonicTime now) override;

  // The default grip holds the arm in its calibration pose until a moment after calibration, then in the middle of the
  // workspace.
  static constexpr Duration kAnswersIn = std::chrono::microseconds(300);
  bool button = false;

  void powerOn() override;  // the counters are zero wherever the arm is
  void silence() override { silent_ = true; }
  [[nodiscard]] bool homed() const override { return calibrated_; }
  [[nodiscard]] glm::dvec3 forceAt(const glm::dvec3& place_mm, MonotonicTime now) const override;
  [[nodiscard]] bool pushes(MonotonicTime now) const override { return milliamps(now) != polhem::Milliamps{}; }
  [[nodiscard]] const polhem::Command& last() const { return command_; }
  [[nodiscard]] polhem::Milliamps milliamps(MonotonicTime now) const;  // that flow: none after half a second
  [[nodiscard]] const std::vector<polhem::Milliamps>& history() const { return history_; }

  // The same for any arm; angles in rad, positions in mm in the driver's frame.
  [[nodiscard]] static glm::dvec3 placeOf(const glm::dvec3& angles, const polhem::Description& arm);
  [[nodiscard]] static glm::dvec3 anglesAt(const glm::dvec3& place_mm, const polhem::Description& arm);
  [[nodiscard]] static glm::dvec3 anglesOf(const EncoderCounts& counts, const polhem::Description& arm);
  [[nodiscard]] static EncoderCounts countsAt(const glm::dvec3& place_mm, const polhem::Description& arm);
  // The force on a hand at that position, N, by virtual work over differences of 1 um.
  [[nodiscard]] static glm::dvec3 forceOf(const glm::dvec3& milliamps, const glm::dvec3& place_mm,
                                          const polhem::Description& arm);

 private:
  void report(MonotonicTime now);

  polhem::Description arm_;
  PolhemFaults faults_;
  struct Spoken {
    std::vector<std::uint8_t> bytes;
    MonotonicTime when;
  };
  std::deque<Spoken> to_host_;
  bool silent_ = false;
  bool calibrated_ = false;
  double calibrated_s_ = 0;
  int calibrated_at_ = 0;  // index of that command
  EncoderCounts zero_{};   // offset added to the true counts
  EncoderCounts next_zero_{};
  std::optional<MonotonicTime> zero_from_;  // when next_zero_ takes effect
  polhem::Command command_;
  MonotonicTime commanded_;
  std::vector<polhem::Milliamps> history_;
};

}  // namespace relievo::test
