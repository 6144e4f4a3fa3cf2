// SPDX-License-Identifier: Apache-2.0
// Five hundred damaged films, each played in its own process: it plays or ends with a clean error; it never crashes,
// hangs or exhausts the memory.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "app/scene/color/color_curve.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/damage.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

constexpr int kFilesOfAKind = 125;
constexpr rlim_t kMostCpuS = 5;
constexpr long kMostKb = 512 * 1024;
constexpr int kPlayed = 10, kRefused = 11;

// Exit status of the process that played `film`, and its peak memory.
struct End {
  int status = 0;
  rusage used{};
};
End playApart(const std::string& film) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit cpu{.rlim_cur = kMostCpuS, .rlim_max = kMostCpuS};
    ::setrlimit(RLIMIT_CPU, &cpu);
    ::alarm(100);  // ends a process that hangs
    PlayerBench bench;
    bench.make_source = makeFfmpegSource;
    bench.make_decoder = makeFfmpegDecoder;
    bench.config.source.url = film;
    bench.config.duration = std::chrono::seconds(3);
    bench.press(0.5, 106);  // right: a seek
    const auto played = bench.run();
    ::_exit(played ? kPlayed : kRefused);  // not 1, which a sanitizer uses
  }
  End end;
  ::wait4(child, &end.status, 0, &end.used);
  return end;
}

class HostileFiles : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Containers, HostileFiles, testing::Values("mkv", "mp4", "ts", "webm"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(HostileFiles, PlayOrFailCleanly) {
  const test::TemporaryFolder folder;
  const std::string whole = folder / (std::string("whole.") + GetParam()),
                    film = folder / (std::string("x.") + GetParam());
  const std::string codec = std::string(GetParam()) == "webm" ? "libvpx" : "libx264";
  const test::ClipTrack track{.codec = codec, .pix_fmt = "yuv420p", .width = 64, .height = 48, .frames = 40};
  test::makeClip(whole, {track, track});
  const std::string bytes = test::contentOf(whole);
  for (const DepthCode code : kDepthCodes) static_cast<void>(curveOf(code));  // here, or each process makes them
  ASSERT_EQ(WEXITSTATUS(playApart(whole).status), kPlayed);

  int played = 0;
  for (int i = 0; i < kFilesOfAKind; ++i) {
    std::mt19937 random(static_cast<unsigned>(i));
    std::ofstream(film, std::ios::binary) << test::damaged(bytes, random);
    const End end = playApart(film);
    ASSERT_TRUE(WIFEXITED(end.status)) << "file " << i << " ended it with signal " << WTERMSIG(end.status);
    const int code = WEXITSTATUS(end.status);
    ASSERT_TRUE(code == kPlayed || code == kRefused) << "file " << i << " ended it with code " << code;
    if (!kMemorySanitizer) {
      ASSERT_LT(end.used.ru_maxrss, kMostKb) << "file " << i;
    }
    played += code == kPlayed ? 1 : 0;
  }
  // If all or none of the films played, the damage would be too little or too much to test anything.
  EXPECT_GT(played, kFilesOfAKind / 10);
  EXPECT_LT(played, kFilesOfAKind);
}

}  // namespace
}  // namespace relievo
