// SPDX-License-Identifier: Apache-2.0
// The command line of `relievo`.
#pragma once

#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/player/player.h"
#include "app/player/setup/config_file.h"
#include "hal/back_end_name.h"

namespace relievo {

struct PlayOptions {
  PlayerConfig player;
  BackEndName display;  // not named: the machine's (see Machine)
  BackEndName haptic;
  BackEndName second_haptic;  // of a second finger; not named: none
  BackEndName remote;
  BackEndName audio;
  BackEndName decoder;
  std::optional<StereoSignal> tv_signal;  // nullopt: the one that fits the picture's layout
  std::optional<double> rate_hz;          // of the haptic task; nullopt: the device's own
  bool software = false;                  // true: decode without hardware
  std::string report_path;                // empty: none
  std::string record_path;
  std::string keys_path;  // empty: the usual keys
  bool resume = false;
  std::vector<std::string> films;  // folders for the list of films
  bool from_desktop = false;       // nobody reads the terminal
  bool osd = false;                // show it also off screen
  bool print_keys = false, print_states = false;
  bool verbose = false;      // print a developer's lines and figures
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
  FileConfig config;       // of play and devices: as read; its [play] is applied to `play`
};

// The names of the back ends, for the help.
struct DeviceNames {
  const char* display = "";
  const char* haptic = "";
  const char* remote = "";
  const char* audio = "";
  const char* decoder = "";
};

// The devices of the machine, for options that are not given. Each is asked only if its answer is needed; an empty
// function means no.
struct Machine {
  std::function<bool()> desktop;        // a window can be opened
  std::function<bool()> screen;         // kms can show a picture
  std::function<std::string()> haptic;  // the name of a force-feedback device that is plugged in; empty without
  std::function<bool()> terminal;       // the keys of standard input's terminal can be read
};

// If the first word is no command, it is a film: "relievo FILM.." is "relievo play FILM..".
//
// Options are taken from the command line, else from the configuration, else from the machine: a window on a desktop,
// else the screen, else off screen; without a film, the list of films there; in a window and on a screen, the
// plugged-in force-feedback device, else the mouse. After a usage error, and if help or the configuration was
// requested, everything has been printed and the exit code is returned.
[[nodiscard]] std::expected<Options, int> parseOptions(int argc, const char* const* argv, const DeviceNames& names,
                                                       const Machine& machine = {});

}  // namespace relievo
