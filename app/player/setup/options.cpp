// SPDX-License-Identifier: Apache-2.0
// Declares the options for CLI11 and turns their words into values.
#include "app/player/setup/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/program.h"
#include "app/media/film_folder.h"
#include "app/player/control/key_table.h"
#include "app/player/screen/stereo_word.h"
#include "app/player/setup/back_end_option.h"
#include "app/player/setup/config_options.h"
#include "app/player/setup/first_word.h"
#include "app/player/setup/settle_play.h"
#include "hal/haptic_rate.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kAbout =
    "relievo: 3D video you can touch. Plays colour + depth video; a force-feedback device feels its relief.\n";
constexpr const char* kProgramAbout =
    "\n  relievo film.mkv          plays it: in a window on a desktop, else on the screen\n"
    "  relievo help COMMAND      tells what a command takes; `relievo help play` begins with what people do most\n";
constexpr const char* kProgramFooter =
    "\nExamples:\n"
    "  relievo film.mkv                               in a window; press into the picture with the mouse to feel it\n"
    "  relievo probe scan.mov --packing tb --depth-code hue\n"
    "                                                 what is in it: colour on top, depth as hue below\n"
    "  relievo devices                                what hardware is there, and why a thing is refused\n"
    "  relievo selftest                               whether it works here, without any hardware\n"
    "\nA file that is named like a command is reached by its path, as ./play. `relievo-author --help` tells how to "
    "make "
    "a film.\n";
constexpr const char* kPlayAbout =
    "Play a film: shown in stereo, felt by the finger\n"
    "\n  relievo film.mkv                         in a window; press into the picture with the mouse to feel it\n"
    "  relievo one.mkv two.mkv films/           one film after the other, and those of a folder; --loop: again and "
    "again\n"
    "  relievo color.mp4 --depth depth.mkv      colour and depth are two files\n"
    "  relievo scan.mov --packing tb            colour on top, depth below in one picture; sbs: side by side\n"
    "  relievo film.mkv --stereo anaglyph       for red-cyan glasses; sbs, tab: for a 3D screen\n"
    "  relievo film.mkv --display kms           on a whole screen without a desktop\n"
    "  relievo film.mkv --haptic falcon         felt with a force-feedback device; with a second --haptic, by two\n"
    "  relievo film.mkv --resume                from where it was left\n"
    "  relievo                                  a list of films to choose from; --films FOLDER: those of a folder\n"
    "  relievo https://example.org/film.m3u8    from the network\n"
    "  relievo film-3d.mkv --depth-from stereo  a 3D film that has two views and no depth, felt\n"
    "  relievo v4l2:/dev/video0 --calibration near=400,far=1500\n"
    "                                           a depth camera, live\n"
    "\nKeys: space pauses, arrows seek, f fills the screen, h shows all keys, q ends it.";
constexpr const char* kProbeFooter =
    "\nExamples:\n"
    "  relievo probe film.mkv                         its tracks, what its depth means, what a finger will feel of it\n"
    "  relievo probe color.webm --depth depth.webm    two files\n"
    "  relievo probe --json film.mkv                  for programs\n"
    "\nWhat it tells: tracks; `meaning`: each value of the calibration and who said it; `relief`: the codes and "
    "heights in\n"
    "use; `touch`: the widths that the finger will feel the relief through, and the error that is left; `needs`: what "
    "the\n"
    "film asks for or lacks, and the option to try. Exit code: 0 done, 1 failed at run time, 2 usage error.\n";
constexpr const char* kPlayFooter =
    "\nExamples:\n"
    "  relievo color.webm --depth depth.webm --display offscreen --report run.json\n"
    "      two files, shown off screen, touched by the simulated hand; the figures go to run.json\n"
    "  relievo play scan.mov --packing tb --depth-code hue --stereo anaglyph --loop --duration 60\n"
    "      one file with colour on top and depth as hue below, for red-cyan glasses, again and again for a minute\n"
    "  relievo play film.mkv --display offscreen:film.y4m --haptic sim:hand.csv --remote script:keys.txt\n"
    "      the picture into a file that ffmpeg reads, finger and keys by scripts\n"
    "  relievo play film.mkv --display kms --size 1920x1080 --haptic falcon\n"
    "      on a whole screen of the box, without a desktop\n"
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
    "bad, 1 something is, 2 usage error.\n";
constexpr const char* kExitCodes = "\nExit code: 0 done, 1 failed at run time, 2 usage error.\n";

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

constexpr const char* kSourceHelp =
    "A film, a folder of films or pictures, pictures (\"a/%06d.png\", \"a/*.png\"), associations.txt, a playlist, or "
    "an "
    "address: http, https (HLS as well), rtsp, rtp, udp, tcp; v4l2:DEVICE; mock:, which needs no file";

void addDepthSource(CLI::App& command, SourceOptions& source) {
  command
      .add_option(
          "--depth", source.depth_url,
          "A second file or address that holds the depth [one beside the film, as film-depth.mkv, if there is one]")
      ->type_name("SOURCE2");
  addDepthOptions(command, source);
  addMaterialOption(command, source);
  addRateOption(command, source);
}

void addSources(CLI::App& command, PlayOptions& play) {
  const auto take = [&player = play.player](const std::vector<std::string>& sources) {
    if (auto series = seriesOf(sources)) {
      player.source.url = std::move(*series);
      return;
    }
    player.source.url = sources.front();
    player.more.assign(sources.begin() + 1, sources.end());
  };
  command.add_option_function<std::vector<std::string>>("SOURCE", take, kSourceHelp)->type_name(" ");
  addDepthSource(command, play.player.source);
  addChoice(
      command, "--depth-from", play.player.source.depth_from, {{"film", DepthFrom::Film}, {"stereo", DepthFrom::Views}},
      "Where the depth comes from\n"
      "film: the film has it; stereo: it is made from a 3D film's two views while they play; the picture is then the "
      "left view\nin relief. `relievo-author --depth-from stereo` takes longer and makes better depth");
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
    throw WordFailure({print("--duration %g", seconds), {ErrorCode::InvalidArgument, 0, kNoDuration}});
  }
  return fromSeconds(seconds);
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
    if (!parseStereo(inSmallLetters(word), stereo))
      throw WordFailure({"--stereo " + word, {ErrorCode::InvalidArgument, 0, kNoStereo}});
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

StereoSignal readSignal(const std::string& word) {
  const std::pair<const char*, StereoSignal> signals[] = {{"frame-packing", StereoSignal::FramePacking},
                                                          {"tab", StereoSignal::TopAndBottom},
                                                          {"sbs", StereoSignal::SideBySideHalf},
                                                          {"off", StereoSignal::None}};
  for (const auto& [name, signal] : signals) {
    if (inSmallLetters(word) == name) return signal;
  }
  throw WordFailure({"--tv-signal " + word,
                     {ErrorCode::InvalidArgument, 0, "no such signal; it is one of: frame-packing tab sbs off"}});
}

void addSignalOption(CLI::App& command, std::optional<StereoSignal>& signal) {
  command
      .add_option_function<std::string>(
          "--tv-signal", [&signal](const std::string& word) { signal = readSignal(word); },
          "The 3D signal that tells a television how the two pictures lie (kms); they are laid out for it. If the "
          "television\ndoes not take this signal, it is sent the best that it takes; if it takes none, the layout is "
          "that of --stereo.\noff: no signal [the one of --stereo, if it has one]")
      ->type_name("frame-packing|tab|sbs|off");
}

void addSoundAndTextOptions(CLI::App& command, PlayerConfig& player) {
  command
      .add_option("--volume", player.volume_percent,
                  "Loudness, in percent [as it was left on this sound output, else 100]")
      ->check(between(0.0, Loudness::kMostPercent))
      ->type_name("P");
  command
      .add_option("--alang", player.source.sound_languages,
                  "Sound in the first of these languages that the film has, such as jpn,en")
      ->type_name("LANG,..");
  command
      .add_option("--slang", player.source.subtitle_languages,
                  "Subtitles likewise [those beside the film, or that it marks as its default]")
      ->type_name("LANG,..");
}

void addTouchOptions(CLI::App& command, PlayOptions& play, const DeviceNames& names) {
  addBackEnd(
      command, "--haptic", play.haptic, "haptic device", names.haptic,
      "What the finger holds; given twice: what two fingers hold, each in a colour of its own [the device that\nis "
      "plugged in, else the mouse; off screen sim]",
      &play.second_haptic);
  command
      .add_option("--rate", play.rate_hz,
                  "Ticks of touch per second, 500 to 8000; a device that cannot runs at its best [the device's own, "
                  "mostly 1000]")
      ->check(between(kLeastRateHz, kMostRateHz))
      ->type_name("HZ");
}

// What is printed, written or listened to.
void addFileOptions(CLI::App& command, PlayOptions& play) {
  command.add_option("--keys", play.keys_path, "Which key means what (see --print-keys) [the usual]")
      ->type_name("FILE");
  command.add_flag("--print-keys", play.print_keys, "Print the table of keys, to begin one of your own from")
      ->configurable(false);
  command
      .add_flag("--print-states", play.print_states, "Print the player's states as a drawing: | dot -Tsvg > states.svg")
      ->configurable(false);
  command
      .add_flag("-v,--verbose", play.verbose, "Say more: where each value of the depth is from, figures of the ticks")
      ->configurable(false);
  command.add_option("--report", play.report_path, "Write what happened, as JSON")->type_name("FILE");
  command.add_option("--record", play.record_path, "Write every tick of the finger, as CSV")->type_name("FILE");
  command
      .add_option(
          "--control", play.control_path,
          "Listen there for commands of programs, one JSON object a line; after SOURCE, or without, wait for the next\n"
          "film, until one says quit")
      ->type_name("SOCKET");
}

void addPlayOptions(CLI::App& command, PlayOptions& play, const DeviceNames& names) {
  play.player.stereo.layout = StereoLayout::Mono;
  play.player.display.film_size = true;
  addSources(command, play);
  addBackEnd(command, "--display", play.display, "display", names.display,
             "Where the picture goes [a window on a desktop, else the screen, else off screen]");
  command
      .add_option_function<std::string>(
          "--size", [&play](const std::string& word) { play.player.display = readSize(word); },
          "Pixels of the picture [a window: the film's; else 1280x720]; of kms a mode that the screen has, else its\n"
          "favourite")
      ->type_name("WxH");
  addStereoOptions(command, play.player.stereo);
  addSignalOption(command, play.tv_signal);
  addTouchOptions(command, play, names);
  addBackEnd(
      command, "--remote", play.remote, "remote", names.remote,
      "Where keys come from [of a window its own and the terminal's; of a screen evdev, all remote controls; else "
      "keys, the terminal's]");
  addBackEnd(command, "--audio", play.audio, "sound output", names.audio,
             "Where the sound goes [of a window or a whole screen alsa, else none]");
  CLI::Option* const decoder =
      addBackEnd(command, "--decoder", play.decoder, "decoder", names.decoder,
                 "What decodes the picture; where it cannot, FFmpeg does [the video hardware, else ffmpeg]");
  command.add_flag("--software", play.software, "Decode without the video hardware, where that shows faults")
      ->excludes(decoder);
  addBoxOption(command, play.player.volume);
  addSoundAndTextOptions(command, play.player);
  command.add_flag("--osd", play.osd, "Write bar, keys and notices over an off-screen picture too");
  command.add_flag("--loop", play.player.loop, "Begin again at the end");
  command
      .add_option_function<double>(
          "--duration", [&play](double seconds) { play.player.duration = readDuration(seconds); },
          "Stop after so many seconds")
      ->type_name("S");
  command.add_flag("--resume", play.resume, "Begin where the film was left, and remember where it is left");
  command
      .add_option(
          "--films", play.films,
          "Without SOURCE, in a window and on a screen: choose from the films of this folder (again for more),\n"
          "those on USB sticks, and those seen lately; remembers where each is left [the folder Videos]")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  addFileOptions(command, play);
  command.footer(kPlayFooter + KeyTable::usual().help() + kExitCodes);
}

Outcome<ConfigLines> readConfig(CLI::App& play, const std::string& path, FileConfig& config) {
  auto read = loadConfig(path);
  if (!read) return std::unexpected(read.error());
  config = std::move(*read);
  return play.parsed() ? applyConfig(play, config) : ConfigLines{};
}

}  // namespace

std::expected<Options, int> parseOptions(int argc, const char* const* argv, const DeviceNames& names,
                                         const Machine& machine) {
  Options options;
  std::string config_path;
  bool print_config = false;
  CLI::App program(std::string(kAbout) + kProgramAbout, "relievo");
  program.footer(kProgramFooter);
  program.require_subcommand(1);
  CLI::App& play = *program.add_subcommand("play", kPlayAbout);
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
  probe.add_option("SOURCE", options.probe.source.url, kSourceHelp)->type_name(" ")->required();
  addDepthSource(probe, options.probe.source);
  probe.add_flag("--json", options.probe.json, "For programs");
  probe.footer(kProbeFooter);
  addConfigOption(devices, config_path);
  devices.footer(kDevicesFooter);
  calibrate.fallthrough();  // --config may come after it
  calibrate.footer(kCalibrateFooter);

  const auto words = withCommand(program, argc, argv);
  const std::string first = argc > 1 ? argv[1] : "";
  if (auto spelt = refuseMisspeltCommand(program, first); !spelt) return std::unexpected(tell(spelt.error()));
  if (auto parsed = parseCommandLine(program, static_cast<int>(words.size()), words.data()); !parsed) {
    return std::unexpected(parsed.error());
  }
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
    if (auto settled = settlePlay(options.play, machine); !settled) return std::unexpected(tell(settled.error()));
  }
  return options;
}

}  // namespace relievo
