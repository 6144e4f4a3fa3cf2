// SPDX-License-Identifier: Apache-2.0
// The model's board and arm.
#include "tests/support/device/polhem_model.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace relievo::test {
namespace {

using namespace std::chrono_literals;
using polhem::Description;

const glm::dvec3 kTurnsA{0, 0, 1}, kTurnsB{0, 1, 0};  // axes in the maker's frame

glm::dvec3 turned(double angle, const glm::dvec3& axis, const glm::dvec3& v) {
  return glm::angleAxis(angle, axis) * v;
}
glm::dvec3 originOf(const Description& arm) {
  return {arm.workspace_origin[0], arm.workspace_origin[1], arm.workspace_origin[2]};
}
// Turns of the motor per turn of the body.
double gearOf(const Description& arm, std::size_t i) {
  const double turns = arm.diameter_body[i] / arm.diameter_capstan[i];
  return arm.motor_and_body_aligned[i] ? -turns : turns;
}
std::int16_t wrapped(long count) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(count));
}

}  // namespace

PolhemModel::PolhemModel(const Description& description, PolhemFaults faults)
    : arm_(description), faults_(std::move(faults)) {
  constexpr double kHeldOnS = 0.05;
  constexpr int kHeldOn = 15;  // commands: a delayed driver still finds the arm there
  grip = [this](double t_s) {
    const bool left = calibrated_ && t_s > calibrated_s_ + kHeldOnS && commands_ > calibrated_at_ + kHeldOn;
    return left ? glm::dvec3(0) : placeOf(anglesOf(arm_.calibrate_enc, arm_), arm_);
  };
  powerOn();
}

glm::dvec3 PolhemModel::placeOf(const glm::dvec3& angles, const Description& arm) {
  const glm::dvec3 shoulder{0, 0, arm.length_body[0]};
  const glm::dvec3 upper = turned(angles.y, kTurnsB, {0, 0, arm.length_body[1]});
  const glm::dvec3 lower = turned(-angles.z, kTurnsB, {0, 0, -arm.length_body[2]});
  const glm::dvec3 place = turned(angles.x, kTurnsA, shoulder + upper + lower) - originOf(arm);
  return 1e3 * glm::dvec3(place.y, place.z, place.x);
}

// Intersects the circles of the two links around shoulder and tip; takes the upper intersection.
glm::dvec3 PolhemModel::anglesAt(const glm::dvec3& place_mm, const Description& arm) {
  const glm::dvec3 tip = 1e-3 * glm::dvec3(place_mm.z, place_mm.x, place_mm.y) + originOf(arm);
  const double r = std::hypot(tip.x, tip.y), z = tip.z - arm.length_body[0];
  const double upper = arm.length_body[1], lower = arm.length_body[2], apart = std::hypot(r, z);
  const double along = (apart * apart + upper * upper - lower * lower) / (2 * apart);
  const double aside = std::sqrt(upper * upper - along * along);
  const double elbow_r = (along * r - aside * z) / apart, elbow_z = (along * z + aside * r) / apart;
  return {std::atan2(tip.y, tip.x), std::atan2(elbow_r, elbow_z), std::atan2(r - elbow_r, elbow_z - z)};
}

glm::dvec3 PolhemModel::anglesOf(const EncoderCounts& counts, const Description& arm) {
  glm::dvec3 angles{0};
  for (std::size_t i = 0; i < 3; ++i) {
    angles[static_cast<int>(i)] = 2 * std::numbers::pi * counts[i] / arm.cpr_encoder[i] / gearOf(arm, i);
  }
  return angles;
}

EncoderCounts PolhemModel::countsAt(const glm::dvec3& place_mm, const Description& arm) {
  const glm::dvec3 angles = anglesAt(place_mm, arm);
  EncoderCounts counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double turns = angles[static_cast<int>(i)] / (2 * std::numbers::pi) * gearOf(arm, i);
    counts[i] = wrapped(std::lround(turns * arm.cpr_encoder[i]));
  }
  return counts;
}

glm::dvec3 PolhemModel::forceOf(const glm::dvec3& milliamps, const glm::dvec3& place_mm, const Description& arm) {
  glm::dvec3 torque_nmm{0};
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    torque_nmm[axis] = milliamps[axis] * arm.torque_constant[i] * gearOf(arm, i);
  }
  return forceOfTorques(torque_nmm, place_mm, [&arm](const glm::dvec3& place) { return anglesAt(place, arm); });
}

void PolhemModel::powerOn() {
  to_host_.clear();
  silent_ = calibrated_ = false;
  command_ = {};
  began_.reset();
  zero_from_.reset();
  const EncoderCounts there = countsAt(grip(0), arm_);
  for (std::size_t i = 0; i < 3; ++i) zero_[i] = wrapped(-there[i]);
  report(MonotonicTime{});
}

void PolhemModel::control(std::uint8_t /*request*/, std::uint16_t /*value*/, MonotonicTime /*now*/) {}

glm::dvec3 PolhemModel::forceAt(const glm::dvec3& place_mm, MonotonicTime now) const {
  const polhem::Milliamps now_ma = milliamps(now);
  return forceOf({now_ma[0], now_ma[1], now_ma[2]}, place_mm, arm_);
}

polhem::Milliamps PolhemModel::milliamps(MonotonicTime now) const {
  return command_.verb == polhem::Verb::Drive && now - commanded_ < 500ms ? command_.motors : polhem::Milliamps{};
}

// Answers every packet; obeys only commands.
void PolhemModel::write(UsbBytes bytes, MonotonicTime now) {
  if (!began_) began_ = now;
  const bool strict = faults_.report_bytes == polhem::kReportBytes;
  const auto command = polhem::decodeCommand(bytes, strict ? faults_.report_bytes : bytes.size());
  if (command) {
    ++commands_;
    command_ = *command;
    commanded_ = now;
    pushing_ += pushes(now) ? 1 : 0;
    if (command->verb == polhem::Verb::Drive) history_.push_back(command->motors);
    if (command->verb == polhem::Verb::Calibrate) {
      const EncoderCounts there = countsAt(gripNow(now), arm_);
      for (std::size_t i = 0; i < 3; ++i) next_zero_[i] = wrapped(command->counts[i] - there[i]);
      if (!faults_.deaf_to_calibrate) zero_from_ = now + faults_.calibrates_in;
      calibrated_ = true;
      calibrated_s_ = toSeconds(now - *began_);
      calibrated_at_ = commands_;
    }
  }
  if (!silent_) report(now + kAnswersIn);
}

void PolhemModel::report(MonotonicTime when) {
  const EncoderCounts there = countsAt(gripNow(when), arm_);
  if (zero_from_ && when >= *zero_from_) zero_ = next_zero_;
  polhem::Report report;
  for (std::size_t i = 0; i < 3; ++i) report.arm[i] = wrapped(there[i] + zero_[i]);
  report.grip[0] = button ? 10000 : 0;
  const polhem::PaddedReport padded = polhem::encode(report);
  std::vector<std::uint8_t> bytes(padded.begin(), padded.begin() + static_cast<std::ptrdiff_t>(faults_.report_bytes));
  if (spoil) spoil(bytes);
  to_host_.push_back({std::move(bytes), when});
}

std::optional<UsbPacket> PolhemModel::read(MonotonicTime now) {
  if (to_host_.empty() || to_host_.front().when > now) return std::nullopt;
  const std::vector<std::uint8_t>& bytes = to_host_.front().bytes;
  UsbPacket packet;
  packet.bytes = std::min(bytes.size(), packet.data.size());
  std::copy_n(bytes.begin(), packet.bytes, packet.data.begin());
  to_host_.pop_front();
  return packet;
}

}  // namespace relievo::test
