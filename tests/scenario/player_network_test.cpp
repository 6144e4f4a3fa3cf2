// SPDX-License-Identifier: Apache-2.0
// Films over a bad network, through the whole player: losses, stalls, a missing part, a cut line, addresses that lead
// elsewhere. Real sockets of the loopback interface and real time, so that bounds are generous.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <sstream>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/network/http_server.h"
#include "tests/support/network/rtsp_server.h"
#include "tests/support/network/udp_sender.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::ClipTrack;
using testing::HasSubstr;

constexpr int kClipSeconds = 6;

// Colour and depth, 25 pictures a second, a key frame every half second. The depth is a plane that moves a little.
ClipTrack track(bool depth) {
  return {.codec = "libx264",
          .pix_fmt = "yuv420p",
          .width = 160,
          .height = 120,
          .fps_num = 25,
          .frames = 25 * kClipSeconds,
          .gop = 12,
          .sample =
              [depth](int component, int column, int row, int frame) {
                if (component > 0) return 128u;
                if (depth) return 110u + static_cast<unsigned>(frame % 10);
                // Grain, so that there is something to send.
                return 60u + static_cast<unsigned>((column * 7919 + row * 104729 + frame * 1299709) % 9973) % 96;
              },
          .tags = depth ? std::map<std::string, std::string>{{"title", "depth"}} : std::map<std::string, std::string>{},
          .options = {{"preset", "ultrafast"}, {"tune", "zerolatency"}, {"crf", "38"}}};
}

// Up and down twice a second, through the surface: the finger comes in from outside whatever happened before.
glm::dvec3 tapping(double t_s) {
  return {0, 0, 20 - 5 * std::cos(4 * std::numbers::pi * t_s)};
}

class PlayerNetwork : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::makeClip(at("film.ts"), {track(false), track(true)});
    test::makeClip(at("film.mkv"), {track(false), track(true)});
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static std::string at(const std::string& name) { return *folder_ / name; }
  static double size(const std::string& name) { return static_cast<double>(std::filesystem::file_size(at(name))); }
  static double pace(const std::string& name) { return 1.3 * size(name) / kClipSeconds; }

  Outcome<void> play(const std::string& url, Duration for_at_most = 30s, const std::string& depth_url = "") {
    bench_.config.source.url = url;
    bench_.config.source.depth_url = depth_url;
    bench_.config.own_threads = true;
    bench_.config.duration = for_at_most;
    bench_.make_source = makeFfmpegSource;
    bench_.make_decoder = makeFfmpegDecoder;
    bench_.read_text = readFfmpegText;
    bench_.haptic.position_mm = tapping;
    auto recorder = Recorder::create(at("touch.csv"));
    bench_.recorder = &*recorder;
    started_ = clock_.now();
    auto played = bench_.runOn(clock_);
    EXPECT_TRUE(recorder->file().commit());
    expectForceWithinLimits();
    tell();
    return played;
  }

  // Both in the report and from tick to tick, the force changes by at most 50 N/s beyond what the hand's own motion can
  // change.
  void expectForceWithinLimits() {
    const HapticSummary& haptic = bench_.report.haptic;
    EXPECT_GT(haptic.contact_ticks, 100u);
    EXPECT_LE(haptic.max_force_n, 10.0);
    EXPECT_LE(haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
    std::ifstream csv(at("touch.csv"));
    std::string line;
    std::getline(csv, line);
    std::vector<double> last;
    std::size_t rows = 0;
    double steepest = 0;
    while (std::getline(csv, line)) {
      std::vector<double> row;
      std::istringstream cells(line);
      for (std::string cell; std::getline(cells, cell, ',') && row.size() < 10;) row.push_back(std::atof(cell.c_str()));
      ASSERT_EQ(row.size(), 10u);
      const glm::dvec3 force(row[7], row[8], row[9]);
      EXPECT_LE(glm::length(force), 10.0);
      if (!last.empty() && row[0] - last[0] < 0.05) {
        constexpr double kStiffest = 2.0;  // N/mm, the device's bound
        const double moved_mm = std::hypot(row[1] - last[1], row[2] - last[2], row[3] - last[3]);
        const double changed_n = glm::distance(force, glm::dvec3(last[7], last[8], last[9]));
        steepest = std::max(steepest, (changed_n - kStiffest * moved_mm) / (row[0] - last[0]));
      }
      last = row;
      ++rows;
    }
    EXPECT_GT(rows, 1000u);
    EXPECT_LE(steepest, 50.0 + 1e-6);
  }

  void tell() const {
    const PlayReport& r = bench_.report;
    std::cout << bench_.states() << "; " << r.frames_shown << " shown, " << r.frames_dropped << " dropped, "
              << r.pairs.damaged << " damaged, " << r.pairs.reconnects << " reconnects, " << r.pairs.jumps
              << " jumps, first picture " << r.first_frame_ms.value_or(-1) << " ms, force " << r.haptic.max_force_n
              << " N, " << r.haptic.max_scene_slew_n_per_s << " N/s\n";
    for (const FaultEntry& f : r.faults) {
      std::cout << "  " << f.time_s << " s: " << f.what << "; " << f.done << " (" << f.count << ")\n";
    }
  }

  // From the end of the fault until the surface was felt to move again, on the player's clock.
  double recoveredAfter(MonotonicTime fault_over) const {
    const double over_s = toSeconds(fault_over - started_);
    double recovered_s = 1e9;
    for (const FaultEntry& f : bench_.report.faults) {
      if (f.what == "depth back" && f.time_s >= over_s - 0.1) recovered_s = std::min(recovered_s, f.time_s - over_s);
    }
    std::cout << "  recovered after " << recovered_s << " s\n";
    return recovered_s;
  }

  inline static std::unique_ptr<test::TemporaryFolder> folder_;
  PlayerBench bench_;
  MonotonicClock clock_;
  MonotonicTime started_;
};

class PlayerLossyLine : public PlayerNetwork, public testing::WithParamInterface<double> {};

TEST_P(PlayerLossyLine, GoesOnAndCountsWhatIsDamaged) {
  const double lost = GetParam() / 100;
  const test::UdpSender sender(at("film.ts"), {.lost = lost, .doubled = 0.01, .mixed_up = 0.01});
  ASSERT_TRUE(play(sender.url(), 4s));
  EXPECT_GT(sender.lost(), 0u);
  EXPECT_GT(bench_.report.pairs.damaged, 0u);
  EXPECT_EQ(bench_.report.pairs.reconnects, 0u);
  EXPECT_GT(bench_.report.frames_shown, 5u);  // a busy machine leaves out most of them
}

INSTANTIATE_TEST_SUITE_P(Percent, PlayerLossyLine, testing::Values(0.1, 1.0, 5.0), [](const auto& test) {
  return std::to_string(static_cast<int>(test.param * 10)) + "PerMille";
});

TEST_F(PlayerNetwork, AServerThatStallsIsWaitedFor) {
  test::HttpServer server(at(""));
  server.bytes_per_s = pace("film.mkv");
  server.faults["film.mkv"] = {.after_bytes = static_cast<std::size_t>(0.3 * size("film.mkv")), .stall = 5s};
  ASSERT_TRUE(play(server.url("film.mkv")));
  EXPECT_THAT(bench_.states(), HasSubstr("playing buffering playing"));
  EXPECT_THAT(bench_.states(), HasSubstr("ended idle"));
  EXPECT_EQ(bench_.report.frames_shown + bench_.report.frames_dropped, 25u * kClipSeconds);
  EXPECT_LT(recoveredAfter(server.faultOver()), 1.0);
}

TEST_F(PlayerNetwork, AServerThatBreaksOffIsFoundAgainWhereTheFilmWas) {
  test::HttpServer server(at(""));
  server.bytes_per_s = 3 * pace("film.mkv");  // so short a file is read to its index, not sought in
  server.faults["film.mkv"] = {.after_bytes = static_cast<std::size_t>(0.3 * size("film.mkv")), .away = 1200ms};
  ASSERT_TRUE(play(server.url("film.mkv")));
  EXPECT_GE(bench_.report.pairs.reconnects, 1u);
  EXPECT_GE(bench_.faults("lost: "), 1u);
  EXPECT_EQ(bench_.faults("found again"), bench_.report.pairs.reconnects);
  EXPECT_THAT(bench_.states(), HasSubstr("ended idle"));
  EXPECT_EQ(bench_.report.frames_shown + bench_.report.frames_dropped, 25u * kClipSeconds);
  EXPECT_LT(recoveredAfter(server.faultOver()), 4.0);  // 1.5 s of it to read the file to its index
}

TEST_F(PlayerNetwork, AMissingPartIsWaitedOut) {
  const std::string command = "ffmpeg -v quiet -i " + at("film.ts") +
                              " -map 0 -c copy -f hls -hls_time 2 -hls_list_size 0 -hls_segment_filename " +
                              at("part%d.ts") + " " + at("film.m3u8");
  ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT(bugprone-command-processor): the test's command
  ASSERT_TRUE(std::filesystem::remove(at("part1.ts")));
  const test::HttpServer server(at(""));
  EXPECT_FALSE(play(server.url("film.m3u8"))) << "it was not whole";
  EXPECT_EQ(bench_.faults("film.m3u8 lacks at least 1.9 s"), 1u);
  EXPECT_THAT(server.requests(), testing::Contains("GET /part1.ts 404"));
  EXPECT_THAT(bench_.states(), HasSubstr("ended idle"));
  EXPECT_NEAR(static_cast<double>(bench_.report.frames_shown + bench_.report.frames_dropped), 25 * (kClipSeconds - 2),
              5);
  EXPECT_NEAR(bench_.report.media_s, kClipSeconds, 1.0);
}

// UDP has no connection that could be cut: it falls silent, and speaks again.
TEST_F(PlayerNetwork, ABroadcastThatFallsSilentGoesOn) {
  const test::UdpSender sender(at("film.ts"), {.silent_at = 2s, .silent_for = 1500ms});
  ASSERT_TRUE(play(sender.url(), 5s));
  EXPECT_THAT(bench_.states(), HasSubstr("playing buffering playing"));
  EXPECT_LT(recoveredAfter(sender.silenceOver()), 3.0);
}

TEST_F(PlayerNetwork, ASessionThatIsCutOffIsOpenedAgain) {
  test::RtspServer camera(at("film.ts"));
  std::thread cable([&] {
    while (camera.sessions() < 1) clock_.sleepUntil(clock_.now() + 10ms);
    clock_.sleepUntil(clock_.now() + 2s);
    camera.cut(600ms);
  });
  const auto played = play(camera.url(), 6s);
  cable.join();
  ASSERT_TRUE(played);
  EXPECT_GE(camera.sessions(), 2);
  EXPECT_GE(bench_.report.pairs.reconnects, 1u);
  EXPECT_GE(bench_.faults("lost: "), 1u);
  EXPECT_EQ(bench_.faults("found again"), bench_.report.pairs.reconnects);
  EXPECT_THAT(bench_.states(), HasSubstr("playing buffering playing"));
  EXPECT_LT(recoveredAfter(camera.cutOver()), 3.0);
}

// The camera of the depth is cut off; the colour comes from a file, and not one of its pictures is late for it.
TEST_F(PlayerNetwork, DepthThatIsCutOffIsOpenedAgainBesideTheColour) {
  test::RtspServer camera(at("film.ts"));
  std::thread cable([&] {
    while (camera.sessions() < 1) clock_.sleepUntil(clock_.now() + 10ms);
    clock_.sleepUntil(clock_.now() + 2s);
    camera.cut(600ms);
  });
  const auto played = play(at("film.mkv"), 30s, camera.url());
  cable.join();
  ASSERT_TRUE(played);
  EXPECT_GE(bench_.report.pairs.depth_reconnects, 1u);
  EXPECT_EQ(bench_.report.pairs.reconnects, 0u);
  EXPECT_GE(bench_.faults("lost: "), 1u);
  EXPECT_GE(bench_.faults("no depth at this time"), 1u);
  EXPECT_GE(bench_.faults("found again"), 1u);
  EXPECT_EQ(bench_.report.frames_shown + bench_.report.frames_dropped, 25u * kClipSeconds);
  EXPECT_LT(bench_.report.pairs.without_depth, 25u * 4);
}

}  // namespace
}  // namespace relievo
