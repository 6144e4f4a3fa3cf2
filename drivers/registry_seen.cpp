// SPDX-License-Identifier: Apache-2.0
// Which back ends can be used on this machine now, and why the others cannot.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "drivers/egl/egl.h"
#include "drivers/falcon/link.h"
#include "drivers/gamepad/gamepad.h"
#include "drivers/gamepad/pad_list.h"
#ifdef RELIEVO_GSTREAMER
#include "drivers/gstreamer/gstreamer.h"
#endif
#include "drivers/polhem/report.h"
#include "drivers/registry.h"
#include "drivers/usb/usb_port.h"
#include "drivers/v4l2/v4l2.h"

namespace relievo::drivers {
namespace {

// Opens a device and closes it again.
template <class Device, class... Setup>
DeviceState lookAt(const char* kind, const char* name, const Outcome<std::unique_ptr<Device>>& made,
                   const Setup&... setup) {
  if (!made) return {kind, name, false, made.error().error.message};
  const auto opened = (*made)->open(setup...);
  (*made)->close();
  return {kind, name, opened.has_value(), opened ? "ready" : opened.error().message};
}

// A sound server that has to be started first answers late.
DeviceState lookAtSound(Clock& clock) {
  const auto made = makeAudioOutput("alsa", clock);
  if (!made) return {"audio", "alsa", false, made.error().error.message};
  for (const MonotonicTime until = clock.now() + std::chrono::seconds(3);;) {
    const auto opened = (*made)->open({});
    (*made)->close();
    const bool is_late = !opened && opened.error().code == ErrorCode::Timeout && clock.now() < until;
    if (!is_late) return {"audio", "alsa", opened.has_value(), opened ? "ready" : opened.error().message};
    clock.sleepUntil(clock.now() + std::chrono::milliseconds(50));
  }
}

DeviceState windowsMouse(bool desktop) {
  return {"haptic", "pointer:window", desktop,
          desktop ? "ready: the mouse over the window" : "there is no desktop to open a window on"};
}

}  // namespace

bool desktopIsThere() {
  return relievo::desktopIsThere();
}

void tellOnDesktop(const std::string& message) {
  relievo::tellOnDesktop(message);
}

bool screenIsThere() {
  return std::ranges::any_of(lookAtKmsScreens(), &KmsScreen::there);
}

std::string pluggedHaptic() {
  if (usbDeviceIsThere(std::array{falcon::kUsbId})) return "falcon";
  return usbDeviceIsThere(std::array{polhem::kMbedId, polhem::kTeensyId}) ? "polhem" : "";
}

bool terminalIsThere() {
  return ::isatty(STDIN_FILENO) == 1;
}

std::vector<DeviceState> lookAtDevices(const HapticSettings& settings, Clock& clock) {
  std::vector<DeviceState> states;
  for (const KmsScreen& screen : lookAtKmsScreens()) {
    states.push_back({"display", screen.card.empty() ? "kms" : "kms:" + screen.card, screen.there, screen.state});
  }
  for (const V4l2M2mNode& node : lookAtV4l2M2mNodes()) {
    std::string codecs;
    for (const std::string& codec : node.codecs) codecs += " " + codec;
    states.push_back({"decoder", node.path, true, node.card + ":" + codecs});
  }
#ifdef RELIEVO_GSTREAMER
  if (gstreamerHasDevices()) {
    for (const GstreamerElement& each : lookAtGstreamerElements()) {
      states.push_back({"decoder", "gstreamer:" + each.name, true, each.title});
    }
  }
#endif
  states.push_back(lookAt("display", "window", makeDisplay("window"), DisplayConfig{}));
  const bool desktop = states.back().there;
  states.push_back(lookAtSound(clock));
  const auto look = [&](const char* name) {
    states.push_back(lookAt("haptic", name, makeHapticDevice(name, clock, settings)));
  };
  for (const char* const name : {"falcon", "polhem", "inverse3:localhost:10001"}) look(name);
  for (const PadSeen& pad : lookAtGamepads()) {
    states.push_back({"haptic", pad.path.empty() ? "gamepad" : "gamepad:" + pad.path, pad.there, pad.state});
  }
  look("pointer");
  states.push_back(windowsMouse(desktop));
  return states;
}

void stopAllMotors() noexcept {
  quietenAllUsbDevices();
  quietenAllPads();
}

}  // namespace relievo::drivers
