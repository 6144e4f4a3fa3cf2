// SPDX-License-Identifier: Apache-2.0
// The player on video hardware that umockdev plugs into this machine: which decoder is used, and how the film continues
// when it hangs or disappears.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_codec.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using test::UmockdevCodec;

constexpr const char* kHardware = "v4l2-m2m, A decoder that is not there at /dev/video1";
constexpr int kFrames = 50;

class PlayerOnHardware : public test::MockedMachine {
 protected:
  // Made by the author's tool, for hardware.
  void SetUp() override {
    test::MockedMachine::SetUp();
    if (IsSkipped()) return;
    test::ClipTrack color{.pix_fmt = "yuv420p", .width = 160, .height = 120, .fps_num = 25, .frames = kFrames};
    test::ClipTrack depth = color;
    depth.pix_fmt = "gray";
    test::makeClip(folder_ / "color.mkv", {color});
    test::makeClip(folder_ / "depth.mkv", {depth});
    const auto made = test::runProgram("relievo-author --color " + (folder_ / "color.mkv") + " --depth " +
                                           (folder_ / "depth.mkv") + " --depth-chroma flat -o " + film(),
                                       folder_ / "");
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }
  [[nodiscard]] std::string film() const { return folder_ / "film.mkv"; }
  [[nodiscard]] nlohmann::json play(const std::string& options = "") {
    const auto played = test::runProgram(
        "relievo play " + film() + " --display mock --haptic sim " + options + " --report " + (folder_ / "r.json"),
        folder_ / "");
    EXPECT_EQ(played.exit_code, 0) << played.err;
    said_ = played.err;
    std::ifstream file(folder_ / "r.json");
    return nlohmann::json::parse(file);
  }
  static std::vector<std::string> faultsOf(const nlohmann::json& report) {
    std::vector<std::string> faults;
    for (const auto& fault : report["faults"]) {
      const std::string what = fault["what"];
      if (what.starts_with("the video hardware")) faults.push_back(what + "; " + fault["done"].get<std::string>());
    }
    return faults;
  }
  test::TemporaryFolder folder_;
  std::string said_;
};

TEST_F(PlayerOnHardware, BothTracksAreDecodedByItAndTheDepthIsFelt) {
  UmockdevCodec color(bed_, 10), depth(bed_, 11);
  const auto report = play();
  EXPECT_EQ(report["film"]["color"]["decoder"], std::string(kHardware) + "0");
  EXPECT_EQ(report["film"]["depth"]["decoder"], std::string(kHardware) + "1");
  EXPECT_EQ(color.pictures(), kFrames);
  EXPECT_EQ(depth.pictures(), kFrames);
  EXPECT_EQ(report["video"]["frames_shown"].get<int>() + report["video"]["frames_dropped"].get<int>(), kFrames);
  EXPECT_GT(report["haptic"]["contact_share"].get<double>(), 0);
  EXPECT_EQ(color.unknownRequests() + depth.unknownRequests(), 0);
  EXPECT_EQ(faultsOf(report), std::vector<std::string>{});
}

TEST_F(PlayerOnHardware, AHungDriverIsBegunAnewAndToldOf) {
  UmockdevCodec codec(bed_, 10);
  codec.hangAfter(30, 1);
  const auto report = play();
  EXPECT_EQ(
      faultsOf(report),
      std::vector<std::string>{"the video hardware stopped responding; the decoder was restarted at the same picture"});
  EXPECT_EQ(codec.openings(), 2);
  EXPECT_EQ(report["video"]["frames_shown"].get<int>() + report["video"]["frames_dropped"].get<int>(), kFrames);
  EXPECT_EQ(report["film"]["depth"]["decoder"], "ffmpeg; no better decoder: the video hardware is busy");
  EXPECT_NE(said_.find("v4l2-m2m cannot decode h264: the video hardware is busy"), std::string::npos) << said_;
}

TEST_F(PlayerOnHardware, WhenItIsGoneTheFilmGoesOnInSoftware) {
  UmockdevCodec codec(bed_, 10);
  codec.unplugAfter(25);
  const auto report = play();
  EXPECT_EQ(faultsOf(report), std::vector<std::string>{"the video hardware has gone away; another decoder, in "
                                                       "software, continues at the same picture"});
  EXPECT_EQ(report["video"]["frames_shown"].get<int>() + report["video"]["frames_dropped"].get<int>(), kFrames);
}

TEST_F(PlayerOnHardware, IsNamedBeforehandAndMayBeLeftAlone) {
  UmockdevCodec codec(bed_, 10);
  const auto probed = test::runProgram("relievo probe " + film(), folder_ / "");
  EXPECT_NE(probed.out.find(kHardware), std::string::npos) << probed.out;
  const int openings = codec.openings();
  EXPECT_EQ(play("--software")["film"]["color"]["decoder"], "ffmpeg");
  EXPECT_EQ(codec.openings(), openings);
}

}  // namespace
}  // namespace relievo
