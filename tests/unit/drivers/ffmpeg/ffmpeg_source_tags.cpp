// SPDX-License-Identifier: Apache-2.0
// Films with more tags than any program writes: FFmpeg's time for them grows with the square of their number.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <filesystem>
#include <thread>

#include "tests/support/files.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

// RFC 8794: an id, a size of eight bytes, the data.
std::string bigEndian(std::uint64_t number) {
  std::string bytes;
  for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFF);
  return bytes;
}
std::string element(const std::string& id, const std::string& data) {
  return id + bigEndian(std::uint64_t{1} << 56 | data.size()) + data;
}
const std::string kTags = "\x12\x54\xC3\x67", kTag = "\x73\x73", kSimpleTag = "\x67\xC8", kName = "\x45\xA3",
                  kString = "\x44\x87";

std::string tags(int count) {
  std::string all;
  for (int i = 0; i < count; ++i)
    all += element(kSimpleTag, element(kName, "K" + std::to_string(i)) + element(kString, "v"));
  return element(kTags, element(kTag, all));
}
std::string seekTo(std::uint64_t place, const std::string& id) {
  return element("\x11\x4D\x9B\x74",
                 element("\x4D\xBB", element("\x53\xAB", id) + element("\x53\xAC", bigEndian(place))));
}

class FilmWithTags : public testing::Test {
 protected:
  FilmWithTags() { test::makeClip(path(), {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 2}}); }
  [[nodiscard]] std::string path() const { return folder_ / "film.mkv"; }

  // A copy of the film with elements before its first cluster and at its end.
  std::string with(const std::string& before, const std::string& behind = "") {
    const std::string whole = test::contentOf(path());
    const std::size_t inside = segment(whole), cluster = whole.find("\x1F\x43\xB6\x75");
    const std::string unknown = "\x01" + std::string(7, '\xFF');
    writeFile(folder_ / "more.mkv", whole.substr(0, inside - unknown.size()) + unknown +
                                        whole.substr(inside, cluster - inside) + before + whole.substr(cluster) +
                                        behind);
    return folder_ / "more.mkv";
  }
  // Where the first element that is inserted begins, in the film's own count.
  [[nodiscard]] std::uint64_t beginOfMore() const {
    const std::string whole = test::contentOf(path());
    return whole.find("\x1F\x43\xB6\x75") - segment(whole);
  }
  // Where an element behind the film begins, in the film's own count, if `before` bytes are inserted.
  [[nodiscard]] std::uint64_t endOf(std::size_t before) const {
    const std::string whole = test::contentOf(path());
    return whole.size() + before - segment(whole);
  }

 private:
  static std::size_t segment(const std::string& whole) { return whole.find("\x18\x53\x80\x67") + 12; }
  const TemporaryFolder folder_;
};

TEST_F(FilmWithTags, MoreThan5000OfMatroskaAreRefusedBeforeFFmpegReadsThem) {
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(with(tags(4990))));  // FFmpeg has written a few of its own
  EXPECT_TRUE(source->tags().contains("K4989"));
  const Error error = openErrorOf(with(tags(5001)));
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 5000 tags"));
  EXPECT_EQ(openErrorOf(with(tags(2600) + tags(2600))).code, ErrorCode::Unsupported) << "in two parts";
}

TEST_F(FilmWithTags, Over1MiBOfTagsOrChaptersIsSaidAsSuch) {
  const Error tags = openErrorOf(with(element(kTags, std::string(1100000, 'x'))));
  EXPECT_EQ(tags.code, ErrorCode::Unsupported);
  EXPECT_THAT(tags.message, HasSubstr("whose tags are longer than 1 MiB"));
  const std::string edition = element("\x45\xB9", element("\xEC", std::string(1100000, 'x')));
  const Error chapters = openErrorOf(with(element("\x10\x43\xA7\x70", edition)));
  EXPECT_EQ(chapters.code, ErrorCode::Unsupported);
  EXPECT_THAT(chapters.message, HasSubstr("whose chapters are longer than 1 MiB"));
}

TEST_F(FilmWithTags, ListsThatTakeTooMuchMemoryAreRefused) {
  const auto repeated = [](const std::string& id, const std::string& one, std::size_t bytes) {
    std::string all;
    while (all.size() < bytes) all += one;
    return element(id, all);
  };
  const std::string cues = "\x1C\x53\xBB\x6B", tracks = "\x16\x54\xAE\x6B";
  const std::string cue("\xBB\x82\xB7\x80", 4), track("\xAE\x80", 2);
  const Error places = openErrorOf(with(repeated(cues, cue, 25'500'000)));
  EXPECT_EQ(places.code, ErrorCode::Unsupported);
  EXPECT_THAT(places.message, HasSubstr("places to seek to"));
  EXPECT_THAT(openErrorOf(with(repeated(tracks, track, 4'200'000))).message, HasSubstr("list of tracks"));
  EXPECT_TRUE(makeFfmpegSource()->open(with(repeated(cues, cue, 100'000)))) << "of a usual length";
}

TEST_F(FilmWithTags, ThoseThatASeekHeadPointsToAreCountedOnce) {
  const std::uint64_t place = beginOfMore() + seekTo(0, kTags).size();
  EXPECT_TRUE(makeFfmpegSource()->open(with(seekTo(place, kTags) + tags(3000))));
}

TEST_F(FilmWithTags, TheyAreCountedAtTheEndOfTheFileToo) {
  const std::uint64_t end = endOf(seekTo(0, kTags).size());
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(with(seekTo(end, kTags), tags(100))));
  ASSERT_TRUE(source->tags().contains("K99")) << "FFmpeg does not look there";
  EXPECT_EQ(openErrorOf(with(seekTo(end, kTags), tags(5001))).code, ErrorCode::Unsupported);
}

// Threads that compute, this one among them.
int computing() {
  int count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task"))
    count += test::contentOf(task.path() / "stat").find(") R ") != std::string::npos ? 1 : 0;
  return count;
}
double processorSeconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

// Tags behind more elements than are looked at: FFmpeg takes seconds for them, in which it does not ask whether to go
// on.
TEST_F(FilmWithTags, InterruptEndsAnOpeningWhichFFmpegDoesNotEnd) {
  std::string empty;
  for (int i = 0; i < 1001; ++i) empty += "\xEC\x80";
  const std::string film = with(empty + tags(15000));
  const auto source = makeFfmpegSource();
  std::thread other([&, began = processorSeconds()] {
    while (processorSeconds() < began + 0.5) std::this_thread::yield();  // it has begun
    source->interrupt();
  });
  const auto opened = source->open(film);
  other.join();
  const int at_work = computing();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(at_work, 2) << "FFmpeg has ended: it has to take longer";
  EXPECT_TRUE(source->open(path())) << "the next film is not held up";
  for (int waits = 0; computing() > 1 && waits < 3000; ++waits)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace
}  // namespace relievo
