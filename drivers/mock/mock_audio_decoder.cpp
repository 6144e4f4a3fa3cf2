// SPDX-License-Identifier: Apache-2.0
// A sound decoder that generates the tone of a mock track, without gaps between packets.
#include <cmath>
#include <cstring>
#include <numbers>

#include "drivers/mock/mock.h"
#include "drivers/mock/mock_packet.h"

namespace relievo {
namespace {

float tone(double seconds, int /*channel*/) {
  return static_cast<float>(0.5 * std::sin(2 * std::numbers::pi * 440 * seconds));
}

class MockAudioDecoder final : public AudioDecoder {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "mock"; }

 private:
  Result<void> openDecoder(const StreamInfo& stream, const AudioFormat& format) override {
    if (stream.codec != kMockCodec || stream.native == nullptr) {
      return fail(ErrorCode::Unsupported, "the mock sound decoder decodes mock films only");
    }
    track_ = std::static_pointer_cast<const MockTrack>(stream.native);
    format_ = format;
    return {};
  }

  Result<AudioChunk> decodePacket(const Packet& packet) override {
    MockPacket content;
    const bool whole = packet.data != nullptr && packet.bytes == sizeof content;
    if (whole) std::memcpy(&content, packet.data, sizeof content);
    if (!whole || content.damaged) {
      countDamaged();
      return AudioChunk{};
    }
    AudioChunk chunk{.pts = track_->pts(content.frame), .samples = {}};
    const std::int64_t end = indexAt(track_->pts(content.frame + 1));
    for (std::int64_t i = indexAt(chunk.pts); i < end; ++i) {
      const double seconds = static_cast<double>(i) / format_.rate_hz;
      for (int channel = 0; channel < format_.channels; ++channel) {
        chunk.samples.push_back(track_->sound ? track_->sound(seconds, channel) : tone(seconds, channel));
      }
    }
    return chunk;
  }

  void flushDecoder() noexcept override {}
  void closeDecoder() noexcept override { track_.reset(); }

  [[nodiscard]] std::int64_t indexAt(MediaTime time) const noexcept {
    return std::llround(toSeconds(time) * format_.rate_hz);
  }

  std::shared_ptr<const MockTrack> track_;
  AudioFormat format_;
};

}  // namespace

std::unique_ptr<AudioDecoder> makeMockAudioDecoder() {
  return std::make_unique<MockAudioDecoder>();
}

}  // namespace relievo
