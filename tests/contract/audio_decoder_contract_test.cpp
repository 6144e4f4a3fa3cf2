// SPDX-License-Identifier: Apache-2.0
// Every sound decoder under the contract.
#include <gtest/gtest.h>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/mock/mock.h"
#include "drivers/sample/sample.h"
#include "tests/contract/suite/audio_decoder.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/sample_clip.h"

namespace relievo {
namespace {

std::unique_ptr<MediaSource> openMock() {
  static ManualClock clock;
  auto source = makeMockSource(
      {.tracks = {{}, {.kind = StreamKind::Audio, .frames = 50, .frame_period = std::chrono::milliseconds(20)}}},
      clock);
  EXPECT_TRUE(source->open("mock"));
  return source;
}

std::unique_ptr<MediaSource> openClip() {
  static const test::TemporaryFolder folder;
  static const std::string path = [] {
    test::makeClip(folder / "film.mkv", {{}}, {}, {{}});
    return folder / "film.mkv";
  }();
  auto source = makeFfmpegSource();
  EXPECT_TRUE(source->open(path));
  return source;
}

std::unique_ptr<MediaSource> openSample() {
  const test::TemporaryFolder folder;
  test::writeSampleClip(folder / "film", {.pictures = 1, .sound_packets = 50});
  auto source = makeSampleSource();
  EXPECT_TRUE(source->open(folder / "film"));
  return source;
}

const test::AudioDecoderBackend kBackends[] = {
    {"mock", openMock, makeMockAudioDecoder},
    {"ffmpeg", openClip, makeFfmpegAudioDecoder},
    {"sample", openSample, makeSampleAudioDecoder},
};

INSTANTIATE_TEST_SUITE_P(Backends, AudioDecoderContract, testing::ValuesIn(kBackends), test::kBackendName);

}  // namespace
}  // namespace relievo
