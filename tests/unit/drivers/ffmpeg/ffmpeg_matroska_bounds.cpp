// SPDX-License-Identifier: Apache-2.0
// Matroska films with longer lists than any program writes: FFmpeg takes minutes for tags, and much memory for each.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
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

const std::string kTracks = "\x16\x54\xAE\x6B", kCues = "\x1C\x53\xBB\x6B", kAttachments = "\x19\x41\xA4\x69";
// Empty ones.
const std::string kVoid = "\xEC\x80", kTrack = "\xAE\x80", kCue = "\xBB\x82\xB7\x80", kAttachment = "\x61\xA7\x80";

std::string repeated(const std::string& one, std::size_t count) {
  std::string all;
  all.reserve(count * one.size());
  for (std::size_t i = 0; i < count; ++i) all += one;
  return all;
}

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

class MatroskaFilm : public testing::Test {
 protected:
  MatroskaFilm() { test::makeClip(path(), {ClipTrack{.codec = "libx264", .pix_fmt = "yuv420p", .frames = 2}}); }
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

  // A copy of such a film with something between its header and its segment.
  std::string within(const std::string& film, const std::string& more) {
    const std::string whole = test::contentOf(film);
    const std::size_t begin = segment(whole) - 12;  // an id and its size
    writeFile(folder_ / "within.mkv", whole.substr(0, begin) + more + whole.substr(begin));
    return folder_ / "within.mkv";
  }
  std::string withoutHeaderSize(const std::string& film) {
    const std::string whole = test::contentOf(film), id = whole.substr(0, 4);
    const std::size_t size_bytes = whole[4] == '\1' ? 8 : 1;  // as FFmpeg writes it
    writeFile(folder_ / "sizeless.mkv", id + "\x01" + std::string(7, '\xFF') + whole.substr(4 + size_bytes));
    return folder_ / "sizeless.mkv";
  }

 private:
  static std::size_t segment(const std::string& whole) { return whole.find("\x18\x53\x80\x67") + 12; }
  const TemporaryFolder folder_;
};

TEST_F(MatroskaFilm, WithMoreThan5000TagsIsRefusedBeforeFFmpegReadsThem) {
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(with(tags(4990))));  // FFmpeg has written a few of its own
  EXPECT_TRUE(source->tags().contains("K4989"));
  const Error error = openErrorOf(with(tags(5001)));
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 5000 tags"));
  EXPECT_EQ(openErrorOf(with(tags(2600) + tags(2600))).code, ErrorCode::Unsupported) << "in two parts";
}

TEST_F(MatroskaFilm, WithOver1MiBOfTagsOrChaptersIsSaidToBeSo) {
  const Error tags = openErrorOf(with(element(kTags, std::string(1100000, 'x'))));
  EXPECT_EQ(tags.code, ErrorCode::Unsupported);
  EXPECT_THAT(tags.message, HasSubstr("whose tags are longer than 1 MiB"));
  const std::string edition = element("\x45\xB9", element("\xEC", std::string(1100000, 'x')));
  const Error chapters = openErrorOf(with(element("\x10\x43\xA7\x70", edition)));
  EXPECT_EQ(chapters.code, ErrorCode::Unsupported);
  EXPECT_THAT(chapters.message, HasSubstr("whose chapters are longer than 1 MiB"));
}

TEST_F(MatroskaFilm, WithListsThatTakeTooMuchMemoryIsRefused) {
  const Error places = openErrorOf(with(element(kCues, repeated(kCue, 25'500'000 / kCue.size()))));
  EXPECT_EQ(places.code, ErrorCode::Unsupported);
  EXPECT_THAT(places.message, HasSubstr("places to seek to"));
  EXPECT_TRUE(makeFfmpegSource()->open(with(element(kCues, repeated(kCue, 25'000))))) << "of a usual length";
  const std::string of_nothing = element(kCues, repeated(kCue, 1'300'000));
  EXPECT_THAT(openErrorOf(with(of_nothing)).message, HasSubstr("2.5 million points and positions"));
  const std::string damaged = element(kCues, std::string(100, '\0') + of_nothing);
  EXPECT_THAT(openErrorOf(with(damaged)).message, HasSubstr("2.5 million points and positions"));
  const std::string half = element(kCues, repeated(kCue, 650'000));
  EXPECT_THAT(openErrorOf(with(half + half)).message, HasSubstr("2.5 million points and positions"));
  // As FFmpeg writes them: ten hours of 30 key frames a second.
  const std::string written =
      "\xBB\x94\xB3\x84\x01\x02\x03\x04\xB7\x8C\xF7\x81\x01\xF1\x84\x01\x02\x03\x04\xF0\x81\x10";
  EXPECT_TRUE(makeFfmpegSource()->open(with(element(kCues, repeated(written, 1'080'000)))));
  EXPECT_THAT(openErrorOf(with(element(kTracks, element("\xEC", std::string(4'200'000, 'x'))))).message,
              HasSubstr("list of tracks"));
  EXPECT_THAT(openErrorOf(with(element(kTracks, repeated(kTrack, 1001)))).message, HasSubstr("1000 tracks"));
}

// Three million without a name took 200 MB and 6 s.
TEST_F(MatroskaFilm, WithMoreThan1000AttachmentsOr128MiBOfThemIsRefused) {
  EXPECT_TRUE(makeFfmpegSource()->open(with(element(kAttachments, repeated(kAttachment, 1000)))));
  const Error error = openErrorOf(with(element(kAttachments, repeated(kAttachment, 1001))));
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 1000 attachments or 128 MiB"));
  const std::string long_one = kAttachments + bigEndian(std::uint64_t{1} << 56 | 135'000'000);
  EXPECT_TRUE(makeFfmpegSource()->open(with("", long_one))) << "nothing points there";
  const std::string points = seekTo(endOf(seekTo(0, kAttachments).size()), kAttachments);
  EXPECT_THAT(openErrorOf(with(points, long_one)).message, HasSubstr("128 MiB"));
}

TEST_F(MatroskaFilm, ElementsOfAKindAreBoundedTogether) {
  const std::string part = element(kTags, element("\xEC", std::string(400'000, 'x')));
  EXPECT_TRUE(makeFfmpegSource()->open(with(repeated(part, 2))));
  EXPECT_THAT(openErrorOf(with(repeated(part, 3))).message, HasSubstr("tags are longer than 1 MiB"));
}

TEST_F(MatroskaFilm, NothingHidesBehindManyElements) {
  EXPECT_TRUE(makeFfmpegSource()->open(with(repeated(kVoid, 900))));
  const Error error = openErrorOf(with(repeated(kVoid, 1001) + element(kAttachments, repeated(kAttachment, 3000))));
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 1000 elements before its pictures"));
  std::string elsewhere;
  for (std::uint64_t place = 0; place < 65; ++place) elsewhere += seekTo(place, kTags);
  EXPECT_EQ(openErrorOf(with(elsewhere)).code, ErrorCode::Unsupported) << "in places that are sought";
}

// Only segments and clusters may, but FFmpeg read others, and old programs wrote them into a pipe.
TEST_F(MatroskaFilm, NothingHidesInAnElementWithoutASize) {
  const std::string unknown = "\xFF";
  EXPECT_TRUE(makeFfmpegSource()->open(with(kAttachments + unknown + repeated(kAttachment, 900))));
  EXPECT_EQ(openErrorOf(with(kAttachments + unknown + repeated(kAttachment, 3000))).code, ErrorCode::Unsupported);
  const std::string many = tags(5001);
  EXPECT_EQ(openErrorOf(with(kTags + unknown + many.substr(kTags.size() + 8))).code, ErrorCode::Unsupported);
  EXPECT_EQ(openErrorOf(with(element(kAttachments, kAttachment.substr(0, 2) + unknown + repeated(kVoid, 3000)))).code,
            ErrorCode::Unsupported)
      << "inside of another";
}

// FFmpeg goes on with the next list or cluster.
TEST_F(MatroskaFilm, NothingHidesBehindDamage) {
  const std::string garbage(100'000, '\0'), many = element(kAttachments, repeated(kAttachment, 3000));
  EXPECT_TRUE(makeFfmpegSource()->open(with(garbage)));
  EXPECT_EQ(openErrorOf(with(garbage + many)).code, ErrorCode::Unsupported);
  EXPECT_EQ(openErrorOf(with(element(kAttachments, kAttachment + garbage + many))).code, ErrorCode::Unsupported);
  const std::string long_info = element("\x15\x49\xA9\x66", std::string(1'100'000, '\0'));
  EXPECT_EQ(openErrorOf(with(long_info)).code, ErrorCode::Unsupported) << "what is in it is not looked at";
}

// FFmpeg opens each of them.
TEST_F(MatroskaFilm, NothingHidesBehindWhatStandsBeforeItsSegment) {
  for (const std::string& between : {kVoid, std::string(50, '\0'), kVoid + std::string(50, '\0')}) {
    EXPECT_TRUE(makeFfmpegSource()->open(within(with(tags(100)), between)));
    EXPECT_EQ(openErrorOf(within(with(tags(5001)), between)).code, ErrorCode::Unsupported);
  }
  EXPECT_TRUE(makeFfmpegSource()->open(withoutHeaderSize(with(tags(100)))));
  EXPECT_EQ(openErrorOf(withoutHeaderSize(with(tags(5001)))).code, ErrorCode::Unsupported);
}

// Some programs list all clusters.
TEST_F(MatroskaFilm, ItsClustersMayBeListed) {
  std::string all;
  for (std::uint64_t cluster = 0; cluster < 10'000; ++cluster)
    all += seekTo(cluster, "\x1F\x43\xB6\x75").substr(12);  // one seek of a head
  EXPECT_TRUE(makeFfmpegSource()->open(with(element(seekTo(0, kTags).substr(0, 4), all))));
}

TEST_F(MatroskaFilm, TagsThatASeekHeadPointsToAreCountedOnce) {
  const std::uint64_t place = beginOfMore() + seekTo(0, kTags).size();
  EXPECT_TRUE(makeFfmpegSource()->open(with(seekTo(place, kTags) + tags(3000))));
}

TEST_F(MatroskaFilm, TagsAreCountedAtTheEndOfTheFileToo) {
  const std::uint64_t end = endOf(seekTo(0, kTags).size());
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(with(seekTo(end, kTags), tags(100))));
  ASSERT_TRUE(source->tags().contains("K99")) << "FFmpeg does not look there";
  EXPECT_EQ(openErrorOf(with(seekTo(end, kTags), tags(5001))).code, ErrorCode::Unsupported);
}

// The threads of this process, without one that has been joined a moment ago.
int threads() {
  int least = 1000;
  for (int looks = 0; looks < 10; ++looks) {
    int count = 0;
    for ([[maybe_unused]] const auto& task : std::filesystem::directory_iterator("/proc/self/task")) ++count;
    least = std::min(least, count);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return least;
}
double processorSeconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

// Tags that come through a pipe, which nobody can look at before: when it has read them, FFmpeg computes for seconds,
// in which it does not ask whether to go on.
TEST_F(MatroskaFilm, InterruptEndsAnOpeningWhichFFmpegDoesNotEnd) {
  const std::string film = path() + ".pipe";
  ASSERT_EQ(::mkfifo(film.c_str(), 0600), 0);
  std::string content;
  double takes = 0;  // FFmpeg, for all of it, on this machine
  for (int count = 10'000; takes < 1 && count <= 400'000; count += count / 2) {
    content = test::contentOf(with(tags(count)));
    std::thread writer([&] { writeFile(film, content); });
    const double begun = processorSeconds();
    const bool opened = makeFfmpegSource()->open(film).has_value();
    takes = processorSeconds() - begun;
    writer.join();
    ASSERT_TRUE(opened);
  }
  if (takes < 1) GTEST_SKIP() << "FFmpeg reads 300,000 tags in " << takes << " s";
  const auto source = makeFfmpegSource();
  const int before = threads();
  std::thread other([&] {
    writeFile(film, content);
    const double written = processorSeconds();
    while (processorSeconds() < written + 0.1) std::this_thread::yield();  // what the pipe still held is read
    source->interrupt();
  });
  const auto opened = source->open(film);
  other.join();
  const int left = threads() - before;
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(left, 1) << "FFmpeg has ended: it has to take longer";
  EXPECT_TRUE(source->open(path())) << "the next film is not held up";
  for (int waits = 0; threads() > before && waits < 500; ++waits)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

}  // namespace
}  // namespace relievo
