// SPDX-License-Identifier: Apache-2.0
// Words of the command line to values; wrong words to exit code 2 and one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
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

Parsed parse(const std::vector<const char*>& arguments) {
  std::vector<const char*> words{"relievo"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  auto options =
      parseOptions(static_cast<int>(words.size()), words.data(),
                   {"kms[:CARD] window offscreen[:FILE] mock", "falcon sim[:HAND] pointer replay:FILE mock none",
                    "evdev keys window script:FILE none", "alsa[:DEVICE] null none"});
  std::string out = testing::internal::GetCapturedStdout();
  std::string err = testing::internal::GetCapturedStderr();
  return {std::move(options), std::move(out), std::move(err)};
}

void expectRefused(const std::vector<const char*>& words, const char* part) {
  const Parsed parsed = parse(words);
  ASSERT_FALSE(parsed.options) << words.back();
  EXPECT_EQ(parsed.options.error(), 2);
  EXPECT_THAT(parsed.err, StartsWith("relievo: "));
  EXPECT_THAT(parsed.err, HasSubstr(part));
  EXPECT_EQ(std::count(parsed.err.begin(), parsed.err.end(), '\n'), 1) << parsed.err;
}

TEST(Options, HaveTheDefaultsOfTheBox) {
  const Parsed parsed = parse({"play", "film.mkv"});
  ASSERT_TRUE(parsed.options);
  const PlayOptions& play = parsed.options->play;
  EXPECT_EQ(play.player.source.url, "film.mkv");
  EXPECT_EQ(play.player.source.packing, Packing::Auto);
  EXPECT_EQ(play.player.source.depth_code, std::nullopt);
  EXPECT_EQ(play.player.stereo.layout, StereoLayout::SideBySide);
  EXPECT_EQ(play.display, "offscreen");
  EXPECT_EQ(play.haptic, "sim");
  EXPECT_EQ(play.remote, "none");
  EXPECT_EQ(play.audio, "none");
  EXPECT_EQ(play.player.display.width, 1280);
  EXPECT_EQ(play.player.display.height, 720);
  EXPECT_FALSE(play.player.duration);
  EXPECT_FALSE(play.player.volume);
  EXPECT_FALSE(play.player.loop);
  EXPECT_TRUE(play.player.own_threads);
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
  EXPECT_EQ(parsedPlay({"--display", "window"}).haptic, "sim");
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
  expectRefused({"jump"}, "jump: unknown command; use one of play, probe, devices, selftest; see relievo --help");
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
  expectRefused({"play", "one.mkv", "two.mkv"}, "two.mkv");
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
