// SPDX-License-Identifier: Apache-2.0
// What counts as the memory of an opening, and who goes on to get large blocks.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>
#include <limits>
#include <memory>
#include <thread>

#include "drivers/ffmpeg/library.h"
#include "drivers/ffmpeg/opening/memory.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

extern "C" {
#include <libavutil/mem.h>
}

namespace relievo {
namespace {

using ffmpeg::OpeningMemory;

constexpr std::size_t kTooMuch = ffmpeg::kMostOpeningBytes + 50'000'000;

// Whether it exceeds while that much memory is held, mapped with those flags.
bool exceedsWith(int flags, bool on_another_thread) {
  OpeningMemory memory;
  memory.begin();
  void* const block = ::mmap(nullptr, kTooMuch, PROT_READ | PROT_WRITE, flags | MAP_ANONYMOUS, -1, 0);
  ::madvise(block, kTooMuch, MADV_NOHUGEPAGE);  // which are not told by thread
  const auto fill = [block] { std::memset(block, 1, kTooMuch); };
  if (on_another_thread) std::thread(fill).join();
  else fill();
  const bool exceeded = memory.exceeded();
  static_cast<void>(memory.end());
  ::munmap(block, kTooMuch);
  return exceeded;
}

TEST(OpeningMemory, IsThatOfItsThreadAlone) {
  EXPECT_TRUE(exceedsWith(MAP_PRIVATE, false));
  EXPECT_FALSE(exceedsWith(MAP_PRIVATE, true)) << "another part of the program took it";
  EXPECT_FALSE(exceedsWith(MAP_SHARED, false)) << "as files and a graphics processor's memory are";
}

bool hasLargeBlocks() {
  const std::unique_ptr<void, decltype(&av_free)> block(av_malloc(2'000'000), av_free);
  return block != nullptr;
}

TEST(OpeningMemory, RefusedBlocksAreGivenWhileAFilmPlays) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "film.mkv", {kH264});
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(folder / "film.mkv"));
  ffmpeg::refuseLargeBlocks(true);
  EXPECT_TRUE(hasLargeBlocks());
  source->close();
  EXPECT_FALSE(hasLargeBlocks());
  {
    const auto decoder = makeFfmpegDecoder();
    EXPECT_TRUE(hasLargeBlocks());
  }
  EXPECT_FALSE(hasLargeBlocks());
  ffmpeg::refuseLargeBlocks(false);
  EXPECT_TRUE(hasLargeBlocks());
}

// As app/coding/video_encoder.h does.
TEST(OpeningMemory, AnEncoderKeepsTheBlocksThatItNeeds) {
  boundFfmpegBlocks();
  constexpr std::size_t kFfmpegs = std::numeric_limits<int>::max();
  av_max_alloc(kFfmpegs);
  ffmpeg::refuseLargeBlocks(true);
  ffmpeg::refuseLargeBlocks(false);
  const std::unique_ptr<void, decltype(&av_free)> block(av_malloc(301'000'000), av_free);
  EXPECT_NE(block, nullptr);
  av_max_alloc(kFfmpegs);
}

}  // namespace
}  // namespace relievo
