// SPDX-License-Identifier: Apache-2.0
// The programs on a depth camera that umockdev plugs into this machine: its live picture is touched, and what it does
// wrong is told.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/support/clip_maker.h"
#include "tests/support/mocked_machine.h"
#include "tests/support/process.h"
#include "tests/support/program.h"
#include "tests/support/umockdev_camera.h"

namespace relievo {
namespace {

using test::UmockdevCamera;

// A ball of 250 mm before a wall 1.4 m away, going to and fro.
test::CameraKind ballCamera() {
  test::CameraKind kind{.formats = {V4L2_PIX_FMT_Z16}, .width = 160, .height = 120, .paced = true};
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
  EXPECT_GT(live["touch_latency_ms"]["p50"].get<double>(), 0);
  EXPECT_LE(live["touch_latency_ms"]["p50"].get<double>(), live["picture_latency_ms"]["p50"].get<double>());
  EXPECT_EQ(r["video"]["pictures_lost"].get<std::uint32_t>(), camera.starved()) << "none was lost unseen";
  EXPECT_EQ(camera.unknownRequests(), 0);
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
  EXPECT_NE(text.find("v4l2:/dev/video0 lost: the camera has gone away; is its cable plugged in?"), std::string::npos)
      << text;
}

TEST_F(PlayerOnACamera, ACameraThatSendsNothingEndsInOneLine) {
  UmockdevCamera camera(bed_, 0, ballCamera());
  camera.silence();
  const auto played = test::runProgram(kPlay + std::string("--haptic none"), folder_ / "");
  EXPECT_EQ(played.exit_code, 1);
  EXPECT_EQ(played.err,
            "relievo: v4l2:/dev/video0: the camera has sent no picture for three seconds; unplug and plug it\n");
}

}  // namespace
}  // namespace relievo
