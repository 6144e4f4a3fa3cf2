// SPDX-License-Identifier: Apache-2.0
// Subtitle files that are added to a FilmFeed while it plays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/media/feed/film_feed_stage.h"

namespace relievo::test {
namespace {

// Each packet is a line.
class LineDecoder final : public SubtitleDecoder {
 public:
  Result<void> open(const StreamInfo&) override { return {}; }
  std::optional<Subtitle> decode(const Packet& packet) override {
    return Subtitle{.begin = packet.pts.value_or(MediaTime{}), .end = {}, .lines = {"0,0,Default,,0,0,0,,a line"}};
  }
  void flush() noexcept override {}
};

class FilmFeedWords : public FilmFeedTest {
 protected:
  // A film with two sound tracks; "words" has three lines, "broken" has none.
  FilmFeedWords() {
    MockMediaProfile film = filmOf(100);
    for (int i = 0; i < 2; ++i)
      film.tracks.push_back({.kind = StreamKind::Audio, .frames = 100, .frame_period = kPeriod});
    PairReader::Backends parts = backends(film, clock_);
    parts.make_source = [this, film](const std::string& url) {
      opened_.push_back(url);
      if (url == "broken") return makeMockSource({.tracks = {}}, clock_);
      const MockTrack words{.kind = StreamKind::Audio, .frames = 3, .frame_period = kPeriod};
      return makeMockSource(url == "words" ? MockMediaProfile{.tracks = {words}} : film, clock_);
    };
    parts.make_audio_decoder = makeMockAudioDecoder;
    parts.make_subtitle_decoder = [] { return std::make_unique<LineDecoder>(); };
    feed_ = std::make_unique<FilmFeed>(std::move(parts), kCapacity);
    feed_->open({.url = "mock", .sound = AudioFormat{}});
    workAll();
  }
  void choose(std::optional<std::size_t> sound, std::optional<std::size_t> words) {
    feed_->chooseTracks(sound, words);
    workAll();
  }
  int takeWords() {
    int lines = 0;
    while (feed_->takeSubtitle()) ++lines;
    return lines;
  }
  [[nodiscard]] std::ptrdiff_t timesOpened(const std::string& url) const { return std::ranges::count(opened_, url); }

  std::vector<std::string> opened_;
};

TEST_F(FilmFeedWords, OfAFileAreReadOnceWhateverSoundIsChosenThen) {
  feed_->addSubtitles({.path = "words"});
  choose(0, 0);
  choose(1, 0);
  EXPECT_EQ(takeWords(), 3) << "those that nobody has taken yet are still there";
  choose(0, 0);
  EXPECT_EQ(takeWords(), 0);
  EXPECT_EQ(feed_->info().sound, 0u);
  EXPECT_EQ(timesOpened("words"), 1);
  choose(0, std::nullopt);
  choose(0, 0);
  EXPECT_EQ(takeWords(), 3) << "chosen again, they are read again";
  feed_->chooseTracks(0, std::nullopt);
  choose(0, 0);
  EXPECT_EQ(takeWords(), 3) << "also if the reader was busy in between";
}

TEST_F(FilmFeedWords, OfAFileThatIsRefusedAreNotChosen) {
  feed_->addSubtitles({.path = "words"});
  feed_->addSubtitles({.path = "broken"});
  choose(0, 1);
  EXPECT_EQ(feed_->info().words, std::nullopt);
  const auto news = feed_->takeNews();
  ASSERT_TRUE(news);
  EXPECT_EQ(news->kind, FilmFeed::News::Kind::WordsRefused);
  EXPECT_EQ(news->track, 1u);
  choose(1, std::nullopt);
  EXPECT_FALSE(feed_->takeNews()) << "it is not tried again";
  choose(1, 0);
  EXPECT_EQ(feed_->info().words, 0u);
  EXPECT_EQ(takeWords(), 3);
}

}  // namespace
}  // namespace relievo::test
