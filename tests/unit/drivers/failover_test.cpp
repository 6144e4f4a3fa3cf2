// SPDX-License-Identifier: Apache-2.0
// A decoder that replaces another: which packets are fed again after a failure, and that no picture comes twice.
#include "drivers/failover/failover.h"

#include <gtest/gtest.h>

#include "drivers/mock/mock.h"
#include "platform/clock.h"

namespace relievo {
namespace {

constexpr int kFrames = 60, kKeyInterval = 10;

// Films of numbered pictures; each decoder fails at a given packet.
class Failover : public testing::Test {
 protected:
  void SetUp() override {
    MockTrack track;
    track.frames = kFrames;
    track.keyframe_interval = kKeyInterval;
    source_ = makeMockSource({.tracks = {track}}, clock_);
    ASSERT_TRUE(source_->open(""));
    for (int i = 0; i < kFrames; ++i) {
      packets_.push_back(source_->read().value().value());
      times_.push_back(track.pts(i));
    }
  }
  void make(const std::vector<MockDecoderProfile>& profiles) {
    std::vector<std::unique_ptr<VideoDecoder>> decoders;
    for (const MockDecoderProfile& profile : profiles) decoders.push_back(makeMockDecoder(profile));
    decoder_ = makeFailoverDecoder(std::move(decoders));
    ASSERT_TRUE(decoder_->open(source_->streams().at(0)));
  }
  [[nodiscard]] std::vector<MediaTime> play(int from = 0, int to = kFrames) {
    std::vector<MediaTime> times;
    const auto receive = [&] {
      for (;;) {
        const auto frame = decoder_->receive();
        if (!frame) failure_ = frame.error();
        if (!frame || !*frame) return;
        times.push_back((*frame)->pts);
        if (decoder_->takeRestart()) ++restarts_;
      }
    };
    for (int i = from; i < to && !failure_; ++i) {
      receive();
      const auto fed = decoder_->feed(packets_[static_cast<std::size_t>(i)]);
      if (!fed) failure_ = fed.error();
      EXPECT_TRUE(!fed || *fed == Feed::Accepted);
    }
    if (to == kFrames && !failure_) static_cast<void>(decoder_->drain());
    receive();
    return times;
  }
  [[nodiscard]] std::vector<MediaTime> times(int from = 0) const { return {times_.begin() + from, times_.end()}; }

  ManualClock clock_;
  std::unique_ptr<MediaSource> source_;
  std::vector<Packet> packets_;
  std::vector<MediaTime> times_;
  std::unique_ptr<VideoDecoder> decoder_;
  std::optional<Error> failure_;
  int restarts_ = 0;
};

TEST_F(Failover, WhereverOneDiesEveryPictureComesOnceAndInOrder) {
  for (std::uint64_t packets = 0; packets <= kFrames; ++packets) {
    for (const int reorder : {0, 3, 12}) {  // the last holds more back than lies between two key frames
      restarts_ = 0;
      make({{.reorder_frames = reorder, .lose_after_packets = packets}, {.reorder_frames = 1}});
      EXPECT_EQ(play(), times()) << "dead after " << packets << ", " << reorder << " held back";
      EXPECT_EQ(decoder_->state(), VideoDecoder::State::Ended);
      EXPECT_EQ(restarts_, 1);
      EXPECT_EQ(decoder_->description(), "mock; no better decoder: the mock decoder has died");
      EXPECT_EQ(decoder_->damaged(), 0u);
    }
  }
}

TEST_F(Failover, TheLastOnesFailureIsTheCallers) {
  make({{.lose_after_packets = 20}, {.lose_after_packets = 35}});
  EXPECT_LT(play().size(), 60u);
  ASSERT_TRUE(failure_);
  EXPECT_EQ(failure_->code, ErrorCode::Lost);
}

TEST_F(Failover, AfterASeekNothingOfBeforeIsFedAgain) {
  make({{.lose_after_packets = 40}, {}});
  EXPECT_EQ(play(0, 25).size(), 25u);
  ASSERT_TRUE(decoder_->flush());
  EXPECT_EQ(play(30), times(30)) << "it died in between";
  ASSERT_TRUE(decoder_->flush());
  EXPECT_EQ(play(), times()) << "and back";
}

TEST_F(Failover, OneThatDiesInAFlushIsReplacedAsWell) {
  make({{.lose_after_packets = 25}, {}});
  for (int i = 0; i < 25; ++i) {  // the failure is not noticed yet
    ASSERT_EQ(decoder_->feed(packets_[static_cast<std::size_t>(i)]).value(), Feed::Accepted);
    if (i < 24) (void)decoder_->receive();
  }
  ASSERT_TRUE(decoder_->flush());
  EXPECT_EQ(play(10), times(10));
}

TEST_F(Failover, WhatIsDamagedIsCountedOnce) {
  make({{.lose_after_packets = 18}, {}});
  packets_[15].bytes = 1;
  EXPECT_EQ(play().size(), 59u);
  EXPECT_EQ(decoder_->damaged(), 1u);
}

// Of hardware that is not there.
class Absent final : public VideoDecoder {
 public:
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {.name = "absent", .max_held_frames = 8}; }

 private:
  Result<void> openDecoder(const StreamInfo&) override { return fail(ErrorCode::NotFound, "there is no hardware"); }
  Result<Feed> feedPacket(const Packet&) override { return Feed::Accepted; }
  Result<Progress> receiveFrame(Frame&) override { return Progress::NeedsPackets; }
  Result<void> startDrain() override { return {}; }
  Result<void> flushDecoder() override { return {}; }
  void closeDecoder() noexcept override {}
};

TEST_F(Failover, HardwareThatIsNotThereIsToldOnlyIfItWasAskedFor) {
  for (const bool asked_for : {false, true}) {
    std::vector<std::unique_ptr<VideoDecoder>> decoders;
    decoders.push_back(std::make_unique<Absent>());
    decoders.push_back(makeMockDecoder());
    decoder_ = makeFailoverDecoder(std::move(decoders), asked_for);
    ASSERT_TRUE(decoder_->open(source_->streams().at(0)));
    EXPECT_EQ(decoder_->description(), asked_for ? "mock; no better decoder: there is no hardware" : "mock");
  }
}

TEST_F(Failover, HoldsNoMoreThanTheOneThatAllowsLeast) {
  make({{.max_held_frames = 8}, {.max_held_frames = 5}});
  EXPECT_EQ(decoder_->capabilities().max_held_frames, 5);
}

}  // namespace
}  // namespace relievo
