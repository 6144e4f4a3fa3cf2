// SPDX-License-Identifier: Apache-2.0
// Command lines become values; a usage error gives exit code 2 and one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "app/player/setup/options.h"
#include "tests/support/film/clip_maker.h"
#include "tests/unit/player/setup/player_options.h"

namespace relievo::test {
namespace {

TEST(Options, AFirstWordThatIsNoCommandIsAFilm) {
  EXPECT_EQ(parse({"film.mkv"}).options->play.player.source.url, "film.mkv");
  EXPECT_EQ(parse({"--loop", "film.mkv"}).options->play.player.loop, true);
  EXPECT_EQ(parse({"./play"}).options->play.player.source.url, "./play");
  EXPECT_EQ(parse({"probe", "film.mkv"}).options->command, Options::Command::Probe);
  EXPECT_EQ(parse({"--", "--report", "--loop"}).options->play.player.source.url, "--report");
  const Parsed three = parse({"a.mkv", "b.m3u", "--loop", "films/"});
  ASSERT_TRUE(three.options) << three.err;
  EXPECT_EQ(three.options->play.player.source.url, "a.mkv");
  EXPECT_EQ(three.options->play.player.more, (std::vector<std::string>{"b.m3u", "films/"}));
}

TEST(Options, DepthIsNamedAsTheFilmIs) {
  const char* const address = "file:///films/two%20words.mkv";
  const Parsed play = parse({address, "--depth", address}), probe = parse({"probe", address, "--depth", address});
  ASSERT_TRUE(play.options && probe.options) << play.err << probe.err;
  for (const SourceOptions& source : {play.options->play.player.source, probe.options->probe.source}) {
    EXPECT_EQ(source.url, "/films/two words.mkv");
    EXPECT_EQ(source.depth_url, "/films/two words.mkv");
  }
}

TEST(Options, HelpAndVersionAreAnsweredEverywhere) {
  for (const std::vector<const char*>& words : {std::vector<const char*>{"help"}, {"--help"}, {"-h"}}) {
    EXPECT_THAT(parse(words).out, HasSubstr("relievo film.mkv")) << words[0];
    EXPECT_THAT(parse(words).out, HasSubstr("\n  relievo                   shows a list of films")) << words[0];
  }
  EXPECT_EQ(parse({"help", "play"}).out, parse({"play", "--help"}).out);
  EXPECT_EQ(parse({"play", "help"}).out, parse({"play", "--help"}).out);
  EXPECT_EQ(parse({"help", "devices"}).out, parse({"devices", "--help"}).out);
  expectRefused({"help", "keys"}, "help keys: there is no such command; see relievo --help");
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
  expectRefused({"film.mkv", "--wide-screen"}, "--wide-screen: no such option; see relievo play --help");
  expectRefused({"film.mkv", "-fs"}, "-fs: no such option; did you mean --fs?");
  expectRefused({"film.mkv", "-lop"}, "-lop: no such option; did you mean --loop?");
  expectRefused({"film.mkv", "--display", "windo"}, "did you mean window?");
  expectRefused({"film.mkv", "--packing", "trakcs"}, "did you mean tracks?");
  expectRefused({"probe", "film.mkv", "--jsn"}, "--jsn: no such option; did you mean --json?");
  expectRefused({"prob", "film.mkv"}, "prob (probe?): is neither a file nor a command");
  expectRefused({"devices", "calibrat"}, "calibrat: is one argument too many");
}

TEST(Options, AFilmBeginsWhereItIsSaid) {
  using std::chrono::milliseconds;
  for (const auto& [words, start] : {std::pair{"--start=90", 90'000},
                                     {"--start=1:30", 90'000},
                                     {"--start=1:01:01.5", 3'661'500},
                                     {"--start=0", 0}}) {
    const Parsed parsed = parse({"film.mkv", words});
    ASSERT_TRUE(parsed.options) << parsed.err;
    EXPECT_EQ(parsed.options->play.player.start, MediaTime(milliseconds(start))) << words;
  }
  EXPECT_EQ(parse({"film.mkv", "--start", "2:00"}).options->play.player.start, MediaTime(milliseconds(120'000)));
  EXPECT_EQ(parse({"film.mkv"}).options->play.player.start, std::nullopt);
  for (const char* word : {"soon", "-1", "1:", ":", "1:-2", "1:2:3:4", "50%", "1e12"}) {
    expectRefused({"film.mkv", "--start", word}, ": a time is seconds, M:SS");
  }
  EXPECT_EQ(parse({"-"}).options->play.player.source.url, "/dev/stdin");
}

// With a value and without, in both forms, before the film and behind it.
TEST(Options, OfOtherPlayersAreAnsweredWithWhatDoesTheSame) {
  expectRefused({"film.mkv", "--ss", "10"}, "--ss: no such option; use --start TIME");
  expectRefused({"--ss=10", "film.mkv"}, "--ss: no such option; use --start TIME");
  expectRefused({"--mute", "--loop", "film.mkv"}, "--mute: no such option; use --audio none");
  expectRefused({"film.mkv", "--fullscreen"}, "--fullscreen: no such option; use --fs, or the key f while it plays");
  expectRefused({"film.mkv", "--no-audio"}, "--no-audio: no such option; use --audio none");
  expectRefused({"film.mkv", "--sub-file=a.srt"}, "--sub-file: no such option; subtitles lie beside the film");
  EXPECT_THAT(parse({"play", "--help"}).out, testing::Not(HasSubstr("--no-audio")));
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
  expectRefused({"play", "film.mkv", "--size", "640.9x480"}, "--size");
  expectRefused({"play", "film.mkv", "--size", "64e1x480"}, "--size");
  expectRefused({"play", "film.mkv", "--size", "99999x360"}, "--size");
  expectRefused({"play", "film.mkv", "--size", "16384x16384"}, "67 million in all");
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
  expectRefused({"play", "film.mkv", "--duration", "0:02"}, "relievo: --duration: 0:02 is not a number; see");
  expectRefused({"play", "film.mkv", "--rate", "fast"}, "--rate: fast is not a number; give one between 500 and 8000");
  expectRefused({"play", "film.mkv", "--fps", "0"}, "--fps: 0 is not between 0.01 and 10000");
  expectRefused({"play", "film.mkv", "--duration", "-1"}, "--duration -1: ");
  expectRefused({"play", "--films", "Videos", "--display", "offscreen"},
                "--films: shows a list, which cannot be seen off screen");
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
    if (!is_option || begin != 2 + dash.size() + 1) continue;  // a flag: its meaning is in a column of its own
    ++options;
    const std::string said = dash + ": its value is missing; write " + dash + " ";
    expectRefused({"play", "film.mkv", dash.c_str()}, said.c_str());
    expectRefused({"play", "film.mkv", dash.c_str(), "--loop"}, said.c_str());
    expectRefused({"play", (dash + "=").c_str(), "film.mkv"}, said.c_str());
    expectRefused({"play", "film.mkv", dash.c_str(), "--duration=5"}, said.c_str());
  }
  EXPECT_GT(options, 20u);
  expectRefused({"play", "film.mkv", "--report", "--loop"}, "--report: its value is missing; write --report FILE");
  expectRefused({"play", "film.mkv", "--report", ""}, "--report: its value is missing; write --report FILE");
  expectRefused({"play", "film.mkv", "--osd=maybe"}, "--osd: takes no value");
  expectRefused({"play", "film.mkv", "--size", "640x360", "--size", "64x36"}, "--size: was given more than once");
}

TEST(Options, ACalibrationFileThatIsMissingIsAFailureNotWrongUse) {
  const Parsed parsed = parse({"play", "film.mkv", "--calibration", "/nowhere/camera.txt"});
  ASSERT_FALSE(parsed.options);
  EXPECT_EQ(parsed.options.error(), 1);
  EXPECT_THAT(parsed.err, HasSubstr("/nowhere/camera.txt"));
}

TEST(Options, ACalibrationFileThatSaysNothingIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* text : {"", "\n", "# near = 250\n"}) {
    std::ofstream(folder / "camera.txt") << text;
    const Parsed parsed = parse({"play", "film.mkv", "--calibration", (folder / "camera.txt").c_str()});
    ASSERT_FALSE(parsed.options) << text;
    EXPECT_THAT(parsed.err, HasSubstr("camera.txt: is empty; write KEY=VALUE in each line"));
  }
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
}  // namespace relievo::test
