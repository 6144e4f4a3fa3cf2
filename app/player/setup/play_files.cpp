// SPDX-License-Identifier: Apache-2.0
// Checks before the film begins that the outputs can be written.
#include "app/player/setup/play_files.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <set>
#include <utility>

#include "app/cli/output_guard.h"
#include "app/cli/program.h"
#include "app/cli/read_files.h"
#include "app/media/folder/film_folder.h"
#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kIsFilm = "that is also a film that was played, and stays as it is; choose another file";
constexpr const char* kMayBeFilm =
    "the file system did not tell in time whether that is also a film that was played, so it stays as it is";

// A film that was opened while the player ran (dropped on its window, named by a program) may be the output. The end
// does not wait for film after film whose file system is silent: then it may be one of them. Null if it is none.
const char* mayBeFilm(const std::string& output, const PlayReport& report) {
  constexpr int kMostSilent = 20, kMostSearched = 1000;  // for what belongs to them
  const std::atomic<bool> at_once = true;
  const CancelsAnswers cancels(at_once);
  const auto there = statusOf(output);
  if (!there) return there.error().code == ErrorCode::NotFound ? nullptr : kMayBeFilm;
  std::set<std::string> films = report.opened;
  films.insert(report.depth_source);
  int silent = 0, searched = 0;
  for (const std::string& film : films) {
    const CancelsAnswers anew(at_once);  // with a grace of its own
    const auto status = statusOf(localPathIn(film));
    if (!status && status.error().code == ErrorCode::Cancelled) {
      if (++silent == kMostSilent) return kMayBeFilm;
      continue;
    }
    if (status && status->st_dev == there->st_dev && status->st_ino == there->st_ino) return kIsFilm;
    if (++searched <= kMostSearched && !keepApart({output}, {film, depthBeside(film)})) return kIsFilm;
  }
  return nullptr;
}

// Puts an output in place, beside a file that may be one of the films.
Outcome<void> putInPlace(AtomicFile& file, const PlayReport& report) {
  const std::string path = file.path();
  const char* const why = mayBeFilm(path, report);
  if (why != nullptr) file.setExisting(Existing::Beside);
  if (auto done = file.commit(); !done) return failOn(path, done.error());
  if (why == nullptr || file.path() == path) return {};
  return failOn(print("%s was written in place of %s", file.path().c_str(), path.c_str()),
                {ErrorCode::InvalidArgument, 0, why});
}

}  // namespace

Outcome<void> loadPlayFiles(PlayOptions& options) {
  if (!options.keys_path.empty()) {
    auto keys = KeyTable::load(options.keys_path);
    const bool shown = options.from_desktop && options.player.browser;
    if (!keys && !shown) return std::unexpected(keys.error());
    if (keys) options.player.keys = std::move(*keys);
    else if (!options.player.fault) options.player.fault = keys.error();
  }
  options.player.sound_device = options.audio.text();
  if (const std::string state = Resume::defaultPath(); !state.empty()) {
    options.player.volume_path = (std::filesystem::path(state).parent_path() / "volume.json").string();
  }
  const bool was_chosen = options.player.browser && !options.player.faults_in_list;  // from the list of films
  if (!options.resume && !was_chosen) return {};
  const std::string path = Resume::defaultPath();
  if (path.empty()) {
    if (!options.resume) return {};
    return failOn("--resume",
                  {ErrorCode::NotFound, 0, "there is no folder to keep settings in; set HOME or STATE_DIRECTORY"});
  }
  const auto made = makeFolders(std::filesystem::path(path).parent_path());
  const auto place = made ? AtomicFile::create(path) : std::unexpected(made.error());
  if (!place && options.resume) return failOn("--resume " + path, place.error());
  if (place) options.player.resume_path = path;
  return {};
}

std::string secondRecordPath(const PlayOptions& options) {
  if (options.record_path.empty() || options.second_haptic.word.empty()) return "";
  const std::filesystem::path path = options.record_path;
  return (path.parent_path() / (path.stem().string() + "-2" + path.extension().string())).string();
}

Outcome<PlayOutputs> makeOutputs(const PlayOptions& options) {
  PlayOutputs outputs;
  if (!options.report_path.empty()) {
    auto created = AtomicFile::create(options.report_path);
    if (!created) return failOn(options.report_path, created.error());
    outputs.report = std::move(*created);
  }
  if (!options.record_path.empty()) {
    auto created = Recorder::create(options.record_path);
    if (!created) return failOn(options.record_path, created.error());
    outputs.recorder = std::move(*created);
  }
  if (const std::string path = secondRecordPath(options); !path.empty()) {
    auto created = Recorder::create(path);
    if (!created) return failOn(path, created.error());
    outputs.second_recorder = std::move(*created);
  }
  if (!options.control_path.empty()) {
    auto listening = ControlSocket::listen(options.control_path);
    if (!listening) return std::unexpected(listening.error());
    outputs.socket = std::move(*listening);
  }
  return outputs;
}

int finishFiles(const PlayReport& report, PlayOutputs& outputs) {
  const CancelsAnswers kept(nullptr);  // the signal that has ended the player does not cancel writing its files
  int result = kExitDone;
  const auto put = [&](AtomicFile& file) {
    if (auto done = putInPlace(file, report); !done) result = tell(done.error());
  };
  const auto finish = [&](std::optional<Recorder>& recorder, const HapticSummary& haptic) {
    if (recorder && haptic.ticks > 0) put(recorder->file());
  };
  finish(outputs.recorder, report.haptic);
  if (report.second_finger) finish(outputs.second_recorder, report.second_finger->haptic);
  if (outputs.report) {
    outputs.report->write(toJson(report));
    put(*outputs.report);
  }
  return result;
}

}  // namespace relievo
