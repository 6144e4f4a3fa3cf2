// SPDX-License-Identifier: Apache-2.0
// The contract of every sound decoder: states, the requested format, samples at their times without gaps. List the back
// ends in a test of your own: INSTANTIATE_TEST_SUITE_P(Backends, AudioDecoderContract, testing::Values(..),
// test::kBackendName).
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <ostream>
#include <utility>
#include <vector>

#include "hal/media/audio_decoder.h"
#include "hal/media/media_source.h"
#include "tests/contract/suite/backend_name.h"

namespace relievo {
namespace test {

struct AudioDecoderBackend {
  const char* name;
  // An open film: pictures in the first stream; in the last one a second of 440 Hz at half of full scale, in two
  // channels of 48 kHz.
  std::unique_ptr<MediaSource> (*open)();
  std::unique_ptr<AudioDecoder> (*make)();
};
inline void PrintTo(const AudioDecoderBackend& backend, std::ostream* out) {
  *out << backend.name;
}

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool audioDecoderCases();
inline const bool kAudioDecoderCases = audioDecoderCases();

}  // namespace test

class AudioDecoderContract : public testing::TestWithParam<test::AudioDecoderBackend> {
 protected:
  using State = AudioDecoder::State;

  void SetUp() override {
    source_ = GetParam().open();
    decoder_ = GetParam().make();
  }
  [[nodiscard]] const StreamInfo& stream() const { return source_->streams().back(); }
  // The next sound packet; nullopt at the end.
  std::optional<Packet> nextPacket() {
    for (;;) {
      auto packet = source_->read();
      EXPECT_TRUE(packet);
      if (!packet || !*packet || (*packet)->stream == stream().index) return packet.value_or(std::nullopt);
    }
  }
  std::vector<AudioChunk> decodeAll() {
    std::vector<AudioChunk> chunks;
    while (const auto packet = nextPacket()) {
      auto chunk = decoder_->decode(*packet);
      EXPECT_TRUE(chunk);
      if (chunk && !chunk->samples.empty()) chunks.push_back(std::move(*chunk));
    }
    return chunks;
  }
  std::unique_ptr<MediaSource> source_;
  std::unique_ptr<AudioDecoder> decoder_;
};

}  // namespace relievo
