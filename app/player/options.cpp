// SPDX-License-Identifier: Apache-2.0
// Declares the options for CLI11 and turns their words into values.
#include "app/player/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr const char* kAbout =
    "relievo: 3D video you can touch. Plays colour + depth video; a force-feedback device feels its relief.";
constexpr const char* kProgramFooter =
    "\nExamples:\n"
    "  relievo play film.mkv                          colour and depth are two tracks of one file\n"
    "  relievo probe scan.mov --packing tb --depth-code hue\n"
    "                                                 what is in it: colour on top, depth as hue below\n"
    "\n`relievo play --help` and `relievo probe --help` tell the rest.\n";
constexpr const char* kProbeFooter =
    "\nExamples:\n"
    "  relievo probe color.webm --depth depth.webm    two files\n"
    "  relievo probe --json film.mkv                  for programs\n";
constexpr const char* kPlayFooter =
    "\nExamples:\n"
    "  relievo play color.webm --depth depth.webm --report run.json\n"
    "      two files, shown off screen, touched by the simulated hand; the figures go to run.json\n"
    "  relievo play scan.mov --packing tb --depth-code hue --stereo anaglyph --loop --duration 60\n"
    "      one file with colour on top and depth as hue below, for red-cyan glasses, again and again for a minute\n"
    "\nKeys of the remote: play, pause, OK = pause and go on; left, right, rewind, fast forward = 10 s; 3D mode = "
    "next\n"
    "stereo layout; stop, back, exit, power = end. Exit code: 0 done, 1 failed at run time, 2 wrong use.\n";

constexpr double kLongestDurationS = 1e9;
constexpr double kMostPixels = 16384;  // of a display, across and down

struct Failed {
  std::string option;
  std::string why;
  int exit_code = kExitWrongUse;
};

// What is given as words and becomes values after the parsing.
struct Words {
  std::string packing = "auto";
  std::string depth_code = "luma";
  std::string stereo = "sbs";
  std::string size;
  std::string volume;
  std::optional<double> duration_s;
  std::vector<std::string> calibration;
};

// Without CLI11's own way to list them: the help names them already.
CLI::Validator oneOf(std::vector<std::string> words) {
  CLI::Validator validator = CLI::IsMember(std::move(words));
  validator.description("");
  return validator;
}

void addSourceOptions(CLI::App& command, SourceOptions& source, Words& words) {
  command.add_option("SOURCE", source.url, "A file or a URL")->required()->type_name(" ");
  command.add_option("--depth", source.depth_url, "A second file or URL that holds the depth")->type_name("SOURCE2");
  command
      .add_option("--packing", words.packing,
                  "Where the depth is [auto]\n"
                  "auto: two tracks or a DEPTH_PACKING tag tell; tracks: two video tracks, or --depth;\n"
                  "sbs: one picture, colour left, depth right; tb: colour on top, depth below")
      ->check(oneOf({"auto", "tracks", "sbs", "tb"}))
      ->type_name("auto|tracks|sbs|tb");
  command
      .add_option("--depth-code", words.depth_code,
                  "How the depth is coded [luma]\n"
                  "luma: as brightness; hue: as colour, red near, round to red far")
      ->check(oneOf({"luma", "hue"}))
      ->type_name("luma|hue");
  command
      .add_option("--calibration", words.calibration,
                  "What a depth code means, over what the film says; or a file of such lines\n"
                  "law=linear|inverse, polarity=near-high|near-low, range=full|limited,\n"
                  "bits=8..16, invalid=CODE|none, near=MM, far=MM")
      ->allow_extra_args(false)
      ->type_name("FILE|KEY=VALUE,..");
}

void addPlayOptions(CLI::App& command, PlayOptions& play, Words& words, const DeviceNames& names) {
  addSourceOptions(command, play.player.source, words);
  command.add_option("--display", play.display, std::string("Where the picture goes [offscreen]\n") + names.display)
      ->type_name("NAME");
  command.add_option("--size", words.size, "Pixels of the picture [1280x720]")->type_name("WxH");
  command
      .add_option("--stereo", words.stereo,
                  "How it is shown [sbs]\n"
                  "mono: one picture; sbs: left and right eye side by side; anaglyph: red-cyan")
      ->check(oneOf({"mono", "sbs", "anaglyph"}))
      ->type_name("mono|sbs|anaglyph");
  command.add_option("--haptic", play.haptic, std::string("What the finger holds [sim]\n") + names.haptic)
      ->type_name("NAME");
  command.add_option("--remote", play.remote, std::string("Where keys come from [none]\n") + names.remote)
      ->type_name("NAME");
  command
      .add_option("--volume", words.volume,
                  "Box in which the relief stands, mm\n[160 wide, 40 deep, as high as the depth picture's shape says]")
      ->type_name("WxHxD");
  command.add_flag("--loop", play.player.loop, "Begin again at the end");
  command.add_option("--duration", words.duration_s, "Stop after so many seconds")->type_name("S");
  command.add_option("--report", play.report_path, "Write what happened, as JSON")->type_name("FILE");
  command.add_option("--record", play.record_path, "Write every tick of the finger, as CSV")->type_name("FILE");
  command.footer(kPlayFooter);
}

// "160x90x40" into positive numbers.
template <std::size_t Count>
std::optional<std::array<double, Count>> parseSizes(const std::string& text) {
  std::array<double, Count> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < Count; ++i) {
    if (i > 0) {
      if (at == end || *at != 'x') return std::nullopt;
      ++at;
    }
    const auto [next, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc{} || !std::isfinite(values[i]) || values[i] <= 0) return std::nullopt;
    at = next;
  }
  return at == end ? std::optional(values) : std::nullopt;
}

std::optional<Failed> readCalibration(const Words& words, SourceOptions& source) {
  for (const std::string& text : words.calibration) {
    const bool on_command_line = text.find('=') != std::string::npos;
    std::string content = text;
    if (!on_command_line) {
      const std::ifstream file(text);
      if (!file) return Failed{text, "no such calibration file; give its path, or KEY=VALUE,..", kExitFailed};
      std::ostringstream read;
      read << file.rdbuf();
      content = read.str();
    }
    const auto settings = parseCalibration(content);
    if (!settings) return Failed{text, settings.error().message, on_command_line ? kExitWrongUse : kExitFailed};
    (on_command_line ? source.command_line : source.side_file) = *settings;
  }
  return std::nullopt;
}

std::optional<Failed> readSource(const Words& words, SourceOptions& source) {
  source.packing = words.packing == "tracks" ? Packing::Tracks
                   : words.packing == "sbs"  ? Packing::SideBySide
                   : words.packing == "tb"   ? Packing::TopBottom
                                             : Packing::Auto;
  source.depth_code = words.depth_code == "hue" ? DepthCode::Hue : DepthCode::Luma;
  return readCalibration(words, source);
}

std::optional<Failed> readPlay(const Words& words, PlayOptions& play) {
  PlayerConfig& player = play.player;
  if (auto failed = readSource(words, player.source)) return failed;
  player.stereo.layout = stereoLayout(words.stereo).value_or(player.stereo.layout);
  if (!words.size.empty()) {
    const auto size = parseSizes<2>(words.size);
    if (!size || std::min((*size)[0], (*size)[1]) < 1 || std::max((*size)[0], (*size)[1]) > kMostPixels) {
      return Failed{"--size " + words.size, "a size is WIDTHxHEIGHT in pixels, such as 1280x720"};
    }
    player.display = {.width = static_cast<int>((*size)[0]), .height = static_cast<int>((*size)[1])};
  }
  if (!words.volume.empty()) {
    const auto mm = parseSizes<3>(words.volume);
    if (!mm) return Failed{"--volume " + words.volume, "a volume is WIDTHxHEIGHTxDEPTH in mm, such as 160x90x40"};
    player.volume = DisplayVolume{(*mm)[0], (*mm)[1], (*mm)[2]};
  }
  if (words.duration_s) {
    if (!(*words.duration_s > 0 && *words.duration_s <= kLongestDurationS)) {
      return Failed{"--duration", "a duration is more than 0 and at most a billion seconds"};
    }
    player.duration = fromSeconds(*words.duration_s);
  }
  return std::nullopt;
}

std::unexpected<int> refuse(const Failed& failed) {
  log(LogLevel::Error, failed.option.c_str(), "%s", failed.why.c_str());
  return std::unexpected(failed.exit_code);
}

}  // namespace

std::expected<Options, int> parseOptions(int argc, const char* const* argv, const DeviceNames& names) {
  Options options;
  Words words;
  CLI::App program(kAbout, "relievo");
  program.footer(kProgramFooter);
  program.require_subcommand(1);
  CLI::App& play = *program.add_subcommand("play", "Play a film: shown in stereo, felt by the finger");
  CLI::App& probe = *program.add_subcommand("probe", "Tell what is in a source, and what it needs");
  Words probe_words;
  addPlayOptions(play, options.play, words, names);
  addSourceOptions(probe, options.probe.source, probe_words);
  probe.add_flag("--json", options.probe.json, "For programs");
  probe.footer(kProbeFooter);

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      program.exit(error);  // prints the help
      return std::unexpected(kExitDone);
    }
    const char* const command = play.parsed() ? "relievo play" : probe.parsed() ? "relievo probe" : "relievo";
    return refuse({"wrong use", std::string(error.what()) + "; see " + command + " --help", kExitWrongUse});
  }
  options.command = probe.parsed() ? Options::Command::Probe : Options::Command::Play;
  const auto failed = probe.parsed() ? readSource(probe_words, options.probe.source) : readPlay(words, options.play);
  if (failed) return refuse(*failed);
  return options;
}

void printFailure(const std::string& thing, const Error& error) {
  if (error.os_error != 0) {
    log(LogLevel::Error, thing.c_str(), "%s (%s)", error.message, std::strerror(error.os_error));
  } else {
    log(LogLevel::Error, thing.c_str(), "%s", error.message);
  }
}

}  // namespace relievo
