// SPDX-License-Identifier: Apache-2.0
// Creates back ends from their names on the command line; the only file that knows all of them.
#include "drivers/registry.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include "drivers/alsa/alsa.h"
#include "drivers/egl/egl.h"
#include "drivers/evdev/evdev.h"
#include "drivers/failover/failover.h"
#ifdef RELIEVO_EXR
#include "drivers/exr/exr.h"
#endif
#include "drivers/falcon/falcon.h"
#include "drivers/falcon/link.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/floats/floats.h"
#include "drivers/gamepad/gamepad.h"
#include "drivers/gamepad/pad_list.h"
#ifdef RELIEVO_GSTREAMER
#include "drivers/gstreamer/gstreamer.h"
#endif
#ifdef RELIEVO_HEIF
#include "drivers/heif/heif.h"
#endif
#include "drivers/inverse3/inverse3.h"
#include "drivers/mock/mock.h"
#include "drivers/mock/scripted_remote.h"
#ifdef RELIEVO_OPENNI
#include "drivers/openni/openni.h"
#endif
#include "drivers/photo/photo.h"
#include "drivers/pictures/pictures.h"
#include "drivers/pointer/pointer.h"
#include "drivers/polhem/polhem.h"
#include "drivers/polhem/report.h"
#include "drivers/replay/replay.h"
#ifdef RELIEVO_ROSBAG
#include "drivers/rosbag/rosbag.h"
#endif
#include "drivers/sim/profiles.h"
#include "drivers/terminal/joined_remote.h"
#include "drivers/terminal/terminal.h"
#include "drivers/tiff/tiff.h"
#include "drivers/usb/usb_port.h"
#include "drivers/v4l2/v4l2.h"
#include "drivers/window/window_remote.h"
#include "hal/media/media_names.h"

#define RELIEVO_DISPLAY_NAMES "kms[:/dev/dri/cardN] window offscreen[:FILE.y4m] mock"
#define RELIEVO_HAPTIC_NAMES                                                                        \
  "falcon[:FIRMWARE] polhem[:DESCRIPTION.json] inverse3[:HOST[:PORT]] gamepad[:/dev/input/eventN] " \
  "pointer[:window|:/dev/input/eventN] "                                                            \
  "sim[:phantom|falcon|polhem][,stroking|resting|tapping|tense|shaking][,SCRIPT.csv] replay:FILE mock none"
#define RELIEVO_REMOTE_NAMES "evdev keys window script:FILE none"
#define RELIEVO_AUDIO_NAMES "alsa[:DEVICE] null none"
#define RELIEVO_DECODER_NAMES "v4l2 gstreamer[:ELEMENT] ffmpeg"

namespace relievo::drivers {

const char* const kDisplayNames = RELIEVO_DISPLAY_NAMES;
const char* const kHapticNames = RELIEVO_HAPTIC_NAMES;
const char* const kRemoteNames = RELIEVO_REMOTE_NAMES;
const char* const kAudioNames = RELIEVO_AUDIO_NAMES;
const char* const kDecoderNames = RELIEVO_DECODER_NAMES;
const char* const kMockFilm = "mock:";
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

DeviceState look(const char* name, Display& display) {
  const auto opened = display.open({});
  display.close();
  return {"display", name, opened.has_value(), opened ? "ready" : opened.error().message};
}

DeviceState look(const char* name, AudioOutput& output) {
  const auto opened = output.open({});
  output.close();
  return {"audio", name, opened.has_value(), opened ? "ready" : opened.error().message};
}

DeviceState look(const char* name, HapticDevice& device) {
  const auto opened = device.open();
  device.close();
  return {"haptic", name, opened.has_value(), opened ? "ready" : opened.error().message};
}

DeviceState windowsMouse(bool desktop) {
  return {"haptic", "pointer:window", desktop,
          desktop ? "ready: the mouse over the window" : "there is no desktop to open a window on"};
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

Result<StreamInfo> describePicture(const std::string& path) {
  const auto source = isNpyFile(path) ? makeNpySource() : makeFfmpegSource();
  if (auto opened = source->open(path); !opened) return std::unexpected(opened.error());
  for (const StreamInfo& stream : source->streams()) {
    if (stream.kind == StreamKind::Video) return stream;
  }
  return fail(ErrorCode::Corrupt, "is no picture; check the file");
}

// The project's own reader of the stream's pictures; nullopt if FFmpeg decodes them.
std::optional<PictureFormat> pictureFormat(const StreamInfo& stream) {
  if (isFloatTiff(stream)) return kTiff;
  const PictureFormat formats[] = {
      kPfm,       kNpy,
#ifdef RELIEVO_EXR
      kExr,       kExrColor,
#endif
#ifdef RELIEVO_HEIF
      kHeifColor, kHeifDepth, kHeifLeft, kHeifRight,
#endif
  };
  for (const PictureFormat& format : formats) {
    if (stream.codec == format.codec) return format;
  }
  return std::nullopt;
}

const PhotoKind kPhotoKinds[] = {
    kDepthJpeg,
    kStereoJpeg,
#ifdef RELIEVO_EXR
    kExrWithDepth,
#endif
#ifdef RELIEVO_HEIF
    kHeif,
#endif
};

bool holdsTwoLayers(const StreamInfo& stream) {
  const auto layers = stream.tags.find(kLayersTag);
  return layers != stream.tags.end() && layers->second == "2" && ffmpegDecodesBothViews();
}

// Hardware leaves an alpha channel out, and the second of two views.
bool isLeftToSoftware(const StreamInfo& stream) {
  return isMock(stream) || isV4l2Raw(stream) || pictureFormat(stream) || saysAlpha(stream) || holdsTwoLayers(stream);
}

std::unique_ptr<VideoDecoder> withSoftwareBehind(std::vector<std::unique_ptr<VideoDecoder>> decoders,
                                                 const StreamInfo& stream) {
  decoders.push_back(makeSoftwareDecoder(stream));
  return decoders.size() == 1 ? std::move(decoders.front()) : makeFailoverDecoder(std::move(decoders));
}

// A decoder that was asked for by its name.
std::unique_ptr<VideoDecoder> backed(std::unique_ptr<VideoDecoder> decoder, const StreamInfo& stream) {
  std::vector<std::unique_ptr<VideoDecoder>> decoders;
  if (!isLeftToSoftware(stream)) decoders.push_back(std::move(decoder));
  return withSoftwareBehind(std::move(decoders), stream);
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
      return unknown("--haptic", name, "is no place of a service; write inverse3:HOST or inverse3:HOST:PORT");
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
  if (name.plain("evdev")) return makeEvdevRemote();
  if (name.plain("keys")) return makeTerminalRemote();
  if (name.plain("window")) {
    auto keys = makeWindowRemote(theWindow());
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

std::unique_ptr<MediaSource> makeMediaSource(const std::string& url) {
  static MonotonicClock clock;
  const BackEndName name(url);
  if (name == kMockFilm) return makeMockSource(mockFilm(), clock);
#ifdef RELIEVO_ROSBAG
  if (isRosbag(url)) return makeRosbagSource();
#endif
#ifdef RELIEVO_OPENNI
  if (isOpenni(url)) return makeOpenniSource();
#endif
  if (name.word == "v4l2" && name.argument) return makeV4l2Source();
  if (isNpyFile(url)) return makeNpySource();
  if (isPhoto(url, kPhotoKinds)) return makePhotoSource(kPhotoKinds);
  return isPictures(url) ? makePicturesSource(describePicture) : makeFfmpegSource();
}

std::unique_ptr<VideoDecoder> makeSoftwareDecoder(const StreamInfo& stream) {
  if (isMock(stream)) return makeMockDecoder({.max_held_frames = 32});
  if (isV4l2Raw(stream)) return makeV4l2RawDecoder();
  const auto format = pictureFormat(stream);
  return format ? makePictureFileDecoder(*format) : makeFfmpegDecoder();
}

std::unique_ptr<VideoDecoder> makeVideoDecoder(const StreamInfo& stream) {
  if (isLeftToSoftware(stream)) return makeSoftwareDecoder(stream);
  std::vector<std::unique_ptr<VideoDecoder>> hardware;
  if (!lookAtV4l2M2mNodes().empty()) hardware.push_back(makeV4l2M2mDecoder());
#ifdef RELIEVO_GSTREAMER
  if (gstreamerHasDevices()) hardware.push_back(makeGstreamerDecoder());
#endif
  return withSoftwareBehind(std::move(hardware), stream);
}

Outcome<DecoderMaker> decoderMaker(const BackEndName& name) {
  if (name.word.empty()) return makeVideoDecoder;
  if (name.plain("ffmpeg")) return makeSoftwareDecoder;
  if (name.plain("v4l2")) return [](const StreamInfo& stream) { return backed(makeV4l2M2mDecoder(), stream); };
  if (name.plain("gstreamer") || name.withArgument("gstreamer")) {
#ifdef RELIEVO_GSTREAMER
    return [element = name.argument.value_or("")](const StreamInfo& stream) {
      return backed(makeGstreamerDecoder(element), stream);
    };
#else
    return unknown("--decoder", name, "this relievo was built without GStreamer; build it with -DRELIEVO_GSTREAMER=ON");
#endif
  }
  return unknown("--decoder", name, "no such decoder; it is one of: " RELIEVO_DECODER_NAMES);
}

Result<std::string> readText(const std::string& url, std::size_t most_bytes, const std::atomic<bool>& cancelled) {
  return readFfmpegText(url, most_bytes, cancelled);
}

std::unique_ptr<AudioDecoder> makeAudioDecoder() {
  return makeFfmpegAudioDecoder();
}

std::unique_ptr<SubtitleDecoder> makeSubtitleDecoder() {
  return makeFfmpegSubtitleDecoder();
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

bool desktopIsThere() {
  return relievo::desktopIsThere();
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
  states.push_back(look("window", *makeWindowDisplay(theWindow(), clock)));
  const bool desktop = states.back().there;
  states.insert(states.end(),
                {look("alsa", *makeAlsaOutput("default", clock)),
                 look("falcon", *makeFalcon(falconConfig(settings, std::nullopt), clock)),
                 look("polhem", *makePolhem({}, clock)), look("inverse3:localhost:10001", *makeInverse3({}, clock))});
  for (const PadSeen& pad : lookAtGamepads()) {
    states.push_back({"haptic", pad.path.empty() ? "gamepad" : "gamepad:" + pad.path, pad.there, pad.state});
  }
  states.insert(states.end(), {look("pointer", *makePointer(std::string(), clock)), windowsMouse(desktop)});
  return states;
}

void stopAllMotors() noexcept {
  quietenAllUsbDevices();
  quietenAllPads();
}

}  // namespace relievo::drivers
