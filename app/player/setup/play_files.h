// SPDX-License-Identifier: Apache-2.0
// The files of `play` besides the film: its keys, what it remembers from run to run, its report and its recordings.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "app/player/control/control_socket.h"
#include "app/player/report.h"
#include "app/player/setup/options.h"
#include "app/player/touch/recorder.h"
#include "platform/atomic_file.h"
#include "platform/failure.h"

namespace relievo {

// Loads the keys and finds the places to remember the volume and positions in.
[[nodiscard]] Outcome<void> loadPlayFiles(PlayOptions& options);

// "hand-2.csv" beside "hand.csv"; empty without a second finger or a recording.
[[nodiscard]] std::string secondRecordPath(const PlayOptions& options);

// What is written besides the picture and the sound. Empty: it was not asked for.
struct PlayOutputs {
  std::optional<AtomicFile> report;
  std::optional<Recorder> recorder, second_recorder;
  std::unique_ptr<ControlSocket> socket;
};
[[nodiscard]] Outcome<PlayOutputs> makeOutputs(const PlayOptions& options);

// Writes the report and the recordings, and says what could not be written; one that fails costs the others nothing.
// Returns the exit code.
[[nodiscard]] int finishFiles(const PlayReport& report, PlayOutputs& outputs);

}  // namespace relievo
