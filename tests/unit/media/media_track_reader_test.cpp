// SPDX-License-Identifier: Apache-2.0
// Two tracks of one source: bounded queues, badly interleaved and short tracks, seeks that land too late; its end.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <future>
#include <vector>

#include "app/media/pairs/open_sources.h"
#include "app/media/tracks/track_reader.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;

struct Scripted {
  int stream = 0;
  int ms = 0;
  bool keyframe = true;
};

// Sound is stream 2. Packets come in the order of the script. A seek lands `late` packets after the last key frame of
// stream 0 at or before the target.
class ScriptedSource final : public MediaSource {
 public:
  explicit ScriptedSource(std::vector<Scripted> script, std::size_t late = 0)
      : script_(std::move(script)), late_(late) {}
  ~ScriptedSource() override {
    if (closing) closing();
  }
  std::function<void()> closing;
  std::size_t position = 0;
  int seeks = 0;
  std::size_t packet_bytes = 1;

 private:
  Result<Description> openSource(const std::string&) override {
    Description description;
    for (int i = 0; i < 3; ++i) {
      StreamInfo stream;
      stream.index = i;
      stream.kind = i < 2 ? StreamKind::Video : StreamKind::Audio;
      description.streams.push_back(stream);
    }
    return description;
  }
  Result<std::optional<Packet>> readPacket() override {
    if (position == script_.size()) return std::nullopt;
    const Scripted& entry = script_[position++];
    Packet packet;
    packet.stream = entry.stream;
    packet.pts = MediaTime(milliseconds(entry.ms));
    packet.keyframe = entry.keyframe;
    packet.bytes = packet_bytes;
    return packet;
  }
  Result<void> seekTo(MediaTime target) override {
    ++seeks;
    position = 0;
    for (std::size_t i = 0; i < script_.size(); ++i) {
      const bool key = script_[i].stream == 0 && script_[i].keyframe;
      if (key && MediaTime(milliseconds(script_[i].ms)) <= target) position = i;
    }
    if (target > MediaTime{}) position = std::min(position + late_, script_.size());
    return {};
  }
  void closeSource() noexcept override {}
  void interrupted() noexcept override {}

  std::vector<Scripted> script_;
  std::size_t late_;
};

// One picture per packet. Counts the pictures in use, and refuses more than the limit.
class OneToOneDecoder final : public VideoDecoder {
 public:
  explicit OneToOneDecoder(int max_held = 1000) : max_held_(max_held) {}
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {"one-to-one", max_held_, false}; }

 private:
  Result<void> openDecoder(const StreamInfo&) override { return {}; }
  Result<Feed> feedPacket(const Packet& packet) override {
    if (waiting_ || held_.use_count() > max_held_) return Feed::Full;
    waiting_ = packet.pts;
    return Feed::Accepted;
  }
  Result<Progress> receiveFrame(Frame& frame) override {
    if (!waiting_) return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
    frame.pts = *waiting_;
    frame.owner = held_;
    waiting_.reset();
    return Progress::Picture;
  }
  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  Result<void> flushDecoder() override {
    draining_ = false;
    waiting_.reset();
    return {};
  }
  void closeDecoder() noexcept override {}

  int max_held_;
  std::shared_ptr<int> held_ = std::make_shared<int>();
  std::optional<MediaTime> waiting_;
  bool draining_ = false;
};

// One sample per packet; its value is the time in ms.
class SampleDecoder final : public AudioDecoder {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "sample"; }
  std::uint64_t lose_after = 1000;

 private:
  Result<void> openDecoder(const StreamInfo&, const AudioFormat&) override { return {}; }
  Result<AudioChunk> decodePacket(const Packet& packet) override {
    if (decoded_++ == lose_after) return fail(ErrorCode::Unsupported, "no more");
    return AudioChunk{*packet.pts, {static_cast<float>(packet.pts->time_since_epoch() / milliseconds(1))}};
  }
  void flushDecoder() noexcept override {}
  void closeDecoder() noexcept override {}
  std::uint64_t decoded_ = 0;
};

struct Film {
  ScriptedSource* source = nullptr;
  std::unique_ptr<TrackReader> reader;

  explicit Film(std::vector<Scripted> script, std::size_t late = 0, int max_held = 1000) {
    auto owned = std::make_unique<ScriptedSource>(std::move(script), late);
    source = owned.get();
    reader = std::make_unique<TrackReader>(
        std::move(owned), [max_held](const StreamInfo&) { return std::make_unique<OneToOneDecoder>(max_held); });
    EXPECT_TRUE(reader->open("").has_value());
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(reader->select(source->streams()[static_cast<std::size_t>(i)]).has_value());
  }
  SampleDecoder& listen() {
    auto decoder = std::make_unique<SampleDecoder>();
    SampleDecoder& ear = *decoder;
    EXPECT_TRUE(reader->listen(std::move(decoder), source->streams()[2], {}).has_value());
    return ear;
  }
  // Times in ms of all the sound read so far.
  std::vector<int> sound() {
    std::vector<int> times;
    while (const auto chunk = reader->nextSound()) times.push_back(static_cast<int>(chunk->samples[0]));
    return times;
  }
  // The next picture's time in ms, -1 for none.
  int next(std::size_t track) {
    const auto frame = reader->next(track).value();
    return frame ? static_cast<int>((*frame).pts.time_since_epoch() / milliseconds(1)) : -1;
  }
};

std::vector<Scripted> interleaved(int count, int gop) {
  std::vector<Scripted> script;
  for (int k = 0; k < count; ++k) {
    script.push_back({0, 40 * k, k % gop == 0});
    script.push_back({1, 40 * k, k % gop == 0});
  }
  return script;
}

TEST(TrackReader, GivesEachTrackInOrderWhicheverIsAsked) {
  Film film(interleaved(10, 1));
  for (int k = 0; k < 5; ++k) EXPECT_EQ(film.next(0), 40 * k);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(film.next(1), 40 * k);
  EXPECT_EQ(film.next(1), -1);
  EXPECT_TRUE(film.reader->ended(1));
  EXPECT_FALSE(film.reader->ended(0));
  for (int k = 5; k < 10; ++k) EXPECT_EQ(film.next(0), 40 * k);
  EXPECT_EQ(film.next(0), -1);
}

TEST(TrackReader, TakesNoFourthTrack) {
  Film film(interleaved(1, 1));
  ASSERT_TRUE(film.reader->select(film.source->streams()[0]).has_value());
  const auto fourth = film.reader->select(film.source->streams()[0]);
  ASSERT_FALSE(fourth.has_value());
  EXPECT_EQ(fourth.error().code, ErrorCode::Exhausted);
}

// After the depth's end the reader must not search the rest of the film for more of it.
TEST(TrackReader, ATrackWithNothingToGiveIsGivenUpForNow) {
  std::vector<Scripted> script{{1, 0, true}};
  for (int k = 0; k < 2000; ++k) script.push_back({0, 40 * k, true});
  Film film(script);
  EXPECT_EQ(film.next(1), 0);
  EXPECT_EQ(film.next(1), -1);
  EXPECT_FALSE(film.reader->ended(1));
  EXPECT_EQ(film.source->position, 1 + TrackReader::kMaxWaitingPackets);
  for (int k = 0; k < 2000; ++k) ASSERT_EQ(film.next(0), 40 * k);
}

TEST(TrackReader, LargePacketsAreBoundedByTheirBytes) {
  std::vector<Scripted> script{{1, 0, true}};
  for (int k = 0; k < 200; ++k) script.push_back({0, 40 * k, true});
  Film film(script);
  film.source->packet_bytes = TrackReader::kMaxWaitingBytes / 10;
  EXPECT_EQ(film.next(1), 0);
  EXPECT_EQ(film.next(1), -1);
  EXPECT_EQ(film.source->position, 1 + 11u);  // the eleventh exceeds the bound
}

TEST(TrackReader, WhatWasTakenCountsNoLonger) {
  Film film(interleaved(60, 1));
  film.source->packet_bytes = TrackReader::kMaxWaitingBytes / 10;
  for (int k = 0; k < 60; ++k) {
    ASSERT_EQ(film.next(0), 40 * k);
    ASSERT_EQ(film.next(1), 40 * k);
  }
}

// All depth packets come before the colour's: the colour continues, the depth resumes at a key frame.
TEST(TrackReader, TheLeadingTrackIsNeverHeldUpByTheOther) {
  std::vector<Scripted> script;
  const int count = static_cast<int>(TrackReader::kMaxWaitingPackets) + 100;
  for (int k = 0; k < count; ++k) script.push_back({1, 40 * k, k % 50 == 0});
  for (int k = 0; k < 3; ++k) script.push_back({0, 40 * k, true});
  Film film(script);
  EXPECT_EQ(film.next(0), 0);
  EXPECT_EQ(film.next(1), 40 * 550);  // 512 were dropped, 513 to 549 cannot be decoded
  EXPECT_EQ(film.next(1), 40 * 551);
}

TEST(TrackReader, HoldingMorePicturesThanTheDecoderAllowsIsAnErrorAndNoHang) {
  Film film(interleaved(10, 1), 0, 3);
  std::vector<Frame> held;
  for (int i = 0; i < 3; ++i) held.push_back(film.reader->next(0).value().value());
  const auto refused = film.reader->next(0);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::Exhausted);
  held.pop_back();
  EXPECT_EQ(film.next(0), 120);
}

TEST(TrackReader, ASeekBringsEveryTrackToTheTargetOrBefore) {
  Film film(interleaved(100, 12));
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 30))).has_value());
  EXPECT_EQ(film.next(0), 40 * 24);
  EXPECT_EQ(film.next(1), 40 * 24);
  EXPECT_EQ(film.next(0), 40 * 25);
  EXPECT_EQ(film.source->seeks, 1);
}

// The depth's key frames are at other times: from the colour's key frame on, depth cannot be decoded until after the
// target.
TEST(TrackReader, ASeekGoesFartherBackForTheOtherTracksKeyFrame) {
  std::vector<Scripted> script;
  for (int k = 0; k < 200; ++k) {
    script.push_back({0, 40 * k, k % 10 == 0});
    script.push_back({1, 40 * k, k % 40 == 35});
  }
  Film film(script);
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 112))).has_value());
  EXPECT_LE(film.next(0), 40 * 112);
  EXPECT_EQ(film.next(1), 40 * 75);
  EXPECT_EQ(film.source->seeks, 3);  // from 110 and from 80 (1 s back) depth begins at 115, from 60 (2 s) at 75
}

TEST(TrackReader, ASeekThatLandsTooLateIsTriedFromEarlier) {
  Film film(interleaved(100, 12), 20);  // 10 pictures too late
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 26))).has_value());
  EXPECT_LE(film.next(0), 40 * 26);
  EXPECT_LE(film.next(1), 40 * 26);
  EXPECT_GT(film.source->seeks, 1);
}

TEST(TrackReader, ASeekBeyondTheOtherTracksEndDoesNotSearchTheWholeFilmForIt) {
  std::vector<Scripted> script = interleaved(10, 10);
  for (int k = 10; k < 1000; ++k) script.push_back({0, 40 * k, k % 10 == 0});
  Film film(script);
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 505))).has_value());
  EXPECT_EQ(film.source->seeks, 2);
  EXPECT_LE(film.next(0), 40 * 505);
  EXPECT_EQ(film.next(1), -1);
}

TEST(TrackReader, SoundComesAlongWithThePictures) {
  std::vector<Scripted> script;
  for (int k = 0; k < 10; ++k) {
    script.push_back({2, 40 * k});
    script.push_back({0, 40 * k});
    script.push_back({2, 40 * k + 20});
  }
  Film film(script);
  film.listen();
  EXPECT_EQ(film.sound(), std::vector<int>{});
  EXPECT_EQ(film.next(0), 0);
  EXPECT_EQ(film.next(0), 40);
  EXPECT_EQ(film.sound(), (std::vector{0, 20, 40}));
}

// The container stores sound a second later than its pictures: it is fetched, and the pictures in between are kept.
TEST(TrackReader, ReadsAheadForSoundThatLiesLate) {
  std::vector<Scripted> script;
  for (int k = 0; k < 100; ++k) {
    script.push_back({0, 40 * k});
    if (k >= 25) script.push_back({2, 40 * (k - 25)});
  }
  Film film(script);
  EXPECT_FALSE(film.reader->readAhead()) << "no sound was selected";
  film.listen();
  EXPECT_FALSE(film.reader->readAhead()) << "before the first picture";
  EXPECT_EQ(film.next(0), 0);
  while (film.sound().empty()) ASSERT_TRUE(film.reader->readAhead());
  for (int k = 1; k < 100; ++k) ASSERT_EQ(film.next(0), 40 * k);
}

TEST(TrackReader, ReadsNoFurtherAheadThanItsBound) {
  std::vector<Scripted> script;
  for (int k = 0; k < 1000; ++k) script.push_back({0, 40 * k});
  Film film(script);
  film.listen();
  EXPECT_EQ(film.next(0), 0);
  int read = 0;
  while (film.reader->readAhead()) ++read;
  EXPECT_EQ(read, TrackReader::kReadAhead / milliseconds(40) + 1);
  EXPECT_EQ(film.next(0), 40);
  EXPECT_TRUE(film.reader->readAhead());
}

TEST(TrackReader, SoundThatNobodyTakesIsDroppedTheOldestFirst) {
  std::vector<Scripted> script;
  const int count = static_cast<int>(SoundTrack::kMaxWaitingPackets) + 100;
  for (int k = 0; k < count; ++k) script.push_back({2, k});
  script.push_back({0, 0});
  Film film(script);
  film.listen();
  EXPECT_EQ(film.next(0), 0);
  const std::vector<int> times = film.sound();
  ASSERT_EQ(times.size(), 1000u) << "then the decoder gives up";
  EXPECT_EQ(times.front(), 100);
}

TEST(TrackReader, ADecoderOfSoundThatFailsEndsTheSoundAlone) {
  std::vector<Scripted> script;
  for (int k = 0; k < 10; ++k) {
    script.push_back({2, 40 * k});
    script.push_back({0, 40 * k});
  }
  Film film(script);
  film.listen().lose_after = 2;
  for (int k = 0; k < 10; ++k) ASSERT_EQ(film.next(0), 40 * k);
  EXPECT_EQ(film.sound(), (std::vector{0, 40}));
  EXPECT_EQ(film.next(0), -1);
}

TEST(TrackReader, ASeekForgetsSoundAsWell) {
  std::vector<Scripted> script;
  for (int k = 0; k < 100; ++k) {
    script.push_back({0, 40 * k, k % 10 == 0});
    script.push_back({2, 40 * k});
  }
  Film film(script);
  film.listen();
  for (int k = 0; k < 5; ++k) EXPECT_EQ(film.next(0), 40 * k);
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 50))).has_value());
  const int picture = film.next(0);
  EXPECT_GT(picture, 40 * 5);
  const std::vector<int> times = film.sound();
  ASSERT_FALSE(times.empty());
  EXPECT_EQ(times.front(), picture);
}

TEST(TrackReader, SeeksBackAfterTheEnd) {
  Film film(interleaved(24, 12));
  while (film.next(0) >= 0) {
  }
  while (film.next(1) >= 0) {
  }
  EXPECT_TRUE(film.reader->ended(0));
  ASSERT_TRUE(film.reader->seek(MediaTime{}).has_value());
  EXPECT_FALSE(film.reader->ended(0));
  EXPECT_EQ(film.next(0), 0);
  EXPECT_EQ(film.next(1), 0);
}

// Key frames lie 200 ms apart. Each is decoded by itself, so that its decoder comes to an end with each.
TEST(TrackReader, KeyStepsGiveKeyFramesSoFarApartAlsoAfterTheEndAndBackwards) {
  const auto expectSteps = [](Film& film, int from) {
    ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(from)), milliseconds(300)).has_value());
    for (int k = 0; k < 3; ++k) {
      for (const std::size_t track : {0U, 1U}) EXPECT_EQ(film.next(track), from + 400 * k) << track;
    }
  };
  Film film(interleaved(60, 5));
  while (film.next(0) >= 0) {
  }
  expectSteps(film, 0);
  expectSteps(film, 1200);
  expectSteps(film, 400);
  ASSERT_TRUE(film.reader->seek(MediaTime{}).has_value());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(film.next(0), 40 * k) << "all pictures again";
}

TEST(TrackReader, WhatWasWaitingBeforeASeekTakesNoRoomAfterIt) {
  Film film(interleaved(20, 1));
  film.source->packet_bytes = TrackReader::kMaxWaitingBytes / 4;
  for (int round = 0; round < 3; ++round) {
    ASSERT_TRUE(film.reader->seek(MediaTime{}).has_value());
    for (int k = 0; k < 5; ++k) EXPECT_EQ(film.next(0), 40 * k);
  }
  EXPECT_EQ(film.next(1), 0);
  EXPECT_EQ(film.next(1), 40);
}

// Closing joins a decoder's threads and may ask a server; the player's loop interrupts and asks meanwhile.
TEST(OpenSources, AnswerWhileOneIsClosed) {
  OpenSources sources;
  auto source = std::make_unique<ScriptedSource>(interleaved(1, 1));
  std::future<bool> asked;
  std::future_status answered = std::future_status::deferred;
  source->closing = [&] {
    asked = std::async(std::launch::async, [&] {
      sources.interrupt();
      return sources.waitsForColor(nullptr);
    });
    answered = asked.wait_for(std::chrono::seconds(5));
  };
  ASSERT_TRUE(sources.take(std::make_unique<TrackReader>(std::move(source), nullptr)).has_value());
  sources.close();
  EXPECT_EQ(answered, std::future_status::ready);
  EXPECT_FALSE(asked.get());
}

}  // namespace
}  // namespace relievo
