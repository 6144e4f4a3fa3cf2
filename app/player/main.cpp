// SPDX-License-Identifier: Apache-2.0
// The player's program: chooses the back ends, plays or probes, and reports errors in one line.
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "app/cli/options.h"
#include "app/cli/output_guard.h"
#include "app/cli/program.h"
#include "app/media/folder/film_folder.h"
#include "app/player/control/player_control.h"
#include "app/player/film/probe.h"
#include "app/player/player.h"
#include "app/player/setup/config_file.h"
#include "app/player/setup/near_file.h"
#include "app/player/setup/options.h"
#include "app/player/setup/play_files.h"
#include "app/player/setup/self_test.h"
#include "app/player/touch/calibrate.h"
#include "drivers/registry.h"
#include "platform/clock.h"
#include "platform/files/file_system_answer.h"
#include "platform/log.h"
#include "platform/print.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr Error kNoPicture{ErrorCode::Timeout, 0,
                           "--duration ended before the first picture came; make it longer, or check that the source "
                           "sends one"};

PairReader::Backends realBackends(drivers::DecoderMaker make_decoder = drivers::makeVideoDecoder) {
  return {.make_source = drivers::makeMediaSource,
          .make_decoder = std::move(make_decoder),
          .read_text = drivers::readText,
          .make_audio_decoder = drivers::makeAudioDecoder,
          .make_subtitle_decoder = drivers::makeSubtitleDecoder};
}

drivers::HapticSettings settingsOf(const FileConfig& config) {
  return {.falcon_firmware = config.falcon_firmware.value_or(""), .falcon_counts_per_nm = config.falcon_counts_per_nm};
}

Outcome<void> keepOutputsApart(const PlayOptions& options, const FileConfig& config) {
  const SourceOptions& source = options.player.source;
  std::vector<std::string> inputs = source.named_files;
  inputs.insert(inputs.end(), {source.url, source.depth_url, depthBeside(source.url), options.keys_path, config.path,
                               config.falcon_firmware.value_or("")});
  for (const std::string& film : options.player.more) inputs.insert(inputs.end(), {film, depthBeside(film)});
  std::vector<std::string> outputs{options.report_path, options.record_path, secondRecordPath(options),
                                   options.control_path};
  for (const BackEndName* name :
       {&options.display, &options.haptic, &options.second_haptic, &options.remote, &options.audio}) {
    const drivers::NamedFiles files = drivers::filesNamedBy(*name);
    inputs.push_back(files.read);
    outputs.push_back(files.written);
  }
  return keepApart(outputs, inputs);
}

// The devices that a film is played on. Null: there is none.
struct Devices {
  std::unique_ptr<Display> display;
  std::unique_ptr<HapticDevice> haptic, second_haptic;
  std::unique_ptr<RemoteInput> remote;
  std::unique_ptr<AudioOutput> audio;
  drivers::DecoderMaker make_decoder;
};

// A device that cannot run at the rate runs at its highest, which is logged.
Outcome<void> askForRate(HapticDevice& device, double hz) {
  const auto rate = device.setRate(hz);
  if (!rate) return failOn("--rate", rate.error());
  if (*rate != hz) {
    log(LogLevel::Info, "haptic", "%s runs at %.0f Hz, its highest rate; it cannot run at the %.0f Hz of --rate",
        device.capabilities().name, *rate, hz);
  }
  return {};
}

Outcome<std::unique_ptr<HapticDevice>> makeHaptic(const BackEndName& name, const PlayOptions& options,
                                                  const FileConfig& config, Clock& clock) {
  if (name.word.empty()) return nullptr;
  auto device = drivers::makeHapticDevice(name, clock, settingsOf(config));
  if (!device || *device == nullptr || !options.rate_hz) return device;
  if (auto asked = askForRate(**device, *options.rate_hz); !asked) return std::unexpected(asked.error());
  return device;
}

Outcome<Devices> makeDevices(const PlayOptions& options, const FileConfig& config, Clock& clock) {
  auto display = drivers::makeDisplay(options.display);
  if (!display) return std::unexpected(display.error());
  auto haptic = makeHaptic(options.haptic, options, config, clock);
  if (!haptic) return std::unexpected(haptic.error());
  if (*haptic == nullptr && !options.record_path.empty()) {
    return failOn("--record " + options.record_path,
                  {ErrorCode::InvalidArgument, 0, "there is no finger to record with --haptic none; leave one out"});
  }
  auto second = makeHaptic(options.second_haptic, options, config, clock);
  if (!second) return std::unexpected(second.error());
  auto remote = drivers::makeRemoteInput(options.remote, clock);
  if (!remote) return std::unexpected(remote.error());
  auto audio = drivers::makeAudioOutput(options.audio, clock);
  if (!audio) return std::unexpected(audio.error());
  auto make_decoder = drivers::decoderMaker(options.software ? BackEndName("ffmpeg") : options.decoder);
  if (!make_decoder) return std::unexpected(make_decoder.error());
  return Devices{std::move(*display), std::move(*haptic), std::move(*second),
                 std::move(*remote),  std::move(*audio),  std::move(*make_decoder)};
}

// "sampel.mkv (sample.mkv?): no such file; .."
Failure withNearFile(Failure failure) {
  if (failure.error.code == ErrorCode::NotFound && failure.error.os_error == ENOENT) {
    if (const std::string near = nearFile(failure.thing); !near.empty()) failure.thing += " (" + near + "?)";
  }
  return failure;
}

// Where nobody sees the terminal, what ends the program is shown on the desktop. Only the viewer ends that message, so
// signals end the program at once again.
int tellViewer(const Failure& failure, bool from_desktop) {
  const int code = tell(failure);
  if (!from_desktop) return code;
  drivers::stopAllMotors();
  endOnSignals();
  std::string words = failure.thing + ": " + failure.error.message;
  if (failure.error.os_error != 0) words += print(" (%s)", std::strerror(failure.error.os_error));
  drivers::tellOnDesktop(words);
  return code;
}

int play(PlayOptions options, const FileConfig& config) {
  const std::atomic<bool>& stop = stopOnSignals(drivers::stopAllMotors);
  const CancelsAnswers cancels(stop);
  const auto tellHere = [&stop, from_desktop = options.from_desktop](const Failure& failure) {
    return tellViewer(failure, from_desktop && !stop);
  };
  applyLogLevels(config);
  drivers::boundDecoderMemory();
  if (options.verbose) setLogLevel(LogLevel::Debug);
  if (auto loaded = loadPlayFiles(options); !loaded) return tellHere(loaded.error());
  if (auto apart = keepOutputsApart(options, config); !apart) return tellHere(apart.error());
  MonotonicClock clock;
  const auto devices = makeDevices(options, config, clock);
  if (!devices) return tellHere(devices.error());
  auto outputs = makeOutputs(options);
  if (!outputs) return tellHere(outputs.error());
  PlayerControl control(std::move(outputs->socket), drivers::switchFault);
  const auto recorderOf = [](std::optional<Recorder>& recorder) { return recorder ? &*recorder : nullptr; };

  const bool for_a_time = options.player.duration.has_value(), resume = options.resume;
  StatusLine status;
  Player player(std::move(options.player),
                {.clock = clock,
                 .display = *devices->display,
                 .haptic = devices->haptic.get(),
                 .remote = devices->remote.get(),
                 .audio = devices->audio.get(),
                 .recorder = recorderOf(outputs->recorder),
                 .second_finger = {devices->second_haptic.get(), recorderOf(outputs->second_recorder)},
                 .control = &control,
                 .status = &status,
                 .backends = realBackends(devices->make_decoder),
                 .posters = realBackends(drivers::makeSoftwareDecoder)});
  const auto played = player.run(stop);
  const PlayReport report = player.report();
  const int files = finishFiles(report, *outputs);
  if (played || report.frames_shown > 0) say(toText(report, options.verbose));
  if (!played) return tellHere(withNearFile(played.error()));
  if (for_a_time && report.frames_shown == 0 && !report.source.empty() && !stop)
    return tell({report.source, kNoPicture});
  return resume && !player.placesAreKept() ? kExitFailed : files;  // the log has said why
}

int probeSource(const ProbeOptions& options) {
  drivers::boundDecoderMemory();
  const auto result = probe(options.source, realBackends());
  if (!result) return tell(result.error());
  if (options.json) std::fputs(probeToJson(*result).c_str(), stdout);
  else say(probeToText(*result));
  return result->failure ? tell(*result->failure) : kExitDone;
}

int listDevices(const FileConfig& config) {
  MonotonicClock clock;
  bool any = false;
  for (const auto& each : drivers::lookAtDevices(settingsOf(config), clock)) {
    const std::string device = print("%-7s %-24s %-6s ", each.kind, each.name.c_str(), each.there ? "there" : "-");
    say(oneLine(device + each.state) + "\n");
    any = any || each.there;
  }
  std::puts(any ? "`relievo FILM` uses a connected haptic device, else the mouse; --haptic NAME chooses one."
                : "Without a device: relievo FILM --haptic sim touches with a simulated device and hand.");
  return kExitDone;
}

int calibrateFalcon(const FileConfig& config) {
  const std::atomic<bool>& stop = stopOnSignals(drivers::stopAllMotors);
  drivers::HapticSettings settings = settingsOf(config);
  const double counts = settings.falcon_counts_per_nm.value_or(drivers::kFalconCountsPerNm);
  settings.falcon_counts_per_nm = counts;
  MonotonicClock clock;
  const auto falcon = drivers::makeHapticDevice("falcon", clock, settings);
  if (!falcon) return tell(falcon.error());
  const std::jthread listener([&stop, &device = **falcon](const std::stop_token& done) {  // nobody else looks at `stop`
    while (!done.stop_requested() && !stop) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (stop) device.cancel();
  });
  if (auto opened = (*falcon)->open(); !opened) return tell({"falcon", opened.error()});
  std::puts(
      "Home the Falcon: pull its grip out and push it in. Then hold it with the scale in the middle of its range.");
  const auto ratio = measureStrength(**falcon, askForReading, clock);
  if (!ratio) return tell({"falcon", ratio.error()});

  const std::string path = config.path.empty() ? defaultConfigPath() : config.path;
  std::printf("The Falcon gives %.0f %% of the requested force: counts_per_nm = %.0f.\n", 100 * *ratio,
              counts / *ratio);
  const auto saved = setNumber(path, "falcon", "counts_per_nm", counts / *ratio);
  if (!saved) return tell(saved.error());
  std::printf("Written to %s.\n", path.c_str());
  return kExitDone;
}

int testItself() {
  MonotonicClock clock;
  auto display = drivers::makeDisplay("offscreen");
  auto haptic = drivers::makeHapticDevice("sim", clock);
  if (!display) return tell(display.error());
  if (!haptic) return tell(haptic.error());
  bool bad = false;
  for (const SelfTestLine& line : selfTest({.clock = clock,
                                            .display = **display,
                                            .haptic = **haptic,
                                            .backends = realBackends(),
                                            .film = drivers::kMockFilm})) {
    using Verdict = SelfTestLine::Verdict;
    const char* const verdict = line.verdict == Verdict::Good ? "good" : line.verdict == Verdict::Note ? "note" : "bad";
    std::printf("%-4s  %-9s %s\n", verdict, line.thing.c_str(), line.said.c_str());
    bad = bad || line.verdict == Verdict::Bad;
  }
  return bad ? kExitFailed : kExitDone;
}

int parseAndRun(int argc, char** argv) {
  const auto options = parseOptions(argc, argv,
                                    {.display = drivers::kDisplayNames,
                                     .haptic = drivers::kHapticNames,
                                     .remote = drivers::kRemoteNames,
                                     .audio = drivers::kAudioNames,
                                     .decoder = drivers::kDecoderNames},
                                    {.desktop = drivers::desktopIsThere,
                                     .screen = drivers::screenIsThere,
                                     .haptic = drivers::pluggedHaptic,
                                     .terminal = drivers::terminalIsThere});
  if (!options) return options.error();
  switch (options->command) {
    case Options::Command::Probe:
      return probeSource(options->probe);
    case Options::Command::Devices:
      return options->calibrate ? calibrateFalcon(options->config) : listDevices(options->config);
    case Options::Command::SelfTest:
      return testItself();
    case Options::Command::Play:
      break;
  }
  if (options->play.print_keys || options->play.print_states) {
    const std::string text = options->play.print_keys ? std::string(KeyTable::usualText()) : stateGraph();
    std::fputs(text.c_str(), stdout);
    return kExitDone;
  }
  return play(options->play, options->config);
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  return relievo::runProgram("relievo", [&] { return relievo::parseAndRun(argc, argv); });
}
