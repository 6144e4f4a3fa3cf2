// SPDX-License-Identifier: Apache-2.0
// Checks the range of every number, since the file determines the motor currents.
#include "drivers/polhem/description.h"
#include "platform/whole_file.h"

#include <cerrno>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace relievo::polhem {
namespace {

using nlohmann::json;

constexpr Error kMissing{ErrorCode::InvalidArgument, 0,
                         "is missing or not a number; see the examples in drivers/polhem"};
constexpr Error kRange{ErrorCode::InvalidArgument, 0,
                       "is out of the range of any device; use SI units: m, N, N/m, N m/A, A, counts"};

struct Range {
  double least, most;
};
constexpr Range kDiameter{0.001, 1}, kLength{0.01, 1}, kTorqueConstant{0.001, 10}, kCounts{100, 1e6};
constexpr Range kCalibration{-32768, 32767};

// Reads one key after another until one is wrong.
class Reader {
 public:
  explicit Reader(const json& object) : object_(object) {}

  double number(const std::string& key, Range range) {
    const auto found = object_.find(key);
    if (found == object_.end() || !found->is_number()) return wrong(key, kMissing);
    const auto value = found->get<double>();
    return value >= range.least && value <= range.most ? value : wrong(key, kRange);
  }
  double numberOr(double otherwise, const std::string& key, Range range) {
    return object_.contains(key) ? number(key, range) : otherwise;
  }
  // The maker's library writes true and false; its tables have 1 and 0.
  bool flag(const std::string& key) {
    const auto found = object_.find(key);
    if (found != object_.end() && found->is_boolean()) return found->get<bool>();
    return number(key, {0, 1}) != 0;
  }
  // The three numbers key_a, key_b and key_c.
  std::array<double, 3> numbers(const std::string& key, Range range) {
    return {number(key + "_a", range), number(key + "_b", range), number(key + "_c", range)};
  }

  [[nodiscard]] const std::optional<Failure>& failure() const { return failure_; }

 private:
  double wrong(const std::string& key, const Error& error) {
    if (!failure_) failure_ = Failure{key, error};
    return 0;
  }
  const json& object_;
  std::optional<Failure> failure_;
};

std::int16_t countOf(double value) {
  return static_cast<std::int16_t>(std::lround(value));
}

}  // namespace

Outcome<Description> parseDescription(const std::string& text, const std::string& name) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return failOn(name, {ErrorCode::Corrupt, 0, "is not a JSON object; see the examples in drivers/polhem"});
  Reader from(object);
  const double variant = from.number("variant", {0, 1e6});
  if (!from.failure() && variant != 0 && variant != 1 && variant != 2) {
    return failOn(name, {ErrorCode::Unsupported, 0,
                         "the kinematics of this variant (3: Polhem v2, v3) are not public; only 0, 1 and 2 work"});
  }
  Description d{
      .variant = static_cast<int>(variant),
      .diameter_capstan = from.numbers("diameter_capstan", kDiameter),
      .diameter_body = from.numbers("diameter_body", kDiameter),
      .length_body = from.numbers("length_body", kLength),
      .workspace_origin = {from.number("workspace_origin_x", {-2, 2}), from.number("workspace_origin_y", {-2, 2}),
                           from.number("workspace_origin_z", {-2, 2})},
      .workspace_radius = from.number("workspace_radius", {0.01, 1}),
      .torque_constant = from.numbers("torque_constant_motor", kTorqueConstant),
      .current_for_10_v_signal = from.number("current_for_10_v_signal", {0.01, 20}),
      .cpr_encoder = from.numbers("cpr_encoder", kCounts),
      .max_linear_force = from.number("max_linear_force", {0.1, 50}),
      .max_linear_stiffness = from.number("max_linear_stiffness", {1, 1e5}),
      .motor_and_body_aligned = {from.flag("motor_and_body_aligned_a"), from.flag("motor_and_body_aligned_b"),
                                 from.flag("motor_and_body_aligned_c")},
      .max_milliamps = from.numberOr(Description{}.max_milliamps, "max_milliamps", {10, 20000})};
  const auto counts = from.numbers("calibrate_enc", kCalibration);
  d.calibrate_enc = {countOf(counts[0]), countOf(counts[1]), countOf(counts[2])};
  if (from.failure()) return failOn(name + ": " + from.failure()->thing, from.failure()->error);
  return d;
}

Outcome<Description> loadDescription(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Settings, "the device's description cannot be read; check its path");
  if (!text) return failOn(path, text.error());
  return parseDescription(*text, path);
}

}  // namespace relievo::polhem
