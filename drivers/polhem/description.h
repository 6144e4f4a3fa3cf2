// SPDX-License-Identifier: Apache-2.0
// What one device of the Polhem and WoodenHaptics family is like: its lengths, drives and limits, read from JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "drivers/usb/encoder_gate.h"
#include "platform/failure.h"

namespace relievo::polhem {

// The files are those of the maker's own library (`toJSON` there writes one), SI units, keys as here with the axes'
// letters: diameter_capstan_a and so on; keys that nothing here needs are left unread. Files for the public devices
// lie beside this one. The numbers are those of the library's header (BSD licence).
struct Description {
  int variant = 0;                           // of the kinematics; 0, 1 and 2 are the same
  std::array<double, 3> diameter_capstan{};  // m
  std::array<double, 3> diameter_body{};     // m
  std::array<double, 3> length_body{};       // m; a: height of the shoulder
  std::array<double, 3> workspace_origin{};  // m, in the maker's frame
  double workspace_radius = 0;               // m
  std::array<double, 3> torque_constant{};   // torque_constant_motor_a: N m / A
  double current_for_10_v_signal = 0;        // A, the most that the amplifiers are set up for
  std::array<double, 3> cpr_encoder{};       // counts a turn of the motor
  double max_linear_force = 0;               // N
  double max_linear_stiffness = 0;           // N/m
  EncoderCounts calibrate_enc{};             // in the pose in which the device is calibrated
  std::array<bool, 3> motor_and_body_aligned{};
  double max_milliamps = 2000;  // no key of the maker's: its library has this number for all devices
};

// The default: woodenhaptics-2019.json.
inline constexpr Description kWoodenHaptics2019{.variant = 0,
                                                .diameter_capstan = {0.010, 0.010, 0.010},
                                                .diameter_body = {0.160, 0.120, 0.120},
                                                .length_body = {0.080, 0.205, 0.245},
                                                .workspace_origin = {0.220, 0.000, 0.080},
                                                .workspace_radius = 0.100,
                                                .torque_constant = {0.321, 0.0603, 0.0603},
                                                .current_for_10_v_signal = 3.0,
                                                .cpr_encoder = {2000, 2000, 2000},
                                                .max_linear_force = 5.0,
                                                .max_linear_stiffness = 1000.0,
                                                .calibrate_enc = {0, 0, 6000},
                                                .motor_and_body_aligned = {false, false, false}};

// The failure names `name` and the key. Corrupt: no JSON. InvalidArgument: a key is missing or its value is not one
// that a device can have. Unsupported: variant 3 (Polhem v2 and v3), whose kinematics the maker keeps to itself.
[[nodiscard]] Outcome<Description> parseDescription(const std::string& text, const std::string& name);
// NotFound, Io, and as above.
[[nodiscard]] Outcome<Description> loadDescription(const std::string& path);

}  // namespace relievo::polhem
