// SPDX-License-Identifier: Apache-2.0
// Stick and trigger move the finger; the force goes to the effects.
#include "drivers/gamepad/gamepad.h"

#include <algorithm>
#include <glm/vec2.hpp>
#include <utility>

#include "drivers/evdev/event_reports.h"
#include "drivers/gamepad/effect_player.h"
#include "drivers/gamepad/pad_controls.h"
#include "drivers/gamepad/pad_effects.h"
#include "drivers/gamepad/pad_finger.h"
#include "hal/haptic_rate.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr double kLongestStepS = 0.02;
constexpr std::int32_t kFull = 0xffff;

// As many as the device has room for: the force itself first.
PadMotors motorsOf(const PadFacts& facts, bool wheel) noexcept {
  int room = facts.effects_at_once;
  const auto has = [&](unsigned code) { return facts.forces.has(code) && room-- > 0; };
  PadMotors motors;
  motors.constant = has(FF_CONSTANT);
  motors.spring = has(FF_SPRING);
  motors.rumble = has(FF_RUMBLE);
  if (motors.constant || motors.spring) motors.axes = wheel ? 1 : 2;
  return motors;
}

constexpr double kRateHz = 1000, kStiffnessNPerMm = 0.5;

class Gamepad final : public HapticDevice {
 public:
  Gamepad(std::unique_ptr<PadPort> port, Clock& clock, const GamepadConfig& config)
      : config_(config), port_(std::move(port)), clock_(clock), player_(*port_, clock) {}
  ~Gamepad() override { close(); }
  Gamepad(const Gamepad&) = delete;
  Gamepad& operator=(const Gamepad&) = delete;

  // Rumble has no force in newtons: the peak is the force that drives it fully. A wheel's strength is not published.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    const double rate_hz = rateWithin(kRateHz, kRateHz);
    return {.name = "gamepad",
            .workspace_min_mm = PadFinger::kMinMm,
            .workspace_max_mm = PadFinger::kMaxMm,
            .peak_force_n = PadEffects::kPeakN,
            .continuous_force_n = PadEffects::kPeakN,
            .max_stiffness_n_per_mm = stiffnessAtRate(kStiffnessNPerMm, kRateHz, rate_hz),
            .rate_hz = rate_hz,
            .rests_in_pause = true};
  }
  [[nodiscard]] const Histogram* contactDelays() const noexcept override { return &player_.contactDelays(); }

 private:
  Result<void> openDevice() override {
    const auto facts = port_->open();
    if (!facts) return std::unexpected(facts.error());
    controls_ = PadControls(*facts);
    motors_ = motorsOf(*facts, controls_.isWheel());
    has_gain_ = facts->forces.has(FF_GAIN);
    has_centring_ = facts->forces.has(FF_AUTOCENTER);
    if (!std::exchange(told_, true)) {
      log(LogLevel::Info, "haptic", "%s: %s; it is not a 1 kHz three-axis device: its effects are up to 10 ms late",
          facts->name.c_str(), motors_.axes > 0 ? "its stick pushes" : "rumble shows the force");
    }
    return {};
  }

  Result<void> homeDevice() override { return {}; }

  Result<void> startDevice() override {
    effects_ = PadEffects(motors_);
    finger_ = PadFinger(motors_.axes);
    force_n_ = {};
    now_ = last_write_ = clock_.now();
    if (auto followed = followEvents(); !followed) return followed;
    if (auto known = askForState(); !known) return known;
    // Not every driver knows them; those that do not ignore them.
    if (has_gain_) static_cast<void>(port_->send(FF_GAIN, kFull));
    if (has_centring_) static_cast<void>(port_->send(FF_AUTOCENTER, 0));
    auto started = player_.start(motors_, config_.effect_thread);
    if (!started) restoreCentring();
    return started;
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const MonotonicTime now = clock_.now();
    const double elapsed_s = std::clamp(toSeconds(now - now_), 0.0, kLongestStepS);
    now_ = now;
    if (auto followed = followEvents(); !followed) return std::unexpected(followed.error());
    if (auto alive = player_.check(now); !alive) return std::unexpected(alive.error());
    if (now - last_write_ > EffectPlayer::kWatchdog) force_n_ = {};
    const glm::dvec3 finger_mm = finger_.move(controls_.stick(), controls_.pull(), force_n_, elapsed_s);
    return HapticSample{.position_mm = finger_mm, .buttons = controls_.buttons()};
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    const bool was_contact = effects_.contact();
    const PadLevels levels = effects_.follow(force_n, controls_.stick(), toSeconds(now_ - last_write_));
    if (effects_.contact() && !was_contact) contact_since_ = clock_.now();
    player_.want(levels, effects_.contact(), contact_since_, clock_.now());
    force_n_ = force_n;
    last_write_ = now_;
    return {};
  }

  void stopDevice() noexcept override {
    player_.stop();
    restoreCentring();
  }
  void closeDevice() noexcept override {
    player_.stop();
    port_->close();
  }
  void restoreCentring() noexcept {
    if (has_centring_) static_cast<void>(port_->send(FF_AUTOCENTER, kFull));
  }

  Result<void> followEvents() RELIEVO_RT {
    return reports_.follow(
        *port_, [this](const input_event& event) RELIEVO_RT { controls_.take(event); },
        [this]() RELIEVO_RT { return askForState(); });
  }

  Result<void> askForState() RELIEVO_RT {
    const auto down = port_->keysDown();
    if (!down) return std::unexpected(down.error());
    controls_.setKeys(*down);
    for (unsigned code = 0; code < ABS_CNT; ++code) {
      if (!controls_.uses(code)) continue;
      const auto value = port_->axis(code);
      if (!value) return std::unexpected(value.error());
      controls_.setAxis(code, *value);
    }
    return {};
  }

  GamepadConfig config_;
  std::unique_ptr<PadPort> port_;
  Clock& clock_;
  EffectPlayer player_;
  PadControls controls_;
  PadMotors motors_;
  PadEffects effects_;
  PadFinger finger_;
  bool has_gain_ = false, has_centring_ = false;
  bool told_ = false;  // the device's kind has been logged
  EventReports reports_;
  glm::dvec3 force_n_{0};
  MonotonicTime now_, last_write_, contact_since_;
};

}  // namespace

std::unique_ptr<HapticDevice> makeGamepad(std::unique_ptr<PadPort> port, Clock& clock, const GamepadConfig& config) {
  return std::make_unique<Gamepad>(std::move(port), clock, config);
}

std::unique_ptr<HapticDevice> makeGamepad(std::string path, Clock& clock) {
  return makeGamepad(makeEvdevPadPort(std::move(path)), clock);
}

}  // namespace relievo
