// SPDX-License-Identifier: Apache-2.0
// A Falcon in software: serial bridge, boot loader, firmware, homing, encoders, motors. Its geometry is solved by
// bisection of the closure condition and its forces by differences, so that it shares no formula with the driver.
#pragma once

#include <deque>
#include <glm/vec3.hpp>
#include <vector>

#include "drivers/falcon/packet.h"
#include "tests/support/device/haptic_model.h"

namespace relievo::test {

// The ways in which users report that loading the firmware fails; each for that many tries.
struct FalconFaults {
  int silent_loads = 0;                                     // the greeting is never answered
  int wrong_echo_loads = 0;                                 // a byte of the image comes back changed
  int dead_loads = 0;                                       // the image is taken, but does not run
  bool broken_line = false;                                 // every packet reports lost bytes
  bool leading_zero = false;                                // the greeting's answer has a zero byte before it
  std::size_t most_payload = falcon::kPacketBytes * 4 - 2;  // of an IN packet: short reads
};

class FalconModel final : public HapticModel {
 public:
  explicit FalconModel(std::vector<std::uint8_t> image, FalconFaults faults = {});

  void control(std::uint8_t request, std::uint16_t value, MonotonicTime now) override;
  void write(UsbBytes bytes, MonotonicTime now) override;
  std::optional<UsbPacket> read(MonotonicTime now) override;

  // The default grip moves through the range once a second, as a user does to home it, and then rests here.
  static constexpr glm::dvec3 kRestMm{0, 0, 120};

  void powerOn() override;  // no firmware, no zero
  void silence() override { running_ = false; }
  [[nodiscard]] bool homed() const override { return homed_ == 7; }
  [[nodiscard]] glm::dvec3 forceAt(const glm::dvec3& place_mm, MonotonicTime now) const override;
  [[nodiscard]] bool pushes(MonotonicTime now) const override;
  void runFirmware() { running_ = true; }
  [[nodiscard]] bool running() const { return running_; }
  [[nodiscard]] int loads() const { return loads_; }
  [[nodiscard]] const falcon::Command& last() const { return command_; }
  [[nodiscard]] const std::vector<falcon::Words>& history() const { return history_; }

  // The thigh angles of a pose, rad, by bisection.
  [[nodiscard]] static glm::dvec3 anglesAt(const glm::dvec3& position_mm);
  // The force, N, of these leg torques, N mm, on a hand at that position, by virtual work over differences of 1 um.
  [[nodiscard]] static glm::dvec3 forceOfTorques(const glm::dvec3& torques_nmm, const glm::dvec3& position_mm);
  [[nodiscard]] static glm::dvec3 forceOf(const falcon::Words& words, const glm::dvec3& position_mm,
                                          double counts_per_nm);

 private:
  void bootByte(std::uint8_t byte, MonotonicTime now);
  void obey(const falcon::Command& command, MonotonicTime now);
  void say(std::vector<std::uint8_t> bytes, MonotonicTime when);

  std::vector<std::uint8_t> image_;
  FalconFaults faults_;
  // The bridge.
  std::uint16_t divisor_ = 0;
  int latency_ms_ = 16;
  struct Spoken {
    std::uint8_t byte;
    MonotonicTime when;
  };
  std::deque<Spoken> to_host_;
  MonotonicTime last_read_;
  // The boot loader.
  enum class Boot : std::uint8_t { Waiting, Greeted, Taking };
  Boot boot_ = Boot::Waiting;
  std::vector<std::uint8_t> heard_;
  std::vector<std::uint8_t> taken_;
  int loads_ = 0;
  bool running_ = false;
  // The firmware.
  falcon::PacketStream stream_;
  falcon::Command command_;
  std::vector<falcon::Words> history_;
  unsigned homed_ = 0;
  falcon::Counts start_counts_{};
  std::array<std::optional<int>, 3> before_;
};

}  // namespace relievo::test
