// SPDX-License-Identifier: Apache-2.0
// What `relievo probe` prints about a source and about the plan.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/scenario/program/player_program.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/ts_patch.h"
#include "tests/support/machine/process.h"
#include "tests/support/machine/program.h"
#include "tests/support/network/http_server.h"

namespace relievo::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(PlayerProgram, TellsTheDepthOfABroadcastByItsStreamType) {
  ClipTrack plain = color();
  plain.codec = "libx264";
  plain.tags.clear();
  makeClip(at("film.ts"), {plain, plain});
  ASSERT_GT(signalAsDepth(at("film.ts"), 0), 0);
  const auto text = runProgram("relievo probe " + at("film.ts"), at(""));
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("0 video h264 64 x 48, signalled as depth by its stream type, "));
  const auto result = runProgram("relievo probe --json " + at("film.ts"), at(""));
  const json r = json::parse(result.out, nullptr, false);
  ASSERT_FALSE(r.is_discarded());
  EXPECT_EQ(r["tracks"][0]["auxiliary"], true);
  EXPECT_EQ(r["tracks"][1]["auxiliary"], false);
  EXPECT_TRUE(r["depth"].is_object());
}

TEST_F(PlayerProgram, KindsOfRecordingsAreListedAndStated) {
  const auto listed = runProgram("relievo play --as help", at(""));
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  for (const char* kind : {"\ntum ", "\nkitti ", "\nrecord3d ", "\nsun "}) EXPECT_THAT(listed.out, HasSubstr(kind));
  expectOneLine(runProgram("relievo probe --as nothing film.mkv", at("")), 2, "unknown kind; see --as help");
  expectOneLine(runProgram("relievo probe --calibration unit=1,polarity=near-high film.mkv", at("")), 2,
                "polarity=near-high; leave one out");

  ClipTrack slope = depth(3);
  slope.sample = [](int, int c, int, int) { return 5000u + 100u * static_cast<unsigned>(c); };
  makeClip(at("film.mkv"), {color(3), slope});
  const auto stated = runProgram("relievo probe --as tum " + at("film.mkv"), at(""));
  EXPECT_EQ(stated.exit_code, 0) << stated.err;
  EXPECT_THAT(stated.out, HasSubstr("reading depth distances, 5000 codes a metre, 0.90 to 2.49 m"));
  EXPECT_THAT(stated.out, HasSubstr("unit=0.2: --as, said"));
}

TEST_F(PlayerProgram, ProbeTellsTheFilmAndTheDepthOfAFolder) {
  std::filesystem::create_directory(at("take"));
  ClipTrack pictures = depth(3);
  pictures.codec = "png";
  pictures.pix_fmt = "gray16be";
  makeClip(at("take/color.mkv"), {color(3)});
  makeClip(at("take/depth-%d.png"), {pictures});
  const auto told = runProgram("relievo probe " + at("take"), at(""));
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("track   " + at("take/color.mkv") + " 0 video"));
  EXPECT_THAT(told.out, HasSubstr("track   " + at("take/depth-*.png") + " 0 video png"));
}

// A DVD's colour with depth whose file does not say that its samples are wide.
TEST_F(PlayerProgram, TheBoxHasTheShapeOfTheColour) {
  ClipTrack wide = color(3), squeezed = depth(3);
  for (ClipTrack* const track : {&wide, &squeezed}) {
    track->width = 90;
    track->height = 72;
  }
  wide.sample_width = 64;
  wide.sample_height = 45;
  makeClip(at("film.mkv"), {wide, squeezed});
  const auto result = runProgram("relievo probe " + at("film.mkv"), at(""));
  EXPECT_THAT(result.out, HasSubstr("volume  160 x 90 x 40 mm"));
  EXPECT_THAT(result.err + result.out, HasSubstr("the depth 1.25: both are shown in the colour's shape"));
}

TEST_F(PlayerProgram, ProbeTellsWhatIsInASource) {
  ClipTrack plane = depth(5);
  plane.sample = [](int, int c, int, int) { return c < 32 ? 1000u : 65000u; };
  plane.tags["DEPTH_LAW"] = "inverse";
  makeClip(at("film.mkv"), {color(5), plane});
  const auto text = runProgram("relievo probe " + at("film.mkv"), at(""));
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("law=inverse: container tags, said"));
  EXPECT_THAT(text.out, HasSubstr("codes 1000 to 65000"));
  const auto as_json = runProgram("relievo probe --json " + at("film.mkv"), at(""));
  const json j = json::parse(as_json.out, nullptr, false);
  ASSERT_FALSE(j.is_discarded());
  EXPECT_EQ(j["tracks"].size(), 2u);
  EXPECT_EQ(j["packing"], "tracks");
  EXPECT_EQ(j["depth"]["codes"], (json{1000, 65000}));
  EXPECT_EQ(j["color"]["width"], 64);

  // The tracks are listed whatever is wrong with the film in them.
  const auto refused = runProgram("relievo probe --calibration bits=8,near=9000 " + at("film.mkv"), at(""));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.out, HasSubstr("0 video ffv1 64 x 48, yuv420p of 8 bits, 30 frames a second \"color\""));
  EXPECT_THAT(refused.out, HasSubstr("1 video ffv1 64 x 48, gray16le of 16 bits, 30 frames a second \"depth\""));
  EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;

  makeClip(at("flat.mkv"), {color(5)});
  EXPECT_THAT(runProgram("relievo probe " + at("flat.mkv"), at("")).out, HasSubstr("give --depth"));
}

// A still relief, another one from the third picture on, and from the fifth on it rises fast: the plan is that of the
// first four pictures, in which nothing moves but at the cut.
TEST_F(PlayerProgram, ProbeAnnouncesThePlanOfThePlayer) {
  ClipTrack moving = depth();
  moving.sample = [](int, int c, int r, int k) {
    const int wave = k < 2 ? 900 * c : 900 * (63 - c);
    return static_cast<std::uint32_t>(wave + 40 * r + 500 * std::max(k - 3, 0));
  };
  makeClip(at("film.mkv"), {color(), moving});
  const auto probed = runProgram("relievo probe --json " + at("film.mkv"), at(""));
  ASSERT_EQ(probed.exit_code, 0) << probed.err;
  const json said = json::parse(probed.out);
  ASSERT_EQ(play(at("film.mkv") + " --report " + at("r.json")).exit_code, 0);
  EXPECT_EQ(said["touch"]["reason"], reportOf("r.json")["haptic"]["plan"]);
  EXPECT_EQ(said["touch"]["speed_mm_per_s"], 0) << "a cut is no motion";
}

TEST_F(PlayerProgram, ProbeSaysWhatItWaitsFor) {
  ASSERT_EQ(::mkfifo(at("film.mkv").c_str(), 0600), 0);  // nobody writes to it
  Process probe({RELIEVO_BIN_DIR "/relievo", "probe", at("film.mkv")}, at("said.txt"));
  const auto said = [&] { return contentOf(at("said.txt")); };
  while (probe.isRunning() && said().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_THAT(said(), HasSubstr("waiting for \"" + at("film.mkv") + "\" (up to 30 s)"));
  probe.send(SIGKILL);
  EXPECT_EQ(probe.wait(), -SIGKILL);
}

// FFmpeg takes it for a film without tracks: it was waited for twice.
TEST_F(PlayerProgram, AListWhosePartsAreSilentIsWaitedForOnce) {
  std::ofstream(at("list.m3u8"))
      << "#EXTM3U\n#EXT-X-STREAM-INF:BANDWIDTH=1\na.m3u8\n#EXT-X-STREAM-INF:BANDWIDTH=2\nb.m3u8\n";
  for (const char* part : {"a.m3u8", "b.m3u8"}) std::ofstream(at(part)) << "#EXTM3U\n";
  HttpServer server(at(""));
  for (const char* part : {"a.m3u8", "b.m3u8"}) server.faults[part] = {.stall = std::chrono::minutes(5)};
  const auto probed = runProgram("relievo probe " + server.url("list.m3u8"), at(""));
  EXPECT_EQ(probed.exit_code, 1);
  EXPECT_THAT(probed.err, HasSubstr("none of its parts can be opened"));
  const std::size_t told = probed.err.find("waiting for");
  EXPECT_NE(told, std::string::npos) << probed.err;
  EXPECT_EQ(probed.err.find("waiting for", told + 1), std::string::npos) << probed.err;
}

}  // namespace
}  // namespace relievo::test
