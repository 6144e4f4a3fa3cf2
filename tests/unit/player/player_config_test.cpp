// SPDX-License-Identifier: Apache-2.0
// Options out of the configuration: the command line first, then the file, then the defaults, and all of it printed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "app/player/setup/options.h"
#include "platform/log.h"
#include "platform/print.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using testing::HasSubstr;
using testing::Not;

class PlayConfig : public testing::Test {
 protected:
  struct Parsed {
    std::expected<Options, int> options;
    std::string out, err;
  };

  // `relievo play WORDS.. --config FILE`, the file with this text.
  Parsed parse(const std::string& text, std::vector<std::string> words) {
    std::ofstream(path()) << text;
    words.insert(words.begin(), {"relievo", "play"});
    words.insert(words.end(), {"--config", path()});
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    auto options = parseOptions(
        static_cast<int>(argv.size()), argv.data(),
        {"kms[:CARD] window offscreen[:FILE] mock", "falcon sim[:HAND] pointer replay:FILE mock none",
         "evdev keys window script:FILE none", "alsa[:DEVICE] null none", "v4l2 gstreamer[:ELEMENT] ffmpeg"});
    std::string out = testing::internal::GetCapturedStdout();
    return {std::move(options), std::move(out), testing::internal::GetCapturedStderr()};
  }
  PlayOptions play(const std::string& text, const std::vector<std::string>& words) {
    const Parsed parsed = parse(text, words);
    EXPECT_TRUE(parsed.options) << parsed.err;
    return parsed.options ? parsed.options->play : PlayOptions{};
  }
  std::string printed(const std::string& text, std::vector<std::string> words = {}) {
    words.emplace_back("--print-config");
    const Parsed parsed = parse(text, words);
    EXPECT_TRUE(!parsed.options && parsed.options.error() == 0) << parsed.err;
    return parsed.out;
  }
  void expectRefused(const std::string& text, int exit_code, const std::string& part) {
    const Parsed parsed = parse(text, {"film.mkv"});
    ASSERT_FALSE(parsed.options) << text;
    EXPECT_EQ(parsed.options.error(), exit_code);
    EXPECT_THAT(parsed.err, HasSubstr(part));
    EXPECT_EQ(std::count(parsed.err.begin(), parsed.err.end(), '\n'), 1) << parsed.err;
  }
  [[nodiscard]] std::string path() const { return folder_ / "box.toml"; }

  test::TemporaryFolder folder_;
};

// "key" -> "value" of the lines of [play]; what is not set has no value.
std::map<std::string, std::string> valuesIn(const std::string& text) {
  static const std::regex set("([a-z-]+) = (.*?)  # .*"), unset("# ([a-z-]+) is not set");
  std::map<std::string, std::string> values;
  std::istringstream lines(text.substr(0, text.find("\n\n")));
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, set)) values[match[1]] = match[2];
    else if (std::regex_match(line, match, unset)) values[match[1]] = "";
  }
  return values;
}

TEST_F(PlayConfig, TheCommandLineGoesBeforeTheFileAndTheFileBeforeTheDefault) {
  const std::string file =
      "[play]\nsource = \"file.mkv\"\ndisplay = \"mock\"\nhaptic = \"none\"\ndepth-strength = 0.5\n";
  const PlayOptions options = play(file, {"line.mkv", "--haptic", "mock"});
  EXPECT_EQ(options.player.source.url, "line.mkv");
  EXPECT_EQ(options.haptic, "mock");
  EXPECT_EQ(options.display, "mock");
  EXPECT_EQ(options.player.stereo.strength, 0.5);
  EXPECT_EQ(options.player.stereo.layout, StereoLayout::Mono);
  EXPECT_EQ(play(file, {}).player.source.url, "file.mkv");
}

TEST_F(PlayConfig, AFlagCanBeTurnedOffAgain) {
  EXPECT_TRUE(play("[play]\nloop = true\n", {"f.mkv"}).player.loop);
  EXPECT_FALSE(play("[play]\nloop = false\n", {"f.mkv"}).player.loop);
  EXPECT_FALSE(play("[play]\nloop = true\n", {"f.mkv", "--loop=false"}).player.loop);
}

TEST_F(PlayConfig, ACalibrationOfTheCommandLineTakesThePlaceOfTheFiles) {
  const std::string file = "[play]\ncalibration = [\"law=inverse,near=100\", \"near=200\"]\n";
  const auto from_file = play(file, {"f.mkv"}).player.source.command_line;
  EXPECT_EQ(from_file.at("law"), "inverse");
  EXPECT_EQ(from_file.at("near"), "200");
  EXPECT_EQ(play(file, {"f.mkv", "--calibration", "near=300"}).player.source.command_line.count("law"), 0U);
}

// Every option that there is: one that is new has to be given a word here.
TEST_F(PlayConfig, EveryOptionCanStandInTheFileAndIsPrintedAsItReadsBack) {
  const std::string rig = path() + "-rig.toml";
  const std::string camera = "size = [640, 480]\nfocal = [600, 600]\ncenter = [320, 240]\n";
  std::ofstream(rig) << "[depth]\n" << camera << "[color]\n" << camera;
  const std::map<std::string, std::string> samples = {{"source", R"("a \"b\" c.mkv")"},
                                                      {"depth", R"("d.mkv")"},
                                                      {"packing", R"("tb")"},
                                                      {"as", R"("tum")"},
                                                      {"fps", "24"},
                                                      {"depth-code", R"("hue")"},
                                                      {"depth-from", R"("stereo")"},
                                                      {"calibration", R"(["near=100", "far=2000"])"},
                                                      {"registration", "\"" + rig + "\""},
                                                      {"display", R"("mock")"},
                                                      {"size", R"("640x360")"},
                                                      {"stereo", R"("quilt:5x9")"},
                                                      {"swap-eyes", "true"},
                                                      {"tv-signal", R"("tab")"},
                                                      {"depth-strength", "0.25"},
                                                      {"haptic", R"("mock")"},
                                                      {"rate", "2000"},
                                                      {"decoder", R"("ffmpeg")"},
                                                      {"material", R"("stiffness=.3,friction=.2/.15")"},
                                                      {"remote", R"("none")"},
                                                      {"audio", R"("null")"},
                                                      {"box", R"("200x100.5x30")"},
                                                      {"volume", "80.5"},
                                                      {"alang", R"("jpn,en")"},
                                                      {"slang", R"("de")"},
                                                      {"fs", "true"},
                                                      {"osd", "true"},
                                                      {"software", "true"},
                                                      {"start", R"("1:30")"},
                                                      {"loop", "true"},
                                                      {"duration", "12.5"},
                                                      {"resume", "true"},
                                                      {"films", R"(["/srv/a", "/srv/b"])"},
                                                      {"keys", R"("k.toml")"},
                                                      {"report", R"("r.json")"},
                                                      {"record", R"("t.csv")"},
                                                      {"control", R"("/run/r")"}};
  std::string file = "[play]\n";
  for (const auto& [key, value] : valuesIn(printed(""))) {
    ASSERT_TRUE(samples.contains(key)) << key << ": an option without a sample here";
    EXPECT_NE(value, samples.at(key)) << key << ": the sample is the default";
    file += key + " = " + samples.at(key) + "\n";
  }
  file += "[falcon]\ncounts_per_nm = 7000\n[log]\nhaptic = \"debug\"\n";

  const std::string first = printed(file);
  EXPECT_EQ(valuesIn(first), samples);
  EXPECT_THAT(first, HasSubstr("\n[falcon]\ncounts_per_nm = 7000  # "));
  EXPECT_THAT(first, HasSubstr("\n[log]\nhaptic = \"debug\"  # "));
  EXPECT_EQ(valuesIn(printed(first)), samples);
}

TEST_F(PlayConfig, TheDefaultsPrintedAreThoseInUse) {
  const PlayOptions usual = play("", {"f.mkv"});
  const std::string text = printed("");
  for (const char* const key : {"packing", "depth-code", "stereo", "depth-strength"}) {
    EXPECT_THAT(text, HasSubstr(print("\n%s = ", key)));
  }
  const PlayOptions read_back = play(text, {"f.mkv"});
  EXPECT_EQ(read_back.display, usual.display);
  EXPECT_EQ(read_back.haptic, usual.haptic);
  EXPECT_EQ(read_back.player.source.packing, usual.player.source.packing);
  EXPECT_EQ(read_back.player.source.depth_code, usual.player.source.depth_code);
  EXPECT_EQ(read_back.player.display.width, usual.player.display.width);
  EXPECT_EQ(read_back.player.display.height, usual.player.display.height);
  EXPECT_EQ(read_back.player.stereo.layout, usual.player.stereo.layout);
  EXPECT_EQ(read_back.player.stereo.strength, usual.player.stereo.strength);
  EXPECT_EQ(read_back.player.loop, usual.player.loop);
}

TEST_F(PlayConfig, EachValueIsPrintedWithWhereItIsFrom) {
  const std::string text = printed("# mine\n[play]\ndisplay = \"mock\"\nsource = \"f.mkv\"\n", {"--haptic", "none"});
  EXPECT_THAT(text, HasSubstr("display = \"mock\"  # " + path() + ":3\n"));
  EXPECT_THAT(text, HasSubstr("source = \"f.mkv\"  # " + path() + ":4\n"));
  EXPECT_THAT(text, HasSubstr("haptic = \"none\"  # command line\n"));
  EXPECT_THAT(text, HasSubstr("packing = \"auto\"  # default\n"));
  EXPECT_THAT(text, HasSubstr("# duration is not set\n"));
  EXPECT_THAT(text, Not(HasSubstr("print-config")));
}

TEST_F(PlayConfig, WhatIsWrongIsOneLineThatNamesItsPlace) {
  expectRefused("[play]\n\ndsplay = \"mock\"\n", 2, path() + ":3: dsplay: no such option");
  expectRefused("[play]\ndepth-strength = 3\n", 2, path() + ":2: ");
  expectRefused("[play]\ndepth-strength = nan\n", 2, path() + ":2: ");
  expectRefused("[play]\npacking = \"diagonal\"\n", 2, path() + ":2: ");
  expectRefused("[play]\nsize = 640\n", 2, path() + ":2: size = 640: a size is");
  expectRefused("[play]\nloop = \"maybe\"\n", 2, path() + ":2: loop = \"maybe\": it is either true or false");
  expectRefused("[play]\nloop = 2\n", 2, path() + ":2: loop = 2: ");
  expectRefused("[play]\nloop = [true, false]\n", 2, path() + ":2: loop = [true, false]: ");
  expectRefused("[play]\ndisplay = [\"a\", \"b\"]\n", 2, path() + ":2: ");
  expectRefused("[play]\nsize = []\n", 2, path() + ":2: ");
  expectRefused("[play]\nsize = { w = 1 }\n", 2, path() + ":2: ");
  expectRefused("[play]\nhelp = true\n", 2, path() + ":2: help: no such option");
  expectRefused("[play]\nconfig = \"other\"\n", 2, path() + ":2: config: no such option");
  expectRefused("[play]\ncalibration = \"/nowhere/c.txt\"\n", 1, path() + ":2: calibration = /nowhere/c.txt: ");
  expectRefused("[play]\ndisplay = \"screen\"\n", 2,
                path() + ":2: display: screen: no such display; it is one of: kms");
  expectRefused("[play]\nhaptic = \"simple:x\"\n", 2, path() + ":2: haptic: simple:x: no such haptic device");
  expectRefused("[player]\n", 2, path() + ":1: ");
  expectRefused("[log]\nhaptics = \"debug\"\n", 2,
                path() + ":2: haptics is no area of the log; they are all, control,");
  expectRefused("[log]\nhaptic = \"loud\"\n", 2, path() + ":2: a level is");
  expectRefused("[log]\nhaptic = 3\n", 2, path() + ":2: a level is");
  std::string deep = "\n[play";
  for (int i = 0; i < 60'000; ++i) deep += ".a";
  expectRefused(deep + "]\nx = 1\n", 2, path() + ":2: this is not valid TOML");
}

TEST_F(PlayConfig, WithoutASourceThereHasToBeASocketToBeToldOne) {
  const Parsed neither = parse("", {});
  ASSERT_FALSE(neither.options);
  EXPECT_EQ(neither.options.error(), 2);
  EXPECT_THAT(neither.err, HasSubstr("SOURCE: is missing"));
  EXPECT_EQ(play("[play]\ncontrol = \"/run/r\"\n", {}).control_path, "/run/r");
}

TEST_F(PlayConfig, LevelsOfTheLogAreForAllAndForAreasThatDiffer) {
  const Parsed parsed = parse("[log]\nall = \"error\"\nhaptic = \"debug\"\n", {"f.mkv"});
  ASSERT_TRUE(parsed.options) << parsed.err;
  applyLogLevels(parsed.options->config);
  EXPECT_EQ(logLevel("haptic"), LogLevel::Debug);
  EXPECT_EQ(logLevel("play"), LogLevel::Error);
  EXPECT_EQ(logLevel("film.mkv"), LogLevel::Error);
  setLogLevel(LogLevel::Info);
  EXPECT_EQ(logLevel("haptic"), LogLevel::Info);
}

// CLI11 would take it as a list of names.
TEST_F(PlayConfig, AFilmsNameMayStandInBrackets) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_ / "");
  for (const std::string name : {"[2019,2020]", "[Group] Show [1080p]"}) {
    std::ofstream{name};
    const SourceOptions given = play("", {name}).player.source;
    const PlayOptions listed = play("[play]\nsource = [\"" + name + "\", \"b.mkv\"]\n", {});
    EXPECT_EQ(given.url, "./" + name);
    EXPECT_EQ(listed.player.source.url, "./" + name);
    EXPECT_EQ(listed.player.more, std::vector<std::string>{"b.mkv"});
  }
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace relievo
