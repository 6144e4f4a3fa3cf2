// SPDX-License-Identifier: Apache-2.0
// Words of the command line to values; wrong words to exit code 2 and one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/player/setup/options.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Parsed {
  std::expected<Options, int> options;
  std::string out, err;
};

Parsed parse(const std::vector<const char*>& arguments, const Machine& machine = {}) {
  std::vector<const char*> words{"relievo"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  auto options =
      parseOptions(static_cast<int>(words.size()), words.data(),
                   {"kms[:CARD] window offscreen[:FILE] mock", "falcon sim[:HAND] pointer replay:FILE mock none",
                    "evdev keys window script:FILE none", "alsa[:DEVICE] null none", "v4l2 gstreamer[:ELEMENT] ffmpeg"},
                   machine);
  std::string out = testing::internal::GetCapturedStdout();
  std::string err = testing::internal::GetCapturedStderr();
  return {std::move(options), std::move(out), std::move(err)};
}

void expectRefused(const std::vector<const char*>& words, const char* part) {
  const Parsed parsed = parse(words);
  ASSERT_FALSE(parsed.options) << (words.empty() ? "" : words.back());
  EXPECT_EQ(parsed.options.error(), 2);
  EXPECT_THAT(parsed.err, StartsWith("relievo: "));
  EXPECT_THAT(parsed.err, HasSubstr(part));
  EXPECT_EQ(std::count(parsed.err.begin(), parsed.err.end(), '\n'), 1) << parsed.err;
}

Machine machineWith(bool desktop, bool screen, const std::string& haptic = "", bool terminal = false) {
  return {.desktop = [=] { return desktop; },
          .screen = [=] { return screen; },
          .haptic = [=] { return haptic; },
          .terminal = [=] { return terminal; }};
}

std::string devicesOf(const PlayOptions& play) {
  return play.display.text() + " " + play.haptic.text() + " " + play.remote.text() + " " + play.audio.text();
}

TEST(Options, WithoutADesktopOrAScreenItPlaysOffScreenAndSaysSo) {
  const Parsed parsed = parse({"play", "film.mkv"});
  ASSERT_TRUE(parsed.options);
  const PlayOptions& play = parsed.options->play;
  EXPECT_EQ(play.player.source.url, "film.mkv");
  EXPECT_EQ(play.player.source.packing, Packing::Auto);
  EXPECT_EQ(play.player.source.depth_code, std::nullopt);
  EXPECT_EQ(play.player.stereo.layout, StereoLayout::Mono);
  EXPECT_EQ(devicesOf(play), "offscreen sim none none");
  EXPECT_EQ(play.player.display.width, 1280);
  EXPECT_EQ(play.player.display.height, 720);
  EXPECT_FALSE(play.player.duration);
  EXPECT_FALSE(play.player.volume);
  EXPECT_FALSE(play.player.loop);
  EXPECT_TRUE(play.player.own_threads);
  EXPECT_THAT(parsed.err, HasSubstr("there is no desktop and no screen here: it plays off screen"));
  EXPECT_EQ(std::count(parsed.err.begin(), parsed.err.end(), '\n'), 1) << parsed.err;
  EXPECT_EQ(parse({"play", "film.mkv", "--display", "offscreen"}).err, "");
  EXPECT_EQ(parse({"film.mkv"}, machineWith(false, false, "", true)).options->play.remote, "keys");
}

TEST(Options, OnADesktopItTakesAWindowOfTheFilmsSizeAndTheMouse) {
  const Parsed parsed = parse({"film.mkv"}, machineWith(true, true));
  ASSERT_TRUE(parsed.options) << parsed.err;
  EXPECT_EQ(parsed.err, "");
  EXPECT_EQ(devicesOf(parsed.options->play), "window pointer:window window alsa");
  EXPECT_TRUE(parsed.options->play.player.display.film_size);
  EXPECT_FALSE(
      parse({"film.mkv", "--size", "640x360"}, machineWith(true, true)).options->play.player.display.film_size);
}

TEST(Options, TheWindowOfTheListFitsTheDesktopUnlessASizeIsAskedFor) {
  const auto fits = [](const std::vector<const char*>& words) {
    return parse(words, machineWith(true, true)).options->play.player.display.fits_desktop;
  };
  EXPECT_TRUE(fits({}));
  EXPECT_TRUE(fits({"play", "--films", "/films"}));
  EXPECT_FALSE(fits({"play", "--size", "1280x720"}));
  EXPECT_FALSE(fits({"film.mkv"})) << "it takes the film's size";
}

TEST(Options, WithoutAFilmAWindowAndAScreenShowTheListOfFilms) {
  ::setenv("HOME", "/home/anna", 1);
  ::unsetenv("XDG_VIDEOS_DIR");
  const auto folders = [](const Machine& machine, const std::vector<const char*>& words) {
    const Parsed parsed = parse(words, machine);
    if (!parsed.options || !parsed.options->play.player.browser) return std::vector<std::string>{"no list"};
    return parsed.options->play.player.browser->folders;
  };
  const std::vector<std::string> none{"no list"};
  EXPECT_EQ(folders(machineWith(true, false), {}), (std::vector<std::string>{"/home/anna/Videos"}));
  EXPECT_EQ(folders(machineWith(false, true), {"play"}), (std::vector<std::string>{"/home/anna/Videos"}));
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "--films", "/b"}),
            (std::vector<std::string>{"/a", "/b"}));
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "film.mkv"}), none) << "it has its film";
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "film.mkv", "--control", "/run/r"}),
            (std::vector<std::string>{"/a"}))
      << "a box shows it after its film";
  EXPECT_EQ(folders(machineWith(false, false), {"--control", "/run/r"}), none) << "nobody sees it";
}

TEST(Options, WithoutADesktopItTakesTheScreen) {
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(false, true)).options->play), "kms pointer evdev alsa");
}

TEST(Options, AForceFeedbackDeviceThatIsPluggedInGoesBeforeTheMouse) {
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(true, true, "falcon")).options->play),
            "window falcon window alsa");
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(false, true, "polhem")).options->play), "kms polhem evdev alsa");
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(false, false, "falcon")).options->play),
            "offscreen sim none none");
}

TEST(Options, WhatIsNamedIsNotLookedFor) {
  const Machine nobody{.desktop =
                           [] {
                             ADD_FAILURE();
                             return true;
                           },
                       .screen =
                           [] {
                             ADD_FAILURE();
                             return true;
                           },
                       .haptic =
                           [] {
                             ADD_FAILURE();
                             return std::string("falcon");
                           },
                       .terminal =
                           [] {
                             ADD_FAILURE();
                             return true;
                           }};
  EXPECT_TRUE(parse({"film.mkv", "--display", "window", "--haptic", "none", "--remote", "none"}, nobody).options);
  EXPECT_TRUE(parse({"probe", "film.mkv"}, nobody).options);
  EXPECT_TRUE(parse({"play", "--print-keys"}, nobody).options);
}

TEST(Options, AFirstWordThatIsNoCommandIsAFilm) {
  EXPECT_EQ(parse({"film.mkv"}).options->play.player.source.url, "film.mkv");
  EXPECT_EQ(parse({"--loop", "film.mkv"}).options->play.player.loop, true);
  EXPECT_EQ(parse({"./play"}).options->play.player.source.url, "./play");
  EXPECT_EQ(parse({"probe", "film.mkv"}).options->command, Options::Command::Probe);
  const Parsed three = parse({"a.mkv", "b.m3u", "--loop", "films/"});
  ASSERT_TRUE(three.options) << three.err;
  EXPECT_EQ(three.options->play.player.source.url, "a.mkv");
  EXPECT_EQ(three.options->play.player.more, (std::vector<std::string>{"b.m3u", "films/"}));
}

TEST(Options, HelpAndVersionAreAnsweredEverywhere) {
  for (const std::vector<const char*>& words : {std::vector<const char*>{"help"}, {"--help"}, {"-h"}}) {
    EXPECT_THAT(parse(words).out, HasSubstr("relievo film.mkv")) << words[0];
  }
  EXPECT_EQ(parse({"help", "play"}).out, parse({"play", "--help"}).out);
  EXPECT_EQ(parse({"play", "help"}).out, parse({"play", "--help"}).out);
  EXPECT_EQ(parse({"help", "devices"}).out, parse({"devices", "--help"}).out);
  const std::string version = parse({"--version"}).out;
  EXPECT_THAT(version, StartsWith("relievo "));
  for (const std::vector<const char*>& words : {std::vector<const char*>{"-v"},
                                                {"-V"},
                                                {"play", "--version"},
                                                {"film.mkv", "--version"},
                                                {"probe", "-V"},
                                                {"devices", "--version"}}) {
    const Parsed parsed = parse(words);
    EXPECT_EQ(parsed.out, version) << words[0];
    EXPECT_TRUE(!parsed.options && parsed.options.error() == 0);
  }
  EXPECT_TRUE(parse({"film.mkv", "-v"}).options->play.verbose);
}

TEST(Options, TakeAnyCase) {
  const Parsed parsed = parse({"film.mkv", "--display", "OffScreen:A.y4m", "--stereo", "SBS:Full", "--haptic", "None",
                               "--packing", "TB", "--depth-code", "HUE", "--calibration", "Law=Inverse,near=3,FAR=40"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  const PlayOptions& play = parsed.options->play;
  EXPECT_EQ(play.display, "offscreen:A.y4m") << "a file's name keeps its case";
  EXPECT_EQ(play.haptic, "none");
  EXPECT_EQ(play.player.stereo.layout, StereoLayout::SideBySide);
  EXPECT_TRUE(play.player.stereo.full);
  EXPECT_EQ(play.player.source.packing, Packing::TopBottom);
  EXPECT_EQ(play.player.source.depth_code, DepthCode::Hue);
  EXPECT_EQ(play.player.source.command_line.at("far"), "40");
}

TEST(Options, SayWhatWasMeant) {
  expectRefused({"film.mkv", "--sterio", "sbs"}, "--sterio: no such option; did you mean --stereo?");
  expectRefused({"film.mkv", "--full-screen"}, "--full-screen: no such option; see relievo play --help");
  expectRefused({"film.mkv", "--display", "windo"}, "did you mean window?");
  expectRefused({"film.mkv", "--packing", "trakcs"}, "did you mean tracks?");
  expectRefused({"probe", "film.mkv", "--jsn"}, "--jsn: no such option; did you mean --json?");
  expectRefused({"prob", "film.mkv"}, "prob (probe?): is neither a file nor a command");
  expectRefused({"devices", "calibrat"}, "calibrat: is one argument too many");
}

TEST(Options, TakeEveryWordOfPlay) {
  const Parsed parsed = parse({"play",         "scan.mov",   "--packing",     "tb",
                               "--depth-code", "hue",        "--calibration", "law=inverse,near=300,far=3000",
                               "--display",    "mock",       "--stereo",      "anaglyph",
                               "--haptic",     "none",       "--remote",      "script:keys.txt",
                               "--loop",       "--duration", "12.5",          "--report",
                               "r.json",       "--record",   "t.csv",         "--box",
                               "200x100.5x30", "--size",     "640x360"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  const PlayOptions& play = parsed.options->play;
  EXPECT_EQ(play.player.source.packing, Packing::TopBottom);
  EXPECT_EQ(play.player.source.depth_code, DepthCode::Hue);
  EXPECT_EQ(play.player.source.command_line.at("near"), "300");
  EXPECT_EQ(play.player.stereo.layout, StereoLayout::Anaglyph);
  EXPECT_EQ(play.remote, "script:keys.txt");
  EXPECT_TRUE(play.player.loop);
  EXPECT_EQ(play.player.duration, Duration(12'500'000'000));
  EXPECT_EQ(play.report_path, "r.json");
  EXPECT_EQ(play.record_path, "t.csv");
  ASSERT_TRUE(play.player.volume);
  EXPECT_EQ(play.player.volume->width_mm, 200);
  EXPECT_EQ(play.player.volume->height_mm, 100.5);
  EXPECT_EQ(play.player.volume->depth_mm, 30);
  EXPECT_EQ(play.player.display.width, 640);
  EXPECT_EQ(play.player.display.height, 360);
}

TEST(Options, TheRateOfTouchIsTheDevicesUnlessItIsAskedFor) {
  EXPECT_FALSE(parse({"film.mkv"}).options->play.rate_hz);
  for (const char* word : {"500", "1000", "8000"}) {
    EXPECT_EQ(parse({"film.mkv", "--rate", word}).options->play.rate_hz, std::stod(word));
  }
  for (const char* word : {"9000", "499", "0", "-1000", "nan", "fast"}) {
    expectRefused({"film.mkv", "--rate", word}, "--rate");
  }
}

TEST(Options, TheSignalForATelevisionIsThatOfTheLayoutOrTheOneAskedFor) {
  using enum StereoSignal;
  const struct {
    std::vector<const char*> words;
    StereoSignal signal;
    bool or_other;
  } cases[] = {{{}, None, false},
               {{"--stereo", "sbs"}, SideBySideHalf, false},
               {{"--stereo", "tab"}, TopAndBottom, false},
               {{"--stereo", "sbs:full"}, None, false},
               {{"--stereo", "rows"}, None, false},
               {{"--stereo", "frame-packing"}, FramePacking, true},
               {{"--tv-signal", "Frame-Packing"}, FramePacking, true},
               {{"--stereo", "frame-packing", "--tv-signal", "tab"}, TopAndBottom, true},
               {{"--stereo", "sbs", "--size", "1920x1080", "--tv-signal", "sbs"}, SideBySideHalf, true},
               {{"--stereo", "sbs", "--tv-signal", "off"}, None, false}};
  for (auto [words, signal, or_other] : cases) {
    words.insert(words.begin(), {"play", "film.mkv", "--display", "kms"});
    const DisplayConfig display = parse(words).options.value().play.player.display;
    EXPECT_EQ(display.stereo, signal) << words.back();
    EXPECT_EQ(display.other_stereo, or_other) << words.back();
  }
  expectRefused({"play", "film.mkv", "--tv-signal", "sbss"}, "did you mean sbs?");
  expectRefused({"play", "film.mkv", "--stereo", "SBSS"}, "did you mean sbs?");
  expectRefused({"play", "film.mkv", "--stereo", "anaglyph:grey"}, "did you mean anaglyph:gray?");
  expectRefused({"play", "film.mkv", "--as", "kiti"}, "did you mean kitti?");
  expectRefused({"play", "film.mkv", "--calibration", "lew=linear"}, "(law?)");
  expectRefused({"play", "film.mkv", "--calibration", "law=linea,near=1"}, "(linear?)");
  expectRefused({"play", "film.mkv", "--material", "stifness=1"}, "(stiffness?)");
  expectRefused({"play", "film.mkv", "--tv-signal", "holo"}, "it is one of: frame-packing tab sbs off");
}

TEST(Options, AWindowBringsItsKeysAndItsMouseAlong) {
  const auto parsedPlay = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"play", "film.mkv"});
    return parse(words).options.value().play;
  };
  EXPECT_EQ(parsedPlay({"--display", "window"}).remote, "window");
  EXPECT_EQ(parsedPlay({"--display", "kms"}).remote, "evdev");
  EXPECT_EQ(parsedPlay({"--display", "kms:/dev/dri/card1"}).remote, "evdev");
  EXPECT_EQ(parsedPlay({"--display", "kms", "--remote", "none"}).remote, "none");
  EXPECT_EQ(parsedPlay({"--display", "window"}).audio, "alsa");
  EXPECT_EQ(parsedPlay({"--display", "kms:/dev/dri/card1"}).audio, "alsa");
  EXPECT_EQ(parsedPlay({"--display", "window", "--audio", "none"}).audio, "none");
  EXPECT_EQ(parsedPlay({"--audio", "alsa:hdmi:CARD=vc4hdmi0"}).audio, "alsa:hdmi:CARD=vc4hdmi0");
  EXPECT_EQ(parsedPlay({"--decoder", "gstreamer:vah264dec"}).decoder, "gstreamer:vah264dec");
  EXPECT_EQ(parsedPlay({"--display", "window"}).haptic, "pointer:window");
  EXPECT_EQ(parsedPlay({"--display", "mock"}).haptic, "sim");
  EXPECT_EQ(parsedPlay({"--display", "window", "--haptic", "pointer"}).haptic, "pointer:window");
  EXPECT_EQ(parsedPlay({"--display", "window", "--haptic", "pointer:/dev/input/event3"}).haptic,
            "pointer:/dev/input/event3");
  EXPECT_EQ(parsedPlay({"--display", "window", "--remote", "none"}).remote, "none");
  EXPECT_EQ(parsedPlay({"--display", "window", "--remote", "window"}).remote, "window");
  EXPECT_EQ(parsedPlay({"--haptic", "pointer"}).haptic, "pointer");
  expectRefused({"play", "film.mkv", "--remote", "window"},
                "--remote window: there is no window; add --display window");
  expectRefused({"play", "film.mkv", "--haptic", "pointer:window"}, "--haptic pointer:window: there is no window");
}

TEST(Options, TakeADeviceForEachOfTwoFingers) {
  const auto parsedPlay = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"play", "film.mkv"});
    return parse(words).options.value().play;
  };
  const PlayOptions both = parsedPlay({"--haptic", "Sim:a.csv", "--haptic", "mock"});
  EXPECT_EQ(both.haptic, "sim:a.csv");
  EXPECT_EQ(both.second_haptic, "mock");
  EXPECT_EQ(parsedPlay({"--haptic", "sim"}).second_haptic, "");
  const PlayOptions window = parsedPlay({"--display", "window", "--haptic", "sim", "--haptic", "pointer"});
  EXPECT_EQ(window.second_haptic, "pointer:window");
  EXPECT_TRUE(window.player.mouse_touches);
  const PlayOptions one = parsedPlay({"--haptic", "none", "--haptic", "mock"});
  EXPECT_EQ(one.haptic, "mock") << "none beside a device is one finger";
  EXPECT_EQ(one.second_haptic, "");
  expectRefused({"play", "film.mkv", "--haptic", "mock", "--haptic", "sim", "--haptic", "none"},
                "--haptic none: is one device too many");
  expectRefused({"play", "film.mkv", "--haptic", "mock", "--haptic", "hand"}, "no such haptic device");
}

TEST(Options, TakeASourceAfterAnOption) {
  const Parsed parsed = parse({"probe", "--calibration", "near=100", "film.mkv", "--json"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  EXPECT_EQ(parsed.options->command, Options::Command::Probe);
  EXPECT_EQ(parsed.options->probe.source.url, "film.mkv");
  EXPECT_EQ(parsed.options->probe.source.command_line.at("near"), "100");
  EXPECT_TRUE(parsed.options->probe.json);
}

TEST(Options, TakeCalibrationsOneAfterTheOther) {
  const Parsed parsed =
      parse({"play", "film.mkv", "--calibration", "near=100,law=inverse", "--calibration", "near=200"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  const CalibrationSettings& settings = parsed.options->play.player.source.command_line;
  EXPECT_EQ(settings.at("law"), "inverse");
  EXPECT_EQ(settings.at("near"), "200");
}

TEST(Options, ReadAMaterial) {
  const Parsed parsed = parse({"play", "film.mkv", "--material", "Stiffness=.3,friction=.2/.15,texture=.1@.8"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  const Material& material = parsed.options->play.player.source.material;
  EXPECT_EQ(material.stiffness_n_per_mm, 0.3);
  EXPECT_EQ(material.friction, (Friction{0.2, 0.15}));
  EXPECT_EQ(material.texture, (Texture{0.1, 0.8}));
}

TEST(Options, ReadACalibrationFromAFileAsTheSideFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "camera.calibration";
  std::ofstream(path) << "# of the camera\nlaw = inverse\nnear = 250\n";
  const Parsed parsed = parse({"play", "film.mkv", "--calibration", path.c_str(), "--calibration", "far=900"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  EXPECT_EQ(parsed.options->play.player.source.side_file.at("near"), "250");
  EXPECT_EQ(parsed.options->play.player.source.command_line.at("far"), "900");
}

TEST(Options, RefuseWrongWordsInOneLine) {
  expectRefused({"play"}, "SOURCE");
  expectRefused({}, "name a film, as in relievo film.mkv");
  expectRefused({"play", "film.mkv", "--spin"}, "--spin");
  expectRefused({"play", "film.mkv", "--packing", "diagonal"}, "diagonal");
  expectRefused({"play", "film.mkv", "--stereo", "holo"}, "holo");
  expectRefused({"play", "film.mkv", "--duration", "-1"}, "duration");
  expectRefused({"play", "film.mkv", "--duration", "0"}, "duration");
  expectRefused({"play", "film.mkv", "--duration", "nan"}, "duration");
  expectRefused({"play", "film.mkv", "--duration", "soon"}, "duration");
  expectRefused({"play", "film.mkv", "--size", "640"}, "--size 640");
  expectRefused({"play", "film.mkv", "--size", "640x360x2"}, "--size");
  expectRefused({"play", "film.mkv", "--size", "0x360"}, "--size");
  expectRefused({"play", "film.mkv", "--size", "99999x360"}, "--size");
  expectRefused({"play", "film.mkv", "--box", "160x90"}, "--box");
  expectRefused({"play", "film.mkv", "--box", "160x90x-4"}, "--box");
  expectRefused({"play", "film.mkv", "--box", "160x90xnan"}, "--box");
  expectRefused({"play", "film.mkv", "--calibration", "colour=blue"}, "colour=blue");
  expectRefused({"play", "film.mkv", "--calibration", "near=900,far=500"}, "near=900,far=500");
  expectRefused({"play", "film.mkv", "--calibration", "bits=8,invalid=300"}, "invalid=300");
  expectRefused({"play", "film.mkv", "--calibration", "near=1e-9"}, "near=1e-9");
  expectRefused({"play", "film.mkv", "--calibration", "far=1e300"}, "far=1e300");
  expectRefused({"play", "film.mkv", "--material", "stiffness=soft"}, "--material stiffness=soft");
  expectRefused({"probe", "film.mkv", "--material", "friction=.1/.2"}, "friction=.1/.2");
  expectRefused({"play", "film.mkv", "--material", "stiffness=.3,hardness=9"}, "--material hardness=9: no part of a");
  expectRefused({"play", "film.mkv", "--rate", "fast"}, "--rate: fast is not a number; it is one between 500 and 8000");
  expectRefused({"play", "film.mkv", "--fps", "0"}, "--fps: 0 is not between 0.01 and 10000");
  expectRefused({"play", "film.mkv", "--duration", "-1"}, "--duration -1: ");
  expectRefused({"play", "--films", "Videos", "--display", "offscreen"}, "--films: shows a list, and nobody sees it");
  expectRefused({"probe", "one.mkv", "two.mkv"}, "two.mkv: is one argument too many");
}

// Each one that the help shows with a value: "  --fps F  ..".
TEST(Options, EachThatNeedsAValueSaysSoInTheProjectsWords) {
  std::istringstream help(parse({"play", "--help"}).out);
  std::size_t options = 0;
  for (std::string line, dash, type; std::getline(help, line);) {
    std::istringstream words(line);
    const bool is_option = line.starts_with("  --") && words >> dash >> type;
    const std::size_t begin = is_option ? line.find(type) : 0;
    if (!is_option || begin != 2 + dash.size() + 1) continue;  // a flag: its meaning stands in a column of its own
    ++options;
    const std::string said = dash + ": its value is missing; write " + dash + " ";
    expectRefused({"play", "film.mkv", dash.c_str()}, said.c_str());
    expectRefused({"play", "film.mkv", dash.c_str(), "--loop"}, said.c_str());
  }
  EXPECT_GT(options, 20u);
  expectRefused({"play", "film.mkv", "--report", "--loop"}, "--report: its value is missing; write --report FILE");
  expectRefused({"play", "film.mkv", "--osd=maybe"}, "--osd: takes no value");
  expectRefused({"play", "film.mkv", "--size", "640x360", "--size", "64x36"}, "--size: was given more than once");
}

TEST(Options, ACalibrationFileThatIsMissingIsAFailureNotWrongUse) {
  const Parsed parsed = parse({"play", "film.mkv", "--calibration", "/nowhere/camera.txt"});
  ASSERT_FALSE(parsed.options);
  EXPECT_EQ(parsed.options.error(), 1);
  EXPECT_THAT(parsed.err, HasSubstr("/nowhere/camera.txt"));
}

TEST(Options, HelpTeachesOnStdoutAndIsNoFailure) {
  const Parsed parsed = parse({"play", "--help"});
  ASSERT_FALSE(parsed.options);
  EXPECT_EQ(parsed.options.error(), 0);
  EXPECT_THAT(parsed.out, HasSubstr("Examples:"));
  EXPECT_THAT(parsed.out, HasSubstr("offscreen[:FILE] mock"));
  EXPECT_THAT(parsed.out, HasSubstr("FASTFORWARD"));
  EXPECT_EQ(parsed.err, "");
}

}  // namespace
}  // namespace relievo
