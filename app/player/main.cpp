// SPDX-License-Identifier: Apache-2.0
// The program of the box: chooses the back ends, plays or probes, and says in one line what went wrong.
#include <atomic>
#include <cstdio>
#include <utility>

#include "app/cli/options.h"
#include "app/cli/program.h"
#include "app/player/options.h"
#include "app/player/player.h"
#include "app/player/probe.h"
#include "app/player/recorder.h"
#include "drivers/registry.h"
#include "platform/atomic_file.h"
#include "platform/clock.h"

namespace relievo {
namespace {

PairReader::Backends backendsFor(const std::string& url) {
  return {.make_source = [url] { return drivers::makeMediaSource(url); }, .make_decoder = drivers::makeVideoDecoder};
}

int finishFiles(const PlayReport& report, AtomicFile* report_file, Recorder* recorder) {
  if (recorder != nullptr && report.haptic.ticks > 0) {
    if (auto finished = recorder->finish(); !finished) return tell({recorder->path(), finished.error()});
  }
  if (report_file != nullptr) {
    report_file->write(toJson(report));
    if (auto written = report_file->commit(); !written) return tell({report_file->path(), written.error()});
  }
  return kExitDone;
}

// The file of "offscreen:FILE[@FPS]".
std::string captureFile(const std::string& display) {
  const std::string prefix = "offscreen:";
  if (!display.starts_with(prefix)) return "";
  return display.substr(prefix.size(), display.rfind('@') - prefix.size());
}

int play(PlayOptions options) {
  const std::atomic<bool>& stop = stopOnSignals();
  const SourceOptions& source = options.player.source;
  if (auto apart = keepApart({options.report_path, options.record_path, captureFile(options.display)},
                             {source.url, source.depth_url});
      !apart) {
    return tell(apart.error());
  }
  MonotonicClock clock;
  auto display = drivers::makeDisplay(options.display);
  if (!display) return tell(display.error());
  auto haptic = drivers::makeHapticDevice(options.haptic, clock);
  if (!haptic) return tell(haptic.error());
  if (*haptic == nullptr && !options.record_path.empty()) {
    return tell({"--record " + options.record_path,
                 {ErrorCode::InvalidArgument, 0, "there is no finger to record with --haptic none; leave one out"}});
  }
  auto remote = drivers::makeRemoteInput(options.remote, clock);
  if (!remote) return tell(remote.error());

  // What cannot be written is found out before the film begins.
  std::optional<AtomicFile> report_file;
  if (!options.report_path.empty()) {
    auto created = AtomicFile::create(options.report_path);
    if (!created) return tell({options.report_path, created.error()});
    report_file = std::move(*created);
  }
  std::optional<Recorder> recorder;
  if (!options.record_path.empty()) {
    auto created = Recorder::create(options.record_path);
    if (!created) return tell({options.record_path, created.error()});
    recorder = std::move(*created);
  }

  const std::string url = options.player.source.url;
  Player player(std::move(options.player), {.clock = clock,
                                            .display = **display,
                                            .haptic = haptic->get(),
                                            .remote = remote->get(),
                                            .recorder = recorder ? &*recorder : nullptr,
                                            .backends = backendsFor(url)});
  const auto played = player.run(stop);
  const PlayReport report = player.report();
  const int files = finishFiles(report, report_file ? &*report_file : nullptr, recorder ? &*recorder : nullptr);
  if (!played) return tell(played.error());
  if (files == kExitDone) std::fputs(toText(report).c_str(), stdout);
  return files;
}

int probeSource(const ProbeOptions& options) {
  const auto result = probe(options.source, backendsFor(options.source.url));
  if (!result) return tell(result.error());
  std::fputs((options.json ? probeToJson(*result) : probeToText(*result)).c_str(), stdout);
  return result->failure ? tell(*result->failure) : kExitDone;
}

int parseAndRun(int argc, char** argv) {
  const auto options = parseOptions(
      argc, argv,
      {.display = drivers::kDisplayNames, .haptic = drivers::kHapticNames, .remote = drivers::kRemoteNames});
  if (!options) return options.error();
  return options->command == Options::Command::Probe ? probeSource(options->probe) : play(options->play);
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  return relievo::runProgram("relievo", [&] { return relievo::parseAndRun(argc, argv); });
}
