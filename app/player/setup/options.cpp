// SPDX-License-Identifier: Apache-2.0
// Declares the options for CLI11 and turns their words into values.
#include "app/player/setup/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>

#include "app/cli/options.h"
#include "app/cli/program.h"
#include "app/player/control/key_table.h"
#include "app/player/screen/stereo_word.h"
#include "app/player/setup/config_options.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kAbout =
    "relievo: 3D video you can touch. Plays colour + depth video; a force-feedback device feels its relief.";
constexpr const char* kProgramFooter =
    "\nExamples:\n"
    "  relievo play film.mkv                          colour and depth are two tracks of one file\n"
    "  relievo probe scan.mov --packing tb --depth-code hue\n"
    "                                                 what is in it: colour on top, depth as hue below\n"
    "  relievo devices                                what hardware is there, and why a thing is refused\n"
    "  relievo selftest                               whether it works here, without any hardware\n"
    "\n`relievo play --help` and `relievo probe --help` tell the rest, `relievo-author --help` how to make a film.\n";
constexpr const char* kProbeFooter =
    "\nExamples:\n"
    "  relievo probe film.mkv                         its tracks, what its depth means, what a finger will feel of it\n"
    "  relievo probe color.webm --depth depth.webm    two files\n"
    "  relievo probe --json film.mkv                  for programs\n"
    "\nWhat it tells: tracks; `meaning`: each value of the calibration and who said it; `relief`: the codes and "
    "heights in\n"
    "use; `touch`: the widths that the finger will feel the relief through, and the error that is left; `needs`: what "
    "the\n"
    "film asks for or lacks, and the option to try. Exit code: 0 done, 1 failed at run time, 2 wrong use.\n";
constexpr const char* kPlayFooter =
    "\nExamples:\n"
    "  relievo play color.webm --depth depth.webm --report run.json\n"
    "      two files, shown off screen, touched by the simulated hand; the figures go to run.json\n"
    "  relievo play scan.mov --packing tb --depth-code hue --stereo anaglyph --loop --duration 60\n"
    "      one file with colour on top and depth as hue below, for red-cyan glasses, again and again for a minute\n"
    "  relievo play film.mkv --display offscreen:film.y4m --haptic sim:hand.csv --remote script:keys.txt\n"
    "      the picture into a file that ffmpeg reads, finger and keys by scripts\n"
    "  relievo play film.mkv --display kms --size 1920x1080 --haptic falcon\n"
    "      on a whole screen of the box, without a desktop\n"
    "  relievo play film.mkv --display window --haptic pointer\n"
    "      in a window on the desktop: its keys are the remote, its mouse is the finger; F11 fills the screen\n"
    "  relievo play evening.m3u --loop --resume\n"
    "      the films of a list, from where they were left\n"
    "  relievo play --control /run/user/1000/relievo\n"
    "      waits; a program opens films by lines such as {\"do\": \"open film.mkv\"}, and is told what happens\n"
    "\nEvery option can stand in the configuration by its long name, SOURCE as source:\n"
    "  [play]\n"
    "  display = \"kms\"\n"
    "  loop = true\n"
    "  [log]\n"
    "  all = \"warning\"                error, warning, info, debug; or for an area, as haptic = \"debug\"\n"
    "\nA hand script has the line t_s,x_mm,y_mm,z_mm and a row a moment; x right, y up, z toward the viewer, 0,0,0 in "
    "the\n"
    "middle of the far plane. A key script has lines such as: 2.5 PLAYPAUSE (seconds, a key's name). Keys, by their "
    "names:\n";
constexpr const char* kDevicesFooter =
    "\nEach display and device is opened as `play` would; where it is refused, the line says why and what to do. Of a "
    "screen\nit tells the mode and the 3D signals that it takes.\n"
    "\nIn the configuration (TOML; `relievo play --print-config` shows one) stands of them:\n"
    "  [falcon]\n"
    "  firmware = \"/path/to/image\"    the maker's firmware, from the SDK that came with the device\n"
    "  counts_per_nm = 6000           how strong it is, as `relievo devices calibrate` finds it\n";
constexpr const char* kCalibrateFooter =
    "\nHook a spring scale to the Falcon's grip and pull it out to the middle of its way. The grip pushes toward you "
    "with "
    "2,\n3 and 4 N in turn: type what the scale shows each time, in newtons. The result goes into the configuration, "
    "where\n`relievo play` finds it. Until then the Falcon is taken for as strong as any is said to be, so "
    "that it is\nnever stronger than asked.\n";
constexpr const char* kSelfTestFooter =
    "\nIt looks for a font and the decoders, and plays a film of its own for three seconds off screen, touched by the\n"
    "simulated hand. Each line begins with `good`, `note` (it goes without, less well) or `bad`. Exit code: 0 nothing "
    "is\n"
    "bad, 1 something is, 2 wrong use.\n";
constexpr const char* kExitCodes = "\nExit code: 0 done, 1 failed at run time, 2 wrong use.\n";

constexpr double kLongestDurationS = 1e9;
constexpr double kMostPixels = 16384;  // of a display, across and down
constexpr const char* kNoSize = "a size is WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 1280x720";
constexpr const char* kStereoHelp =
    "How it is shown\n"
    "mono: one picture; sbs, tab: left and right eye side by side, or one above the other,\n"
    "each squeezed by half; sbs:full, tab:full: each in its own shape; rows, columns: line by line;\n"
    "anaglyph[:gray|color]: for red-cyan glasses; frame-packing: HDMI 3D; quilt[:COLSxROWS]: many views [8x6]";
constexpr const char* kNoStereo =
    "no such layout; it is one of: mono sbs[:full] tab[:full] rows columns anaglyph[:gray|color] frame-packing "
    "quilt[:COLSxROWS]";
constexpr const char* kNoDuration = "a duration is more than 0 and at most a billion seconds";

CLI::Option* addSourceOptions(CLI::App& command, SourceOptions& source) {
  CLI::Option* url =
      command
          .add_option("SOURCE", source.url,
                      "A film, a folder of films or pictures, pictures (\"a/%06d.png\", \"a/*.png\"), "
                      "associations.txt, a playlist, or an address: http, https (HLS as well), rtsp, rtp, udp, tcp; "
                      "v4l2:DEVICE; mock:, which needs no file")
          ->type_name(" ");
  command.add_option("--depth", source.depth_url, "A second file or address that holds the depth")
      ->type_name("SOURCE2");
  addDepthOptions(command, source);
  addRateOption(command, source);
  return url;
}

DisplayConfig readSize(const std::string& word) {
  std::array<double, 2> size{};
  if (!parseSizes(word, size) || std::min(size[0], size[1]) < 1 || std::max(size[0], size[1]) > kMostPixels) {
    throw WordFailure({"--size " + word, {ErrorCode::InvalidArgument, 0, kNoSize}});
  }
  return {.width = static_cast<int>(size[0]), .height = static_cast<int>(size[1])};
}

Duration readDuration(double seconds) {
  if (!(seconds > 0 && seconds <= kLongestDurationS)) {
    throw WordFailure({"--duration", {ErrorCode::InvalidArgument, 0, kNoDuration}});
  }
  return fromSeconds(seconds);
}

// An option that names a back end. Its word is one of `names`: those stand parted by spaces, each with what may follow
// it in brackets or behind a colon.
CLI::Option* addBackEnd(CLI::App& command, const char* option, BackEndName& chosen, const char* kind, const char* names,
                        const char* help) {
  const auto judge = [kind, names](const std::string& given) -> std::string {
    const BackEndName name(given);
    std::istringstream all(names);
    for (std::string known; all >> known;) {
      if (!name.word.empty() && known.substr(0, known.find_first_of(":[")) == name.word) return "";
    }
    return given + ": no such " + kind + "; it is one of: " + names;
  };
  return command
      .add_option_function<std::string>(
          option, [&chosen](const std::string& given) { chosen = given; }, std::string(help) + "\n" + names)
      ->default_str(chosen.text())
      ->check(CLI::Validator(judge, ""))
      ->type_name("NAME");
}

void addConfigOption(CLI::App& command, std::string& path) {
  command
      .add_option("--config", path,
                  "The configuration [~/.config/relievo/relievo.toml, else /etc/relievo/relievo.toml]")
      ->type_name("FILE")
      ->configurable(false);
}

void addStereoOptions(CLI::App& command, StereoSettings& stereo) {
  const auto readStereo = [&stereo](const std::string& word) {
    if (!parseStereo(word, stereo)) throw WordFailure({"--stereo " + word, {ErrorCode::InvalidArgument, 0, kNoStereo}});
  };
  command.add_option_function<std::string>("--stereo", readStereo, kStereoHelp)
      ->type_name("mono|sbs|tab|rows|columns|anaglyph|frame-packing|quilt")
      ->default_str(stereoWord(stereo));
  command.add_flag("--swap-eyes", stereo.swap_eyes, "The left eye's picture for the right eye");
  command
      .add_option("--depth-strength", stereo.strength,
                  "How deep the picture looks, to the eye alone: 0 flat, 1 as the viewer's eyes stand")
      ->capture_default_str()
      ->check(between(0.0, StereoSettings::kMostStrength))
      ->type_name("X");
}

void addPlayOptions(CLI::App& command, PlayOptions& play, const DeviceNames& names) {
  addSourceOptions(command, play.player.source);
  addBackEnd(command, "--display", play.display, "display", names.display, "Where the picture goes");
  command
      .add_option_function<std::string>(
          "--size", [&play](const std::string& word) { play.player.display = readSize(word); },
          "Pixels of the picture; of kms a mode that the screen has, else its favourite")
      ->default_str(print("%dx%d", play.player.display.width, play.player.display.height))
      ->type_name("WxH");
  addStereoOptions(command, play.player.stereo);
  addBackEnd(command, "--haptic", play.haptic, "haptic device", names.haptic, "What the finger holds");
  addBackEnd(command, "--remote", play.remote, "remote", names.remote,
             "Where keys come from [a window's own; on a whole screen evdev, all remote controls; else none]");
  addBackEnd(command, "--audio", play.audio, "sound output", names.audio,
             "Where the sound goes [of a window or a whole screen alsa, else none]");
  command.add_flag("--software", play.software, "Decode without the video hardware, where that shows faults");
  addVolumeOption(command, play.player.volume);
  command.add_flag("--loop", play.player.loop, "Begin again at the end");
  command
      .add_option_function<double>(
          "--duration", [&play](double seconds) { play.player.duration = readDuration(seconds); },
          "Stop after so many seconds")
      ->type_name("S");
  command.add_flag("--resume", play.resume, "Begin where the film was left, and remember where it is left");
  command.add_option("--keys", play.keys_path, "Which key means what (see --print-keys) [the usual]")
      ->type_name("FILE");
  command.add_flag("--print-keys", play.print_keys, "Print the table of keys, to begin one of your own from")
      ->configurable(false);
  command
      .add_flag("--print-states", play.print_states, "Print the player's states as a drawing: | dot -Tsvg > states.svg")
      ->configurable(false);
  command.add_option("--report", play.report_path, "Write what happened, as JSON")->type_name("FILE");
  command.add_option("--record", play.record_path, "Write every tick of the finger, as CSV")->type_name("FILE");
  command
      .add_option(
          "--control", play.control_path,
          "Listen there for commands of programs, one JSON object a line; after SOURCE, or without, wait for the next\n"
          "film, until one says quit")
      ->type_name("SOCKET");
  command.footer(kPlayFooter + KeyTable::usual().help() + kExitCodes);
}

// A window brings its keys and its mouse along; nothing else has them. A whole screen is watched from a sofa. Who sees
// the film hears it.
Outcome<void> settleWindow(PlayOptions& play) {
  const bool window = play.display.plain("window");
  const bool whole_screen = play.display.word == "kms";
  if (play.remote.word.empty()) play.remote = window ? "window" : whole_screen ? "evdev" : "none";
  if (play.audio.word.empty()) play.audio = window || whole_screen ? "alsa" : "none";
  if (window && play.haptic.plain("pointer")) play.haptic.argument = "window";
  const auto none = [](const std::string& thing) {
    return failOn(thing, {ErrorCode::InvalidArgument, 0, "there is no window; add --display window"});
  };
  if (!window && play.remote.plain("window")) return none("--remote window");
  if (!window && play.haptic.with("pointer", "window")) return none("--haptic pointer:window");
  return {};
}

Outcome<ConfigLines> readConfig(CLI::App& play, const std::string& path, FileConfig& config) {
  auto read = loadConfig(path);
  if (!read) return std::unexpected(read.error());
  config = std::move(*read);
  return play.parsed() ? applyConfig(play, config) : ConfigLines{};
}

Outcome<void> settlePlay(PlayOptions& play) {
  if (play.print_keys || play.print_states) return {};
  play.player.stays = !play.control_path.empty();
  if (play.player.source.url.empty() && !play.player.stays) {
    return failOn("SOURCE", {ErrorCode::InvalidArgument, 0,
                             "is missing; name a film, or with --control a socket to be told one; see relievo play "
                             "--help"});
  }
  return settleWindow(play);
}

}  // namespace

std::expected<Options, int> parseOptions(int argc, const char* const* argv, const DeviceNames& names) {
  Options options;
  std::string config_path;
  bool print_config = false;
  CLI::App program(kAbout, "relievo");
  program.footer(kProgramFooter);
  program.require_subcommand(1);
  CLI::App& play = *program.add_subcommand("play", "Play a film: shown in stereo, felt by the finger");
  CLI::App& probe = *program.add_subcommand("probe", "Tell what is in a source, and what it needs");
  CLI::App& devices = *program.add_subcommand("devices", "Tell what hardware is there, and why a thing is refused");
  CLI::App& self_test = *program.add_subcommand("selftest", "Tell whether it works here, without any hardware");
  self_test.footer(kSelfTestFooter);
  CLI::App& calibrate = *devices.add_subcommand("calibrate", "Find out how strong the Falcon is, with a spring scale");
  addPlayOptions(play, options.play, names);
  addConfigOption(play, config_path);
  play.add_flag("--print-config", print_config,
                "Print what would be in use, as a configuration, and where each value is from")
      ->configurable(false);
  addSourceOptions(probe, options.probe.source)->required();
  probe.add_flag("--json", options.probe.json, "For programs");
  probe.footer(kProbeFooter);
  addConfigOption(devices, config_path);
  devices.footer(kDevicesFooter);
  calibrate.fallthrough();  // --config may come after it
  calibrate.footer(kCalibrateFooter);

  if (auto parsed = parseCommandLine(program, argc, argv); !parsed) return std::unexpected(parsed.error());
  options.command = probe.parsed()       ? Options::Command::Probe
                    : devices.parsed()   ? Options::Command::Devices
                    : self_test.parsed() ? Options::Command::SelfTest
                                         : Options::Command::Play;
  options.calibrate = calibrate.parsed();
  if (probe.parsed() || self_test.parsed()) return options;

  const auto lines = readConfig(play, config_path, options.config);
  if (!lines) return std::unexpected(tell(lines.error()));
  if (print_config) {
    std::fputs(configText(play, options.config, *lines).c_str(), stdout);
    return std::unexpected(kExitDone);
  }
  if (play.parsed()) {
    if (auto settled = settlePlay(options.play); !settled) return std::unexpected(tell(settled.error()));
  }
  return options;
}

}  // namespace relievo
