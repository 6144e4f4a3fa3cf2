// SPDX-License-Identifier: Apache-2.0
// The programs on a depth camera that umockdev plugs into this machine: its live picture is touched, and its faults are
// reported.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_camera.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

using test::UmockdevCamera;

// A ball of 250 mm before a wall 1.4 m away, going to and fro.
test::CameraKind ballCamera() {
  test::CameraKind kind{.formats = {V4L2_PIX_FMT_Z16}, .width = 160, .height = 120, .paced = true};
  // 5 ms of jitter either way, in no order.
  kind.delay = [](std::uint32_t number) { return std::chrono::milliseconds(number * 7 % 11); };
  kind.sample = [](std::uint32_t number, int c, int r) {
    const double x = 4 * (c - 80) - 60 * std::sin(number / 20.0), y = 4 * (r - 60), square = 250 * 250 - x * x - y * y;
    return static_cast<std::uint16_t>(1400 - (square > 0 ? std::sqrt(square) : 0));
  };
  return kind;
}

constexpr const char* kPlay = "relievo play v4l2:/dev/video0 --calibration near=1000,far=1500 --display mock ";

class PlayerOnACamera : public test::MockedMachine {
 protected:
  [[nodiscard]] nlohmann::json report() const {
    std::ifstream file(folder_ / "r.json");
    return nlohmann::json::parse(file);
  }
  test::TemporaryFolder folder_;
};

TEST_F(PlayerOnACamera, TheLivePictureIsTouchedAndItsLatencyIsTold) {
  UmockdevCamera camera(bed_, 0, ballCamera());
  const auto played =
      test::runProgram(kPlay + std::string("--haptic sim --duration 4 --report ") + (folder_ / "r.json"), folder_ / "");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_NE(played.out.find("live    seen "), std::string::npos) << played.out;
  const auto r = report();
  EXPECT_EQ(r["film"]["depth"]["codec"], "z16");
  EXPECT_GT(r["video"]["frames_shown"].get<int>(), 10) << "of a hundred, on a machine that keeps up";
  EXPECT_GT(r["haptic"]["contact_share"].get<double>(), 0);
  EXPECT_GT(r["force"]["max_n"].get<double>(), 0.1);
  const auto& live = r["live"];
  RecordProperty("live", live.dump());
  EXPECT_GT(live["touch_latency_ms"]["p50"].get<double>(), 33) << "one frame ahead";
  EXPECT_GT(live["picture_latency_ms"]["p50"].get<double>(), 0);
  EXPECT_GE(live["touch_behind_picture_ms"]["p99"].get<double>(), 0);
  EXPECT_NE(r["haptic"]["plan"].get<std::string>().find("linear in time"), std::string::npos) << r["haptic"]["plan"];
  // A picture that is lost after the last one that came cannot be noticed; camera_v4l2_test counts lost pictures one by
  // one.
  EXPECT_LE(r["video"]["pictures_lost"].get<std::uint32_t>(), camera.starved());
  EXPECT_EQ(camera.unknownRequests(), 0);
}

// The colour camera stands 30 mm to the right: 1.2 m away the ball is 80 x 30 / 1200 = 2 of its pixels further left.
TEST_F(PlayerOnACamera, ColourAndDepthOfTwoCamerasMeet) {
  UmockdevCamera depth(bed_, 0, ballCamera());
  test::CameraKind kind = ballCamera();
  kind.formats = {V4L2_PIX_FMT_YUYV};
  UmockdevCamera color(bed_, 1, kind);
  std::ofstream(folder_ / "rig.toml") << "[depth]\nsize = [160, 120]\nfocal = [80, 80]\ncenter = [79.5, 59.5]\n"
                                         "[color]\nsize = [160, 120]\nfocal = [80, 80]\ncenter = [79.5, 59.5]\n"
                                         "[depth_to_color]\ntranslation_mm = [-30, 0, 0]\n";
  const auto played = test::runProgram("relievo play v4l2:/dev/video1 --depth v4l2:/dev/video0 --registration " +
                                           (folder_ / "rig.toml") +
                                           " --calibration near=1000,far=1500 --display mock --haptic sim --duration 4 "
                                           "--report " +
                                           (folder_ / "r.json"),
                                       folder_ / "");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const auto r = report();
  EXPECT_EQ(r["film"]["color"]["codec"], "yuyv");
  EXPECT_EQ(r["film"]["depth"]["codec"], "z16");
  EXPECT_GT(r["video"]["frames_shown"].get<int>(), 0);  // most of them, unless the machine is busy
  EXPECT_LE(2 * r["video"]["pairs_without_depth"].get<int>(), r["video"]["frames_shown"].get<int>());
  EXPECT_GT(r["haptic"]["contact_share"].get<double>(), 0);
  EXPECT_LE(r["video"]["pictures_lost"].get<std::uint32_t>(), depth.starved() + color.starved());
}

// Until Ctrl-C; then it is a film like any other.
TEST_F(PlayerOnACamera, WhatTheAuthorRecordsIsAFilm) {
  UmockdevCamera camera(bed_, 0, ballCamera());
  test::Process author({RELIEVO_BIN_DIR "/relievo-author", "--color", "v4l2:/dev/video0", "-o", folder_ / "film.mkv"},
                       folder_ / "said.txt");
  MonotonicClock clock;
  while (camera.taken() < 60 && author.isRunning()) clock.sleepUntil(clock.now() + std::chrono::milliseconds(5));
  author.send(SIGINT);
  std::ifstream said(folder_ / "said.txt");
  ASSERT_EQ(author.wait(), 0) << std::string(std::istreambuf_iterator<char>(said), {});
  const auto probed = test::runProgram("relievo probe --json " + (folder_ / "film.mkv"), folder_ / "");
  ASSERT_EQ(probed.exit_code, 0) << probed.err;
  const auto film = nlohmann::json::parse(probed.out);
  EXPECT_EQ(film["depth"]["width"], 160);
  if (camera.starved() == 0) {  // else pictures are missing
    EXPECT_NEAR(film["frames_per_s"].get<double>(), 30, 0.5);
  }
  EXPECT_GT(film["duration_s"].get<double>(), 0.1);
  EXPECT_NE(film["depth"]["calibration"].get<std::string>().find("near=300 (container tags)"), std::string::npos);
}

TEST_F(PlayerOnACamera, PluggedInAgainItGoesOn) {
  UmockdevCamera camera(bed_, 0, ballCamera());
  test::Process player({RELIEVO_BIN_DIR "/relievo", "play", "v4l2:/dev/video0", "--display", "mock", "--haptic", "none",
                        "--duration", "8", "--report", folder_ / "r.json"},
                       folder_ / "said.txt");
  MonotonicClock clock;
  const auto wait = [&](std::uint32_t pictures) {
    for (const std::uint32_t begin = camera.taken(); camera.taken() < begin + pictures && player.isRunning();) {
      clock.sleepUntil(clock.now() + std::chrono::milliseconds(5));
    }
  };
  wait(30);
  camera.unplug();
  clock.sleepUntil(clock.now() + std::chrono::milliseconds(300));
  camera.plug();
  EXPECT_EQ(player.wait(), 0);
  EXPECT_EQ(report()["video"]["reconnects"], 1);
  std::ifstream said(folder_ / "said.txt");
  const std::string text(std::istreambuf_iterator<char>(said), {});
  EXPECT_NE(text.find("v4l2:/dev/video0 lost: the camera has gone away; check its cable"), std::string::npos) << text;
}

TEST_F(PlayerOnACamera, ACameraThatSendsNothingEndsInOneLine) {
  UmockdevCamera camera(bed_, 0, ballCamera());
  camera.silence();
  const auto played = test::runProgram(kPlay + std::string("--haptic none"), folder_ / "");
  EXPECT_EQ(played.exit_code, 1);
  EXPECT_EQ(
      played.err,
      "relievo: v4l2:/dev/video0: the camera has sent no picture for three seconds; unplug it and plug it in again\n");
}

}  // namespace
}  // namespace relievo
