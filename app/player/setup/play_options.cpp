// SPDX-License-Identifier: Apache-2.0
// The options of `relievo play`, for CLI11.
#include "app/player/setup/play_options.h"

#include <algorithm>
#include <array>
#include <span>
#include <sstream>
#include <vector>

#include "app/cli/options.h"
#include "app/media/folder/picture_series.h"
#include "app/media/playlist.h"
#include "app/player/control/key_table.h"
#include "app/player/screen/stereo_word.h"
#include "app/player/setup/help_texts.h"
#include "hal/haptic_rate.h"
#include "platform/print.h"
#include "platform/text/lower_case.h"
#include "platform/text/number_in.h"

namespace relievo {
namespace {

constexpr double kLongestDurationS = 1e9;
constexpr int kMostPixels = 16384;           // of a display, across and down
constexpr int kMostOfDisplay = 8192 * 8192;  // pixels in all: a quilt of the largest screens
constexpr const char* kNoSize =
    "a size is WIDTHxHEIGHT in pixels, each from 1 to 16384 and 67 million in all, such as 1280x720";
constexpr const char* kStereoHelp =
    "How the picture is shown\n"
    "mono: one picture; sbs, tab: left and right eye side by side, or one above the other,\n"
    "each squeezed by half; sbs:full, tab:full: each in its full aspect ratio; rows, columns: line by line;\n"
    "anaglyph[:gray|color]: for red-cyan glasses; frame-packing: HDMI 3D; quilt[:COLSxROWS]: many views [8x6]";
constexpr const char* kLayouts =
    "mono sbs[:full] tab[:full] rows columns anaglyph[:gray|color] frame-packing quilt[:COLSxROWS]";
constexpr const char* kNoTime = "a time is seconds, M:SS or H:MM:SS, such as 90 or 1:30";
constexpr const char* kNoDuration = "a duration is more than 0 and at most a billion seconds";

void addSources(CLI::App& command, PlayOptions& play) {
  const auto take = [&player = play.player](std::vector<std::string> sources) {
    for (std::string& source : sources) source = source == "-" ? "/dev/stdin" : sourceNamed(source);
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
  std::array<int, 2> size{};
  if (!readNumbers(word, 'x', std::span(size)) || std::min(size[0], size[1]) < 1 ||
      std::max(size[0], size[1]) > kMostPixels || size[0] * size[1] > kMostOfDisplay) {
    throw WordFailure({"--size " + word, {ErrorCode::InvalidArgument, 0, kNoSize}});
  }
  return {.width = size[0], .height = size[1]};
}

Duration readDuration(double seconds) {
  if (!(seconds > 0 && seconds <= kLongestDurationS)) {
    throw WordFailure({print("--duration %g", seconds), {ErrorCode::InvalidArgument, 0, kNoDuration}});
  }
  return fromSeconds(seconds);
}

MediaTime readTime(const std::string& word) {
  double seconds = 0;
  const std::string text = word.ends_with(':') ? "" : word;  // else the last part would be missing, not wrong
  std::istringstream parts(text);
  int count = 0;
  for (std::string part; std::getline(parts, part, ':'); ++count) {
    double number = -1;
    const bool good = CLI::detail::lexical_cast(part, number) && number >= 0 && number <= kLongestDurationS;
    if (!good || count == 3) throw WordFailure({"--start " + word, {ErrorCode::InvalidArgument, 0, kNoTime}});
    seconds = 60 * seconds + number;
  }
  if (count == 0) throw WordFailure({"--start " + word, {ErrorCode::InvalidArgument, 0, kNoTime}});
  return mediaTime(seconds);
}

BackEndName nameOf(const std::string& given) {
  BackEndName name = given;
  name.word = lowerCase(name.word);
  return name;
}

// An option that names a back end. Its word is one of `names`: those stand parted by spaces, each with what may follow
// it in brackets or behind a colon. `second`: it may be given twice; null: once.
CLI::Option* addBackEnd(CLI::App& command, const char* option, BackEndName& chosen, const char* kind, const char* names,
                        const char* help, BackEndName* second = nullptr) {
  const auto judge = [kind, names](const std::string& given) -> std::string {
    const std::string word = lowerCase(BackEndName(given).word);
    std::istringstream all(names);
    std::vector<std::string> words;
    for (std::string known; all >> known;) {
      words.push_back(known.substr(0, known.find_first_of(":[")));
      if (words.back() == word) return "";
    }
    return given + ": no such " + kind + "; it is one of: " + names + meant(word, words);
  };
  const auto take = [option, second, &chosen](const std::vector<std::string>& given) {
    if (given.size() > (second != nullptr ? 2U : 1U)) {
      throw WordFailure({option + (" " + given.back()),
                         {ErrorCode::InvalidArgument, 0, "is one device too many; see relievo play --help"}});
    }
    chosen = nameOf(given.front());
    if (given.size() > 1) *second = nameOf(given.back());
  };
  return command.add_option_function<std::vector<std::string>>(option, take, std::string(help) + "\n" + names)
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false)
      ->default_str(chosen.text())
      ->check(CLI::Validator(judge, ""))
      ->type_name("NAME");
}

void addStereoOptions(CLI::App& command, StereoSettings& stereo) {
  const auto readStereo = [&stereo](const std::string& word) {
    static const std::vector<std::string> kWords{
        "mono",     "sbs",           "sbs:full",       "tab",           "tab:full", "rows", "columns",
        "anaglyph", "anaglyph:gray", "anaglyph:color", "frame-packing", "quilt"};
    if (parseStereo(lowerCase(word), stereo)) return;
    throw CLI::ValidationError("--stereo " + word,
                               print("no such layout; it is one of: %s", kLayouts) + meant(word, kWords));
  };
  command.add_option_function<std::string>("--stereo", readStereo, kStereoHelp)
      ->type_name("mono|sbs|tab|rows|columns|anaglyph|frame-packing|quilt")
      ->default_str(stereoWord(stereo));
  command.add_flag("--swap-eyes", stereo.swap_eyes, "Exchange the pictures of the two eyes");
  command
      .add_option(
          "--depth-strength", stereo.strength,
          "Strength of the 3D effect, seen and not felt: 0 is flat, 1 is for the real distance between the eyes")
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
    if (lowerCase(word) == name) return signal;
  }
  static const std::vector<std::string> kWords{"frame-packing", "tab", "sbs", "off"};
  throw CLI::ValidationError("--tv-signal " + word,
                             "no such signal; it is one of: frame-packing tab sbs off" + meant(word, kWords));
}

void addSignalOption(CLI::App& command, std::optional<StereoSignal>& signal) {
  command
      .add_option_function<std::string>(
          "--tv-signal", [&signal](const std::string& word) { signal = readSignal(word); },
          "The 3D signal sent to a television (kms); the two pictures are laid out to match it. If the television does "
          "not\nsupport it, the best supported one is sent; if it supports none, the layout is that of --stereo.\noff: "
          "no signal [the one of --stereo, if it has one]")
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
      .add_option(
          "--slang", player.source.subtitle_languages,
          "Subtitles in the first of these languages that the film has [those beside the film, first in the desktop's "
          "language,\nor its default ones]")
      ->type_name("LANG,..");
}

void addTouchOptions(CLI::App& command, PlayOptions& play, const DeviceNames& names) {
  addBackEnd(
      command, "--haptic", play.haptic, "haptic device", names.haptic,
      "The haptic device; give it twice to feel with two fingers: the first one's mark is amber where it\ntouches, the "
      "second's blue [the device that is plugged in, else the mouse; off screen sim]",
      &play.second_haptic);
  command
      .add_option("--rate", play.rate_hz,
                  "Ticks of touch per second, 500 to 8000; a slower device runs at its fastest rate [the device's own, "
                  "mostly 1000]")
      ->check(between(kLeastRateHz, kMostRateHz))
      ->type_name("HZ");
}

// What is printed, written or listened to.
void addFileOptions(CLI::App& command, PlayOptions& play) {
  command.add_option("--keys", play.keys_path, "A table of keys of your own (see --print-keys) [the usual keys]")
      ->type_name("FILE");
  command.add_flag("--print-keys", play.print_keys, "Print the table of keys, as a start for one of your own")
      ->configurable(false);
  command
      .add_flag("--print-states", play.print_states, "Print the player's states as a drawing: | dot -Tsvg > states.svg")
      ->configurable(false);
  command.add_flag("-v,--verbose", play.verbose, "Print more: the source of each depth value, figures of the ticks")
      ->configurable(false);
  command.add_option("--report", play.report_path, "Write states, faults and figures of the run, as JSON")
      ->type_name("FILE");
  command.add_option("--record", play.record_path, "Write every tick of the finger, as CSV")->type_name("FILE");
  command
      .add_option("--control", play.control_path,
                  "Take commands from programs on this socket, one JSON object per line; after SOURCE, or without it, "
                  "wait for the\nnext film, until a program sends quit")
      ->type_name("SOCKET");
}

}  // namespace

void addDepthSource(CLI::App& command, SourceOptions& source) {
  command
      .add_option(
          "--depth", source.depth_url,
          "A second file or address that holds the depth [one beside the film, as film-depth.mkv, if there is one]")
      ->transform(sourceNamed)
      ->type_name("SOURCE2");
  addDepthOptions(command, source);
  addMaterialOption(command, source);
  addRateOption(command, source);
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
          "Pixels of the picture [a window: the film's; else 1280x720]; kms: a mode of the screen, else its "
          "preferred\none")
      ->type_name("WxH");
  addStereoOptions(command, play.player.stereo);
  addSignalOption(command, play.tv_signal);
  addTouchOptions(command, play, names);
  addBackEnd(command, "--remote", play.remote, "remote", names.remote,
             "Where keys come from [a window: it and the terminal; a whole screen: evdev, all remote controls; else "
             "keys: the terminal's]");
  addBackEnd(command, "--audio", play.audio, "sound output", names.audio,
             "Where the sound goes [with a window or a whole screen alsa, else none]");
  CLI::Option* const decoder = addBackEnd(
      command, "--decoder", play.decoder, "decoder", names.decoder,
      "The decoder of the picture; FFmpeg takes over what it cannot decode [the video hardware, else ffmpeg]");
  command.add_flag("--software", play.software, "Decode without the video hardware, for hardware that shows faults")
      ->excludes(decoder);
  addBoxOption(command, play.player.volume);
  addSoundAndTextOptions(command, play.player);
  command.add_flag("--fs", play.player.full_screen, "A window fills the screen from the beginning");
  command.add_flag("--osd", play.osd, "Show bar, keys and notices over an off-screen picture, too");
  command
      .add_option_function<std::string>(
          "--start", [&play](const std::string& word) { play.player.start = readTime(word); },
          "Begin the first film at this time: seconds, M:SS or H:MM:SS")
      ->type_name("TIME");
  command.add_flag("--loop", play.player.loop, "Repeat from the beginning at the end");
  command
      .add_option_function<double>(
          "--duration", [&play](double seconds) { play.player.duration = readDuration(seconds); },
          "Stop after so many seconds")
      ->type_name("S");
  command.add_flag("--resume", play.resume, "Resume the film where it was left, and remember where it is left");
  command
      .add_option(
          "--films", play.films,
          "Without SOURCE, in a window and on a screen: choose from the films of this folder (again for more),\n"
          "those on USB sticks, and those seen lately; remembers where each is left [the folder Videos]")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  command
      .add_flag("--from-desktop", play.from_desktop,
                "For a desktop's menu, whose terminal nobody sees: a window that can play no film says why in the list "
                "of films,\nand a message box what ends the program before")
      ->configurable(false);
  addFileOptions(command, play);
  answerOptionsOfOthers(command);
  command.footer(kPlayFooter + KeyTable::usual().help() + kExitCodes);
}

}  // namespace relievo
