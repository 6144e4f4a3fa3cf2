// SPDX-License-Identifier: Apache-2.0
// The model's USB bridge, boot loader, firmware and geometry.
#include "tests/support/device/falcon_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "drivers/falcon/motors.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kBootDivisor = 0x4138, kLoadDivisor = 0x0015, kRunDivisor = 0x0002;

// One leg's thigh angle: the distance from the knee to the platform's joint must be the shin's length.
double angleOf(double phi_deg, const glm::dvec3& p) {
  const double phi = phi_deg * std::numbers::pi / 180;
  const double u = std::cos(phi) * p.x + std::sin(phi) * p.y - 40.0 + 14.43;
  const double v = -std::sin(phi) * p.x + std::cos(phi) * p.y + 23.09 - 25.0;
  const double wanted = 22.5 + std::sqrt(102.5 * 102.5 - v * v);
  const double toward = std::atan2(p.z, u);
  double low = toward - std::numbers::pi, high = toward;  // farthest, nearest
  for (int i = 0; i < 60; ++i) {                          // to the last bit
    const double middle = 0.5 * (low + high);
    const double distance = std::hypot(u - 60.0 * std::cos(middle), p.z - 60.0 * std::sin(middle));
    (distance > wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

int countOf(double theta_rad) {
  const double degrees = theta_rad * 180 / std::numbers::pi;
  return static_cast<int>(std::lround((degrees - 35.0) * 0.110 * 1280 / (360 * 0.01425)));
}

}  // namespace

FalconModel::FalconModel(std::vector<std::uint8_t> image, FalconFaults faults)
    : image_(std::move(image)), faults_(std::move(faults)) {
  grip = [this](double t_s) {
    return homed() ? kRestMm : kRestMm + glm::dvec3(0, 0, 45 * std::sin(2 * std::numbers::pi * t_s));
  };
}

glm::dvec3 FalconModel::anglesAt(const glm::dvec3& position_mm) {
  return {angleOf(105, position_mm), angleOf(-15, position_mm), angleOf(-135, position_mm)};
}

glm::dvec3 FalconModel::forceOfTorques(const glm::dvec3& torques_nmm, const glm::dvec3& position_mm) {
  return test::forceOfTorques(torques_nmm, position_mm, anglesAt);
}

glm::dvec3 FalconModel::forceOf(const falcon::Words& words, const glm::dvec3& position_mm, double counts_per_nm) {
  return forceOfTorques(-1e3 / counts_per_nm * glm::dvec3(words[0], words[1], words[2]), position_mm);
}

void FalconModel::powerOn() {
  boot_ = Boot::Waiting;
  running_ = false;
  homed_ = 0;
  to_host_.clear();
  heard_.clear();
  taken_.clear();
  stream_.clear();
  before_ = {};
  began_.reset();
  command_ = {};
}

void FalconModel::control(std::uint8_t request, std::uint16_t value, MonotonicTime /*now*/) {
  if (request == 0 && value == 1) to_host_.clear();
  if (request == 9) latency_ms_ = value & 0xFF;
  if (request == 1 && value == 0x0101 && divisor_ == kBootDivisor && !running_) {  // DTR raised: the boot loader begins
    boot_ = Boot::Waiting;
    heard_.clear();
    taken_.clear();
  }
  if (request != 3) return;
  divisor_ = value;
  if (value != kRunDivisor || boot_ != Boot::Taking || taken_.size() < image_.size()) return;
  ++loads_;
  running_ = taken_ == image_ && loads_ > faults_.silent_loads + faults_.wrong_echo_loads + faults_.dead_loads;
  boot_ = Boot::Waiting;
}

void FalconModel::write(UsbBytes bytes, MonotonicTime now) {
  if (running_ && divisor_ == kRunDivisor) {
    stream_.add(bytes);
    while (const auto packet = stream_.next()) {
      if (const auto command = falcon::decodeCommand(*packet)) obey(*command, now);
    }
    return;
  }
  for (const std::uint8_t byte : bytes) bootByte(byte, now);
}

void FalconModel::bootByte(std::uint8_t byte, MonotonicTime now) {
  static const std::vector<std::uint8_t> kHello{0x0A, 0x43, 0x0D};
  if (boot_ == Boot::Waiting && divisor_ == kBootDivisor) {
    heard_.push_back(byte);
    if (heard_.size() < 3 || !std::equal(kHello.begin(), kHello.end(), heard_.end() - 3)) return;
    if (loads_ < faults_.silent_loads) {
      // Twenty greetings are one try.
      if (heard_.size() >= 60) ++loads_, heard_.clear();
      return;
    }
    if (faults_.leading_zero) say({0}, now);
    say({0x0A, 0x44, 0x2C, 0x0D}, now + 5ms);
    boot_ = Boot::Greeted;
  } else if (boot_ == Boot::Greeted && divisor_ == kLoadDivisor && byte == 0x41) {
    boot_ = Boot::Taking;
    say({0x41}, now + 1ms);
  } else if (boot_ == Boot::Taking) {
    taken_.push_back(byte);
    const bool wrong = taken_.size() == image_.size() / 2 && loads_ < faults_.silent_loads + faults_.wrong_echo_loads;
    if (wrong) ++loads_;
    say({static_cast<std::uint8_t>(wrong ? byte ^ 0xFFU : byte)}, now + 1ms);
  }
}

glm::dvec3 FalconModel::forceAt(const glm::dvec3& place_mm, MonotonicTime /*now*/) const {
  return forceOf(command_.motors, place_mm, falcon::kDefaultCountsPerNm);
}

bool FalconModel::pushes(MonotonicTime /*now*/) const {
  return command_.motors != falcon::Words{};
}

// Counts mean nothing until each leg has passed its index with homing on; there they become zero.
void FalconModel::obey(const falcon::Command& command, MonotonicTime now) {
  ++commands_;
  command_ = command;
  pushing_ += pushes(now) ? 1 : 0;
  history_.push_back(command.motors);
  if (!began_) began_ = now;
  const glm::dvec3 theta = anglesAt(gripNow(now));
  falcon::Reply reply;
  for (std::size_t leg = 0; leg < 3; ++leg) {
    const int count = countOf(theta[static_cast<int>(leg)]);
    if (!before_[leg]) {
      start_counts_[leg] = static_cast<std::int16_t>(count + 777 + static_cast<int>(100 * leg));
    } else if (command.homing && (*before_[leg] < 0) != (count < 0)) {
      homed_ |= 1U << leg;
    }
    before_[leg] = count;
    const bool known = (homed_ >> leg & 1U) != 0;
    reply.encoders[leg] = static_cast<std::int16_t>(known ? count : count - start_counts_[leg]);
  }
  reply.homed = static_cast<std::uint8_t>(homed_);
  const falcon::Packet packet = falcon::encode(reply);
  std::vector<std::uint8_t> bytes(packet.begin(), packet.end());
  if (spoil) spoil(bytes);
  constexpr Duration kWire = 2 * 107us;  // 16 bytes there and 16 back at 1.5 MBd
  say(std::move(bytes), now + kWire);
}

void FalconModel::say(std::vector<std::uint8_t> bytes, MonotonicTime when) {
  for (const std::uint8_t byte : bytes) to_host_.push_back({byte, when});
}

// The bridge sends its data when its latency timer expires, or only its two status bytes if it has none.
std::optional<UsbPacket> FalconModel::read(MonotonicTime now) {
  const Duration latency = std::chrono::milliseconds(latency_ms_);
  UsbPacket packet;
  packet.data[0] = 0x01;
  packet.data[1] = 0x60;
  packet.bytes = 2;
  if (faults_.broken_line) {
    if (now - last_read_ < 1ms) return std::nullopt;
    last_read_ = now;
    packet.data[1] = 0x62;  // overrun
    packet.bytes = 3;
    return packet;
  }
  const std::size_t most = std::min(packet.data.size(), 2 + faults_.most_payload);
  while (!to_host_.empty() && to_host_.front().when <= now && packet.bytes < most) {
    packet.data[packet.bytes++] = to_host_.front().byte;
    to_host_.pop_front();
  }
  if (packet.bytes == 2 && now - last_read_ < latency) return std::nullopt;
  last_read_ = now;
  return packet;
}

}  // namespace relievo::test
