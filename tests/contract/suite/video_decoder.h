// SPDX-License-Identifier: Apache-2.0
// The contract of every video decoder: states, back-pressure without loss, stable pictures, one end. List the back ends
// in a test of your own: INSTANTIATE_TEST_SUITE_P(Backends, VideoDecoderContract, testing::Values(..),
// test::kBackendName).
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/media/frame.h"
#include "tests/contract/suite/film.h"

namespace relievo {

class VideoDecoderContract : public test::FilmContract {
 protected:
  using State = VideoDecoder::State;

  void SetUp() override {
    source_ = openSource();
    stream_ = source_->streams().at(0);
    packets_ = readAll(*source_);
    ASSERT_EQ(packets_.size(), static_cast<std::size_t>(test::kFilmFrames));
    for (int i = 0; i < test::kFilmFrames; ++i) {  // numbered pictures have no times
      Packet& packet = packets_[static_cast<std::size_t>(i)];
      if (!packet.pts) packet.pts = MediaTime(i * test::kFilmPeriod);
    }
  }
  [[nodiscard]] std::unique_ptr<VideoDecoder> openDecoder() const {
    auto decoder = GetParam().make_decoder();
    EXPECT_TRUE(decoder->open(stream_));
    return decoder;
  }
  [[nodiscard]] std::unique_ptr<VideoDecoder> bring(State state) const {
    auto decoder = GetParam().make_decoder();
    if (state == State::Closed) return decoder;
    EXPECT_TRUE(decoder->open(stream_));
    if (state == State::Open) return decoder;
    EXPECT_EQ(decoder->feed(packets_[0]), Feed::Accepted);
    EXPECT_TRUE(decoder->drain());
    if (state == State::Ended) (void)receiveAll(*decoder);
    return decoder;
  }
  // Feeds packets [first, last) and passes each received picture to `take`.
  template <class Take>
  static void play(VideoDecoder& decoder, const Packet* first, const Packet* last, Take&& take) {
    int tries = 0;
    while (first != last && ++tries < 1000) {
      const auto fed = decoder.feed(*first);
      ASSERT_TRUE(fed);
      if (*fed == Feed::Accepted) ++first;
      for (Frame& frame : receiveAll(decoder)) take(std::move(frame));
    }
    ASSERT_EQ(first, last) << "it took no more packets";
  }
  // Receives all pictures that are ready.
  static std::vector<Frame> receiveAll(VideoDecoder& decoder) {
    std::vector<Frame> frames;
    for (;;) {
      auto frame = decoder.receive();
      EXPECT_TRUE(frame);
      if (!frame || !*frame) return frames;
      frames.push_back(std::move(**frame));
    }
  }
  [[nodiscard]] const Packet* packets(int from = 0) const { return packets_.data() + from; }
  // Decodes to the end from `decoder`'s current state and returns the pictures' times.
  [[nodiscard]] std::vector<MediaTime> timesOf(VideoDecoder& decoder, int from = 0) const {
    std::vector<MediaTime> times;
    play(decoder, packets(from), packets(test::kFilmFrames), [&](const Frame& f) { times.push_back(f.pts); });
    EXPECT_TRUE(decoder.drain());
    for (const Frame& frame : receiveAll(decoder)) times.push_back(frame.pts);
    EXPECT_EQ(decoder.state(), State::Ended);
    return times;
  }
  static std::vector<MediaTime> filmTimes(int from = 0) {
    std::vector<MediaTime> times;
    for (int i = from; i < test::kFilmFrames; ++i) times.emplace_back(i * test::kFilmPeriod);
    return times;
  }
  // A hash of the samples of the picture's first component.
  static std::uint64_t digest(const Frame& frame) {
    const Component& luma = frame.components[0];
    const Plane& plane = frame.planes[luma.plane];
    std::uint64_t sum = 1469598103934665603ull;
    for (int r = 0; r < frame.height; ++r) {
      const std::uint8_t* const row = plane.data + r * plane.stride_bytes + luma.offset_bytes;
      for (int c = 0; c < frame.width; ++c) sum = (sum ^ codeAt(luma, row + c * luma.step_bytes)) * 1099511628211ull;
    }
    return sum;
  }

  std::unique_ptr<MediaSource> source_;
  StreamInfo stream_;
  std::vector<Packet> packets_;
};

namespace test {

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool videoDecoderCases();
inline const bool kVideoDecoderCases = videoDecoderCases();

}  // namespace test
}  // namespace relievo
