// SPDX-License-Identifier: Apache-2.0
// The command line of `relievo`: what it takes, what it teaches, and what it refuses.
#pragma once

#include <expected>
#include <string>

#include "app/player/player.h"
#include "app/player/setup/config_file.h"
#include "hal/back_end_name.h"

namespace relievo {

struct PlayOptions {
  PlayerConfig player;
  BackEndName display = "offscreen";
  BackEndName haptic = "sim";
  BackEndName remote;
  BackEndName audio;
  bool software = false;    // no hardware decodes the film
  std::string report_path;  // empty: none
  std::string record_path;
  std::string keys_path;  // empty: the usual keys
  bool resume = false;
  bool osd = false;  // also off screen
  bool print_keys = false, print_states = false;
  std::string control_path;  // empty: no control socket
};

struct ProbeOptions {
  SourceOptions source;
  bool json = false;
};

struct Options {
  enum class Command : std::uint8_t { Play, Probe, Devices, SelfTest };
  Command command = Command::Play;
  PlayOptions play;
  ProbeOptions probe;
  bool calibrate = false;  // of Devices
  FileConfig config;       // of play and devices: read, and what it says of play is in `play`
};

// The names of the back ends, for the help.
struct DeviceNames {
  const char* display = "";
  const char* haptic = "";
  const char* remote = "";
  const char* audio = "";
};

// Options are the command line's, then the configuration's, then the defaults. On wrong use, and when help or the
// configuration was asked for, it has printed what there is to say and answers the exit code.
[[nodiscard]] std::expected<Options, int> parseOptions(int argc, const char* const* argv, const DeviceNames& names);

}  // namespace relievo
