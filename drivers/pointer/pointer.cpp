// SPDX-License-Identifier: Apache-2.0
// Converts mouse counts, or what a mouse over a window points at, to the finger's target; the left button presses. The
// finger follows smoothly.
#include "drivers/pointer/pointer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "drivers/evdev/event_reports.h"

namespace relievo {
namespace {

constexpr double kRateHz = 1000;  // of the quickest mice
constexpr double kFarMm = -20, kNearMm = 60;
constexpr double kAboveMm = 6;  // of the finger over the display volume
constexpr double kUsualDepthMm = 40;
constexpr glm::dvec3 kStartMm(0, 0, kUsualDepthMm + kAboveMm);
constexpr double kMmPerCount = 0.1, kMmPerNotch = 2;
constexpr double kPressMmPerS = 80, kPressN = 2;
constexpr double kSmoothS = 0.01;
constexpr double kLongestStepS = 0.02;
constexpr Duration kWatchdog = std::chrono::milliseconds(20);

class Pointer final : public HapticDevice {
 public:
  Pointer(std::unique_ptr<MousePort> port, const Clock& clock) : port_(std::move(port)), clock_(clock) {}
  ~Pointer() override { close(); }
  Pointer(const Pointer&) = delete;
  Pointer& operator=(const Pointer&) = delete;

  // These are the figures of a small device, used to compute the picture; without motors any stiffness is stable.
  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    return {.name = "pointer",
            .workspace_min_mm = min_mm_,
            .workspace_max_mm = max_mm_,
            .peak_force_n = 8,
            .continuous_force_n = 8,
            .max_stiffness_n_per_mm = 1,
            .rate_hz = rateWithin(kRateHz, kRateHz),
            .in_scene = port_->overPicture()};
  }

 private:
  Result<void> openDevice() override {
    place_mm_ = finger_mm_ = kStartMm;
    pressed_mm_ = 0;
    depth_mm_ = kUsualDepthMm;
    if (auto opened = port_->open(); !opened) return opened;
    const glm::dvec2 reach_mm = port_->reachMm();
    min_mm_ = {-reach_mm, kFarMm};
    max_mm_ = {reach_mm, kNearMm};
    return {};
  }
  Result<void> homeDevice() override { return {}; }

  // Discards motion from before the start.
  Result<void> startDevice() override {
    const glm::dvec3 place = place_mm_;
    if (auto followed = followEvents(); !followed) return followed;
    if (auto known = askForButtons(); !known) return known;
    place_mm_ = place;
    force_z_n_ = 0;
    now_ = last_write_ = clock_.now();
    return {};
  }

  Result<HapticSample> readSample() RELIEVO_RT override {
    const MonotonicTime now = clock_.now();
    const double elapsed_s = std::clamp(toSeconds(now - now_), 0.0, kLongestStepS);
    now_ = now;
    if (now - last_write_ > kWatchdog) force_z_n_ = 0;
    if (auto followed = followEvents(); !followed) return std::unexpected(followed.error());
    press(elapsed_s);
    if (const SceneRay* ray = port_->ray()) follow(*ray);
    const glm::dvec3 goal_mm(place_mm_.x, place_mm_.y, place_mm_.z - pressed_mm_);
    finger_mm_ += (1 - std::exp(-elapsed_s / kSmoothS)) * (goal_mm - finger_mm_);
    return HapticSample{.position_mm = glm::clamp(finger_mm_, min_mm_, max_mm_), .buttons = buttons()};
  }

  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    force_z_n_ = force_n.z;
    last_write_ = now_;
    return {};
  }

  void stopDevice() noexcept override { force_z_n_ = 0; }
  void closeDevice() noexcept override {
    force_z_n_ = 0;
    port_->close();
  }

  // Like a finger of a given strength: a force against it slows it down, and a stronger one drives it back.
  void press(double elapsed_s) RELIEVO_RT {
    const bool held = (down_ & kLeftButton) != 0;
    const double share = held ? std::clamp(1 - force_z_n_ / kPressN, -1.0, 1.0) : -1.0;
    pressed_mm_ = std::clamp(pressed_mm_ + share * kPressMmPerS * elapsed_s, 0.0, place_mm_.z - kFarMm);
  }

  [[nodiscard]] std::uint32_t buttons() const RELIEVO_RT {
    return ((down_ & kMiddleButton) != 0 ? 1U : 0U) | ((down_ & kRightButton) != 0 ? 2U : 0U);
  }

  Result<void> followEvents() RELIEVO_RT {
    return reports_.follow(
        *port_, [this](const input_event& event) RELIEVO_RT { follow(event); },
        [this]() RELIEVO_RT { return askForButtons(); });
  }

  Result<void> askForButtons() RELIEVO_RT {
    const auto down = port_->buttonsDown();
    if (!down) return std::unexpected(down.error());
    down_ = *down;
    return {};
  }

  void follow(const input_event& event) RELIEVO_RT {
    if (event.type == EV_REL) move(event.code, event.value);
    if (event.type == EV_KEY) turn(event.code, event.value != 0);
  }

  // Keeps the finger on the line of sight, at its own height, which is shifted when the volume becomes deeper.
  void follow(const SceneRay& ray) RELIEVO_RT {
    max_mm_.z += ray.depth_mm - depth_mm_;
    place_mm_.z += ray.depth_mm - depth_mm_;
    depth_mm_ = ray.depth_mm;
    const glm::dvec2 at_mm = ray.at(place_mm_.z - pressed_mm_);
    place_mm_.x = at_mm.x;
    place_mm_.y = at_mm.y;
  }

  void move(std::uint16_t axis, std::int32_t counts) RELIEVO_RT {
    if (axis == REL_X) place_mm_.x += kMmPerCount * counts;
    if (axis == REL_Y) place_mm_.y -= kMmPerCount * counts;  // a mouse's y counts toward its user
    if (axis == REL_WHEEL) place_mm_.z -= kMmPerNotch * counts;
    place_mm_ = glm::clamp(place_mm_, min_mm_, max_mm_);
  }

  void turn(std::uint16_t key, bool down) RELIEVO_RT {
    std::uint8_t button = 0;
    if (key == BTN_LEFT) button = kLeftButton;
    if (key == BTN_RIGHT) button = kRightButton;
    if (key == BTN_MIDDLE) button = kMiddleButton;
    down_ = static_cast<std::uint8_t>(down ? down_ | button : down_ & ~button);
  }

  std::unique_ptr<MousePort> port_;
  const Clock& clock_;
  glm::dvec3 min_mm_{-port_->reachMm(), kFarMm}, max_mm_{port_->reachMm(), kNearMm};
  glm::dvec3 place_mm_ = kStartMm;   // where mouse and wheel point
  double depth_mm_ = kUsualDepthMm;  // of the display volume
  double pressed_mm_ = 0;            // how far below `place_mm_` the left button has pressed
  glm::dvec3 finger_mm_ = kStartMm;
  std::uint8_t down_ = 0;  // buttons of the mouse
  EventReports reports_;
  double force_z_n_ = 0;
  MonotonicTime now_, last_write_;
};

}  // namespace

std::unique_ptr<HapticDevice> makePointer(std::unique_ptr<MousePort> port, const Clock& clock) {
  return std::make_unique<Pointer>(std::move(port), clock);
}

std::unique_ptr<HapticDevice> makePointer(std::string path, const Clock& clock) {
  return makePointer(makeEvdevPort(std::move(path)), clock);
}

std::unique_ptr<HapticDevice> makePointer(std::shared_ptr<WindowInput> window, const Clock& clock) {
  return makePointer(makeWindowPort(std::move(window)), clock);
}

}  // namespace relievo
