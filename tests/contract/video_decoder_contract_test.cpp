// SPDX-License-Identifier: Apache-2.0
// The contract for decoders that need no special hardware, and tests that need a mock's fault switches.
#include "tests/contract/video_decoder_contract.h"

#include "drivers/failover/failover.h"
#include "drivers/tiff/tiff.h"
#include "tests/support/film/float_tiff.h"

namespace relievo {
namespace {

// A decoder that fails at once, and the one that replaces it.
std::unique_ptr<VideoDecoder> failedOver() {
  std::vector<std::unique_ptr<VideoDecoder>> decoders;
  decoders.push_back(makeMockDecoder());
  decoders.push_back(makeFfmpegDecoder());
  return makeFailoverDecoder(std::move(decoders));
}
constexpr test::FilmBackend kFailover{"failover", makeFfmpegSource, failedOver, test::encodedFilm, nullptr};

// A renderer's Z buffers, one file each.
std::string zBufferFilm() {
  static const test::TemporaryFolder folder;
  for (int i = 0; i < test::kFilmFrames; ++i) {
    const test::FloatTiff picture{.samples =
                                      std::vector<float>(std::size_t{64} * 48, 1.0F + 0.1F * static_cast<float>(i))};
    test::writeFloatTiff(folder / ("z" + std::to_string(i) + ".tif"), picture);
  }
  return folder / "z%d.tif";
}
std::unique_ptr<VideoDecoder> tiffDecoder() {
  return makePictureFileDecoder(kTiff);
}
constexpr test::FilmBackend kTiffFiles{"tiff", makeFfmpegSource, tiffDecoder, zBufferFilm, nullptr};

std::string nameOf(const testing::TestParamInfo<test::FilmBackend>& test) {
  return test.param.name;
}
INSTANTIATE_TEST_SUITE_P(Backends, VideoDecoderContract, testing::ValuesIn(test::kFilmBackends), nameOf);
INSTANTIATE_TEST_SUITE_P(Others, VideoDecoderContract, testing::Values(kFailover, kTiffFiles), nameOf);

struct MockFilm {
  explicit MockFilm(MockMediaProfile profile, MockDecoderProfile decoding = {})
      : source(makeMockSource(std::move(profile), clock)), decoder(makeMockDecoder(decoding)) {
    EXPECT_TRUE(source->open("") && decoder->open(source->streams().at(0)));
  }
  Result<Feed> feedNext() { return decoder->feed(source->read().value().value()); }
  Frame next() {
    EXPECT_EQ(feedNext().value(), Feed::Accepted);
    return decoder->receive().value().value();
  }
  ManualClock clock;
  std::unique_ptr<MediaSource> source;
  std::unique_ptr<VideoDecoder> decoder;
};

TEST(MockDecoder, PaintsWhatTheProfileSaysInEveryLayout) {
  for (const ColorModel model : {ColorModel::Gray, ColorModel::Yuv, ColorModel::Rgb}) {
    for (const int bits : {8, 10, 16}) {
      MockTrack track;
      track.width = 7, track.height = 5;
      track.model = model;
      track.bits = bits;
      track.sample = [](int frame, int component, int c, int r) {
        return static_cast<std::uint16_t>(100 * frame + 50 * component + 7 * r + c);
      };
      MockFilm film({.tracks = {track}});
      (void)film.next();
      const Frame frame = film.next();
      EXPECT_EQ(frame.model, model);
      EXPECT_EQ(frame.pts, track.pts(1));
      EXPECT_EQ(test::sampleAt(frame, 0, 6, 4), 134u);
      if (model == ColorModel::Gray) continue;
      // Chroma of 7 x 5 is 4 x 3.
      EXPECT_EQ(test::sampleAt(frame, 2, 3, 2), 217u);
    }
  }
}

TEST(MockDecoder, MakesNoMorePicturesThanMayBeHeldUntilOneIsGivenBack) {
  MockFilm film({}, {.queue_packets = 2, .max_held_frames = 3});
  std::vector<Frame> held;
  for (int i = 0; i < 3; ++i) held.push_back(film.next());
  EXPECT_EQ(film.feedNext().value(), Feed::Accepted);
  EXPECT_EQ(film.feedNext().value(), Feed::Accepted);
  EXPECT_FALSE(film.decoder->receive().value());
  EXPECT_EQ(film.feedNext().value(), Feed::Full);
  held.pop_back();
  EXPECT_TRUE(film.decoder->receive().value());
}

TEST(MockDecoder, DropsAndCountsDamagedPackets) {
  MockFilm film({.damaged_every = 3});
  std::vector<MediaTime> times;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(film.feedNext().value(), Feed::Accepted);
    if (const auto frame = film.decoder->receive().value()) times.push_back(frame->pts);
  }
  const MockTrack track;
  EXPECT_EQ(times, (std::vector{track.pts(0), track.pts(1), track.pts(3), track.pts(4)}));
  EXPECT_EQ(film.decoder->damaged(), 2u);
}

TEST(MockDecoder, DiesForGoodAfterSoManyPackets) {
  MockFilm film({}, {.lose_after_packets = 2});
  (void)film.next();
  EXPECT_EQ(film.feedNext().value(), Feed::Accepted);
  EXPECT_EQ(test::answerOf(film.feedNext()), ErrorCode::Lost);
  EXPECT_EQ(test::answerOf(film.decoder->receive()), ErrorCode::Lost);
  EXPECT_EQ(test::answerOf(film.decoder->flush()), ErrorCode::Lost);
  film.decoder->close();
  ASSERT_TRUE(film.decoder->open(film.source->streams().at(0)));
  EXPECT_TRUE(film.feedNext());
}

TEST(MockDecoder, MakesNothingOfWhatPrecedesAKeyFrame) {
  MockTrack track;
  track.keyframe_interval = 4;
  MockFilm film({.tracks = {track}});
  (void)film.next();
  ASSERT_TRUE(film.decoder->flush());
  std::vector<MediaTime> times;
  for (int i = 1; i < 6; ++i) {
    EXPECT_EQ(film.feedNext().value(), Feed::Accepted);
    if (const auto frame = film.decoder->receive().value()) times.push_back(frame->pts);
  }
  EXPECT_EQ(times, (std::vector{track.pts(4), track.pts(5)}));
  EXPECT_EQ(film.decoder->damaged(), 3u);
}

}  // namespace
}  // namespace relievo
