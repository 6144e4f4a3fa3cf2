// SPDX-License-Identifier: Apache-2.0
// The description of a device of the Polhem and WoodenHaptics family: lengths, drives and limits, read from JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "drivers/force/encoder_gate.h"
#include "platform/failure.h"

namespace relievo::polhem {

// The files have the format of the maker's library (its `toJSON` writes one), in SI units. Keys are named as here, with
// the axis's letter: diameter_capstan_a and so on; other keys are ignored. Files for the published devices are beside
// this one; their numbers come from the library's header (BSD licence).
struct Description {
  int variant = 0;                           // of the kinematics; 0, 1 and 2 are the same
  std::array<double, 3> diameter_capstan{};  // m
  std::array<double, 3> diameter_body{};     // m
  std::array<double, 3> length_body{};       // m; a: height of the shoulder
  std::array<double, 3> workspace_origin{};  // m, in the maker's frame
  double workspace_radius = 0;               // m
  std::array<double, 3> torque_constant{};   // torque_constant_motor_a: N m / A
  double current_for_10_v_signal = 0;        // A, the amplifiers' maximum
  std::array<double, 3> cpr_encoder{};       // counts per turn of the motor
  double max_linear_force = 0;               // N
  double max_linear_stiffness = 0;           // N/m
  EncoderCounts calibrate_enc{};             // in the calibration pose
  std::array<bool, 3> motor_and_body_aligned{};
  double max_milliamps = 2000;  // not a key of the file: the maker's library uses this for all devices
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

// The failure names `name` and the key. Corrupt: no JSON. InvalidArgument: a key is missing or its value is impossible.
// Unsupported: variant 3 (Polhem v2 and v3), whose kinematics are not published.
[[nodiscard]] Outcome<Description> parseDescription(const std::string& text, const std::string& name);
// NotFound, Io, and the errors of parseDescription.
[[nodiscard]] Outcome<Description> loadDescription(const std::string& path);

}  // namespace relievo::polhem
