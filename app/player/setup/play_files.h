// SPDX-License-Identifier: Apache-2.0
// The files of `play` besides the film: keys, settings kept between runs, report and recordings.
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

// Loads the keys and finds the files for the volume and the positions.
[[nodiscard]] Outcome<void> loadPlayFiles(PlayOptions& options);

// "hand-2.csv" beside "hand.csv"; empty without a second finger or a recording.
[[nodiscard]] std::string secondRecordPath(const PlayOptions& options);

// The outputs besides picture and sound. Empty: not requested.
struct PlayOutputs {
  std::optional<AtomicFile> report;
  std::optional<Recorder> recorder, second_recorder;
  std::unique_ptr<ControlSocket> socket;
};
[[nodiscard]] Outcome<PlayOutputs> makeOutputs(const PlayOptions& options);

// Writes the report and the recordings, and reports failures; one failure does not affect the other files. A film that
// was played is not replaced: the output is put beside it, which is a failure too. Returns the exit code.
[[nodiscard]] int finishFiles(const PlayReport& report, PlayOutputs& outputs);

}  // namespace relievo
