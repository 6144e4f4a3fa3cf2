// SPDX-License-Identifier: Apache-2.0
// Creates devices from their names on the command line. Films: registry_media.cpp; what is there: registry_seen.cpp.
#include "drivers/registry.h"

#include <atomic>
#include <optional>
#include <utility>

#include "drivers/alsa/alsa.h"
#include "drivers/egl/egl.h"
#include "drivers/evdev/evdev.h"
#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "drivers/gamepad/gamepad.h"
#include "drivers/inverse3/inverse3.h"
#include "drivers/mock/mock.h"
#include "drivers/mock/scripted_remote.h"
#include "drivers/pointer/pointer.h"
#include "drivers/polhem/polhem.h"
#include "drivers/replay/replay.h"
#include "drivers/sim/profiles.h"
#include "drivers/terminal/joined_remote.h"
#include "drivers/terminal/terminal.h"
#include "drivers/window/window_remote.h"

#define RELIEVO_DISPLAY_NAMES "kms[:/dev/dri/cardN] window offscreen[:FILE.y4m] mock"
#define RELIEVO_HAPTIC_NAMES                                                                        \
  "falcon[:FIRMWARE] polhem[:DESCRIPTION.json] inverse3[:HOST[:PORT]] gamepad[:/dev/input/eventN] " \
  "pointer[:window|:/dev/input/eventN] "                                                            \
  "sim[:phantom|falcon|polhem][,stroking|resting|tapping|tense|shaking][,SCRIPT.csv] replay:FILE mock none"
#define RELIEVO_REMOTE_NAMES "evdev keys window script:FILE none"
#define RELIEVO_AUDIO_NAMES "alsa[:DEVICE] null none"

namespace relievo::drivers {

const char* const kDisplayNames = RELIEVO_DISPLAY_NAMES;
const char* const kHapticNames = RELIEVO_HAPTIC_NAMES;
const char* const kRemoteNames = RELIEVO_REMOTE_NAMES;
const char* const kAudioNames = RELIEVO_AUDIO_NAMES;
const double kFalconCountsPerNm = falcon::kDefaultCountsPerNm;

namespace {

const std::shared_ptr<WindowInput>& theWindow() {
  static const auto input = std::make_shared<WindowInput>();
  return input;
}

FalconConfig falconConfig(const HapticSettings& settings, const std::optional<std::string>& firmware) {
  FalconConfig config{.firmware_path = firmware.value_or(settings.falcon_firmware)};
  if (settings.falcon_counts_per_nm) config.counts_per_nm = *settings.falcon_counts_per_nm;
  return config;
}

// The benches of existing mocks. Used on the main thread only.
std::weak_ptr<MockDisplayBench> display_bench;
std::vector<std::weak_ptr<MockHapticBench>> haptic_benches;  // as they were made

template <class Bench>
std::shared_ptr<Bench> newBench(std::weak_ptr<Bench>& known) {
  auto bench = std::make_shared<Bench>();
  known = bench;
  return bench;
}

std::shared_ptr<MockHapticBench> newHapticBench() {
  std::erase_if(haptic_benches, [](const auto& known) { return known.expired(); });
  return newBench(haptic_benches.emplace_back());
}

std::weak_ptr<MockHapticBench> hapticBench(std::size_t number) {
  return number < haptic_benches.size() ? haptic_benches[number] : std::weak_ptr<MockHapticBench>();
}

template <class Bench>
Result<void> turn(const std::weak_ptr<Bench>& known, std::atomic<bool> Bench::* which, bool on) {
  const auto bench = known.lock();
  if (!bench)
    return fail(ErrorCode::InvalidState, "that device is no mock; start with --display mock or --haptic mock");
  *bench.*which = on;
  return {};
}

std::unexpected<Failure> unknown(const char* option, const BackEndName& name, const char* message) {
  return failOn(option + (" " + name.text()), {ErrorCode::InvalidArgument, 0, message});
}

}  // namespace

Outcome<std::unique_ptr<Display>> makeDisplay(const BackEndName& name) {
  static MonotonicClock clock;  // has no state
  if (name.plain("kms") || name.withArgument("kms")) return makeKmsDisplay(name.argument.value_or(""));
  if (name.plain("window")) return makeWindowDisplay(theWindow(), clock);
  if (name.plain("offscreen")) return makeOffscreenDisplay({}, clock);
  if (name.withArgument("offscreen")) return makeOffscreenDisplay(Capture::parse(*name.argument), clock);
  if (name.plain("mock")) return makeMockDisplay(MockDisplayProfile{}, clock, newBench(display_bench));
  return unknown("--display", name, "no such display; it is one of: " RELIEVO_DISPLAY_NAMES);
}

Outcome<std::unique_ptr<HapticDevice>> makeHapticDevice(const BackEndName& name, Clock& clock,
                                                        const HapticSettings& settings) {
  if (name.plain("falcon") || name.withArgument("falcon"))
    return makeFalcon(falconConfig(settings, name.argument), clock);
  if (name.plain("polhem")) return makePolhem({}, clock);
  if (name.withArgument("polhem")) {
    auto description = polhem::loadDescription(*name.argument);
    if (!description) return std::unexpected(description.error());
    return makePolhem({.description = *description}, clock);
  }
  if (name.plain("inverse3")) return makeInverse3({}, clock);
  if (name.withArgument("inverse3")) {
    const auto address = inverse3::Address::parse(*name.argument);
    if (!address)
      return unknown("--haptic", name, "is not a service's address; write inverse3:HOST or inverse3:HOST:PORT");
    return makeInverse3({.address = *address}, clock);
  }
  if (name.plain("sim") || name.withArgument("sim")) {
    auto setup = parseSim(name.argument.value_or(""));
    if (!setup) return std::unexpected(setup.error());
    return makeSimHaptic(setup->profile, std::move(setup->path), clock);
  }
  if (name.plain("gamepad") || name.withArgument("gamepad")) return makeGamepad(name.argument.value_or(""), clock);
  if (name.with("pointer", "window")) return makePointer(theWindow(), clock);
  if (name.plain("pointer") || name.withArgument("pointer")) return makePointer(name.argument.value_or(""), clock);
  if (name.withArgument("replay")) {
    auto recording = Recording::load(*name.argument);
    if (!recording) return std::unexpected(recording.error());
    return makeReplay(std::move(*recording));
  }
  if (name.plain("mock")) return makeMockHaptic(MockHapticProfile{}, clock, newHapticBench());
  if (name.plain("none")) return nullptr;
  return unknown("--haptic", name, "no such haptic device; it is one of: " RELIEVO_HAPTIC_NAMES);
}

Outcome<std::unique_ptr<RemoteInput>> makeRemoteInput(const BackEndName& name, Clock& clock) {
  if (name.plain("evdev")) {
    return terminalIsThere() ? makeRemoteAtTerminal(makeEvdevRemote(), makeTerminalRemote()) : makeEvdevRemote();
  }
  if (name.plain("keys")) return makeTerminalRemote();
  if (name.plain("window")) {
    auto pads = makePadRemote([window = theWindow()] { return window->focused.load(); });
    auto keys = makeJoinedRemote(makeWindowRemote(theWindow()), std::move(pads));
    return terminalIsThere() ? makeJoinedRemote(std::move(keys), makeTerminalRemote()) : std::move(keys);
  }
  if (name.withArgument("script")) {
    auto keys = loadKeyScript(*name.argument);
    if (!keys) return std::unexpected(keys.error());
    return makeScriptedRemote(*keys, clock);
  }
  if (name.plain("none")) return nullptr;
  return unknown("--remote", name, "no such remote; it is one of: " RELIEVO_REMOTE_NAMES);
}

Outcome<std::unique_ptr<AudioOutput>> makeAudioOutput(const BackEndName& name, const Clock& clock) {
  if (name.plain("alsa") || name.withArgument("alsa")) return makeAlsaOutput(name.argument.value_or("default"), clock);
  if (name.plain("null")) return makeMockAudio({}, clock);
  if (name.plain("none")) return nullptr;
  return unknown("--audio", name, "no such sound output; it is one of: " RELIEVO_AUDIO_NAMES);
}

NamedFiles filesNamedBy(const BackEndName& name) {
  if (name.withArgument("offscreen")) return {.written = Capture::parse(*name.argument).path};
  if (name.withArgument("sim")) return {.read = scriptNamedBy(*name.argument)};
  for (const char* const reader : {"falcon", "polhem", "replay", "script"}) {
    if (name.withArgument(reader)) return {.read = *name.argument};
  }
  return {};
}

Result<void> switchFault(std::string_view device, std::string_view fault) {
  const bool unplug = fault == "unplug";
  const bool haptic = device == "haptic" || device == "haptic2";
  const auto finger = hapticBench(device == "haptic2" ? 1 : 0);
  if (haptic && fault == "glitch") return turn(finger, &MockHapticBench::glitch, true);
  if (unplug || fault == "plug") {
    if (haptic) return turn(finger, &MockHapticBench::unplugged, unplug);
    if (device == "display") return turn(display_bench, &MockDisplayBench::unplugged, unplug);
  }
  return fail(ErrorCode::InvalidArgument,
              "no such fault; use haptic unplug|plug|glitch, haptic2 for a second one, display unplug|plug");
}

}  // namespace relievo::drivers
