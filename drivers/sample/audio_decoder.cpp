// SPDX-License-Identifier: Apache-2.0
// Sound decoder for uncoded samples; converts them to the requested rate and number of channels.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "drivers/sample/sample.h"
#include "drivers/sample/sample_film.h"

namespace relievo {
namespace {

class SampleAudioDecoder final : public AudioDecoder {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "sample"; }

 private:
  Result<void> openDecoder(const StreamInfo& stream, const AudioFormat& format) override {
    if (stream.codec != kSampleSound)
      return fail(ErrorCode::Unsupported, "the sample decoder decodes only sample films");
    if (stream.sample_rate_hz < 1 || stream.channels < 1 || stream.channels > 8) {
      return fail(ErrorCode::Corrupt, "the sound's rate or number of channels is invalid; check the film");
    }
    rate_hz_ = stream.sample_rate_hz;
    channels_ = static_cast<std::size_t>(stream.channels);
    format_ = format;
    return {};
  }

  // Output samples are at multiples of the requested sample period on the film's time line, so that packets join
  // without a gap. A stateful codec would also keep its last samples for the next packet.
  Result<AudioChunk> decodePacket(const Packet& packet) override {
    std::uint32_t frames = 0;
    if (packet.bytes >= sizeof frames) std::memcpy(&frames, packet.data, sizeof frames);
    if (frames == 0 || !packet.pts || packet.bytes != sizeof frames + 2 * channels_ * std::size_t{frames}) {
      countDamaged();  // no error: yields nothing
      return AudioChunk{};
    }
    in_.resize(channels_ * frames);
    std::memcpy(in_.data(), packet.data + sizeof frames, packet.bytes - sizeof frames);

    AudioChunk chunk{.pts = *packet.pts, .samples = {}};
    const double begin_s = toSeconds(chunk.pts);
    const std::int64_t end = indexAt(begin_s + static_cast<double>(frames) / rate_hz_);
    for (std::int64_t i = indexAt(begin_s); i < end; ++i) {
      const double place = (static_cast<double>(i) / format_.rate_hz - begin_s) * rate_hz_;
      const float value = sampleAt(std::clamp(place, 0.0, static_cast<double>(frames - 1)), frames);
      chunk.samples.insert(chunk.samples.end(), static_cast<std::size_t>(format_.channels), value);
    }
    return chunk;
  }

  void flushDecoder() noexcept override {}
  void closeDecoder() noexcept override {}

  [[nodiscard]] std::int64_t indexAt(double s) const noexcept { return std::llround(s * format_.rate_hz); }

  // The mean of all channels, interpolated linearly between two frames.
  [[nodiscard]] float sampleAt(double place, std::uint32_t frames) const noexcept {
    const auto before = static_cast<std::size_t>(place);
    const std::size_t after = std::min<std::size_t>(before + 1, frames - 1);
    const double share = place - static_cast<double>(before);
    return static_cast<float>((1 - share) * meanAt(before) + share * meanAt(after));
  }
  [[nodiscard]] double meanAt(std::size_t frame) const noexcept {
    double sum = 0;
    for (std::size_t c = 0; c < channels_; ++c) sum += in_[frame * channels_ + c];
    return sum / (32768.0 * static_cast<double>(channels_));
  }

  int rate_hz_ = 0;
  std::size_t channels_ = 0;
  AudioFormat format_;
  std::vector<std::int16_t> in_;
};

}  // namespace

std::unique_ptr<AudioDecoder> makeSampleAudioDecoder() {
  return std::make_unique<SampleAudioDecoder>();
}

}  // namespace relievo
