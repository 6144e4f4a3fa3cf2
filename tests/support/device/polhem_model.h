// SPDX-License-Identifier: Apache-2.0
// A WoodenHaptics board and its arm in software: counters, commands, watchdog, motors. The arm is put together from
// turned bodies and its forces come from differences, so that it shares no formula with the driver.
#pragma once

#include <deque>
#include <glm/vec3.hpp>
#include <vector>

#include "drivers/polhem/description.h"
#include "drivers/polhem/report.h"
#include "tests/support/device/haptic_model.h"

namespace relievo::test {

struct PolhemFaults {
  std::size_t report_bytes = polhem::kReportBytes;  // what it sends; with kReportBytes it also takes no other length
  bool deaf_to_calibrate = false;                   // a board that does not know the command
  Duration calibrates_in{0};                        // a board that takes its time
};

class PolhemModel final : public HapticModel {
 public:
  explicit PolhemModel(const polhem::Description& description = polhem::kWoodenHaptics2019, PolhemFaults faults = {});

  void control(std::uint8_t request, std::uint16_t value, MonotonicTime now) override;
  void write(UsbBytes bytes, MonotonicTime now) override;
  std::optional<UsbPacket> read(MonotonicTime now) override;

  // The default grip holds the arm where it is calibrated until that is done and a moment longer, then in the middle of
  // the workspace.
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

  // The same for any arm; angles in rad, places in mm in the driver's frame.
  [[nodiscard]] static glm::dvec3 placeOf(const glm::dvec3& angles, const polhem::Description& arm);
  [[nodiscard]] static glm::dvec3 anglesAt(const glm::dvec3& place_mm, const polhem::Description& arm);
  [[nodiscard]] static glm::dvec3 anglesOf(const EncoderCounts& counts, const polhem::Description& arm);
  [[nodiscard]] static EncoderCounts countsAt(const glm::dvec3& place_mm, const polhem::Description& arm);
  // On a hand there, N, by virtual work over differences of a micrometre.
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
  int calibrated_at_ = 0;  // its place among the commands
  EncoderCounts zero_{};   // what is added to the true counts
  EncoderCounts next_zero_{};
  std::optional<MonotonicTime> zero_from_;  // the next one
  polhem::Command command_;
  MonotonicTime commanded_;
  std::vector<polhem::Milliamps> history_;
};

}  // namespace relievo::test
