// SPDX-License-Identifier: Apache-2.0
// Real sound through the real decoder: codecs, containers, rates and layouts, compared sample by sample.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::ClipSound;

constexpr double kRate = 48000;

struct Decoded {
  std::vector<float> left, right;
  MediaTime begin;
  MediaTime first_picture = MediaTime::max();
  double worst_seam_s = 0;  // between a chunk's time and the end of the one before
};

Decoded decode(MediaSource& source) {
  Decoded decoded;
  const StreamInfo& stream = source.streams().back();
  const auto decoder = makeFfmpegAudioDecoder();
  EXPECT_TRUE(decoder->open(stream, {}));
  bool first = true;
  for (;;) {
    const auto packet = source.read();
    EXPECT_TRUE(packet);
    if (!packet || !*packet) break;
    if ((*packet)->stream == 0) {
      decoded.first_picture = std::min(decoded.first_picture, (*packet)->pts.value_or(MediaTime::max()));
    }
    if ((*packet)->stream != stream.index) continue;
    const auto chunk = decoder->decode(**packet);
    EXPECT_TRUE(chunk);
    if (!chunk || chunk->samples.empty()) continue;
    if (first) decoded.begin = chunk->pts;
    first = false;
    const double expected_s = toSeconds(decoded.begin) + static_cast<double>(decoded.left.size()) / kRate;
    decoded.worst_seam_s = std::max(decoded.worst_seam_s, std::abs(toSeconds(chunk->pts) - expected_s));
    for (std::size_t i = 0; i + 1 < chunk->samples.size(); i += 2) {
      decoded.left.push_back(chunk->samples[i]);
      decoded.right.push_back(chunk->samples[i + 1]);
    }
  }
  EXPECT_EQ(decoder->damaged(), 0u);
  return decoded;
}

// The amplitude of a sine of that frequency, and its delay relative to one that begins at 0.
struct Tone {
  double amplitude = 0, late_s = 0;
};
Tone toneOf(const std::vector<float>& samples, MediaTime begin, double hertz, double from_s, double to_s) {
  double sine = 0, cosine = 0;
  const double begin_s = toSeconds(begin);
  const auto first = static_cast<std::size_t>((from_s - begin_s) * kRate);
  const auto last = static_cast<std::size_t>((to_s - begin_s) * kRate);
  EXPECT_LE(last, samples.size());
  for (std::size_t i = first; i < std::min(last, samples.size()); ++i) {
    const double phase = 2 * std::numbers::pi * hertz * (begin_s + static_cast<double>(i) / kRate);
    sine += std::sin(phase) * static_cast<double>(samples[i]);
    cosine += std::cos(phase) * static_cast<double>(samples[i]);
  }
  const double count = static_cast<double>(last - first) / 2;
  return {std::hypot(sine, cosine) / count, -std::atan2(cosine, sine) / (2 * std::numbers::pi * hertz)};
}

struct Case {
  const char* name;
  const char* file;
  ClipSound sound;
  double off_s = 0.0015;   // of the pictures, at most
  double seam_s = 0.0011;  // a millisecond is Matroska's own
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

// The writer of WebM counts the delay of Opus twice.
const Case kCases[] = {
    {"FlacMono", "a.mkv", {.codec = "flac", .channels = 1}},
    {"Pcm44100", "a.mov", {.codec = "pcm_s16le", .rate_hz = 44100}, 0.0015, 0.0001},
    {"Pcm44100Matroska", "a.mkv", {.codec = "pcm_s16le", .rate_hz = 44100}},
    {"AacMp4", "a.mp4", {.codec = "aac", .rate_hz = 44100}},
    {"AacStream", "a.ts", {.codec = "aac"}},
    {"AacMatroska", "a.mkv", {.codec = "aac"}},
    {"Opus", "a.webm", {.codec = "libopus"}, 0.010},
    {"Mp3", "a.mkv", {.codec = "libmp3lame", .rate_hz = 44100}},
    {"Ac3", "a.ts", {.codec = "ac3"}},
};

class FfmpegAudio : public testing::TestWithParam<Case> {
 protected:
  // A film of three seconds, video first.
  std::unique_ptr<MediaSource> openFilm(ClipSound sound, const std::string& file) {
    sound.length = 3s;
    const bool webm = file.ends_with(".webm");
    const std::string codec = webm ? "libvpx" : "libx264";
    try {
      test::makeClip(folder_ / file, {{.codec = codec, .pix_fmt = "yuv420p", .frames = 90}}, {}, {sound});
    } catch (const std::runtime_error& error) {
      ADD_FAILURE() << error.what();
    }
    auto source = makeFfmpegSource();
    EXPECT_TRUE(source->open(folder_ / file));
    return source;
  }
  test::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(Codecs, FfmpegAudio, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(FfmpegAudio, TheSineComesOutAtItsPitchItsStrengthAndItsTime) {
  ClipSound two_tones = GetParam().sound;
  two_tones.sound = [](double t, int) {
    return 0.5 * std::sin(2 * std::numbers::pi * 440 * t) + 0.3 * std::sin(2 * std::numbers::pi * 20 * t);
  };
  const auto source = openFilm(two_tones, GetParam().file);
  ASSERT_EQ(source->streams().back().kind, StreamKind::Audio);
  EXPECT_EQ(source->streams().back().sample_rate_hz, GetParam().sound.rate_hz);
  EXPECT_EQ(source->streams().back().channels, GetParam().sound.channels);
  const Decoded decoded = decode(*source);
  EXPECT_LT(decoded.worst_seam_s, GetParam().seam_s);
  for (const auto* side : {&decoded.left, &decoded.right}) {
    const Tone tone = toneOf(*side, decoded.begin, 440, 0.5, 2.5);
    // One channel goes to both sides with half of its power each.
    EXPECT_NEAR(tone.amplitude, GetParam().sound.channels == 1 ? 0.5 * std::sqrt(0.5) : 0.5, 0.02);
    EXPECT_LT(toneOf(*side, decoded.begin, 660, 0.5, 2.5).amplitude, 0.01);
    // Both tones begin with the pictures, even if the codec has put padding before them. A period of 20 Hz is 50 ms.
    const double off_s = toneOf(*side, decoded.begin, 20, 0.5, 2.5).late_s - toSeconds(decoded.first_picture);
    EXPECT_NEAR(std::remainder(off_s, 0.05), 0, GetParam().off_s);
  }
}

TEST_F(FfmpegAudio, SurroundIsMixedDownAndNotClipped) {
  ClipSound surround{.codec = "flac", .channels = 6};
  const auto hertz = [](int channel) { return 200.0 * (channel + 1); };
  surround.sound = [hertz](double t, int channel) {
    return 0.99 * std::sin(2 * std::numbers::pi * hertz(channel) * t);
  };
  const Decoded decoded = decode(*openFilm(surround, "a.mkv"));
  for (const auto* side : {&decoded.left, &decoded.right}) {
    for (const float sample : *side) ASSERT_LE(std::abs(sample), 1.0F);
  }
  const auto strength = [&](const std::vector<float>& side, int channel) {
    return toneOf(side, decoded.begin, hertz(channel), 0.5, 2.5).amplitude;
  };
  // Left, right, centre, bass, left and right at the back.
  EXPECT_GT(strength(decoded.left, 0), 0.3);
  EXPECT_LT(strength(decoded.left, 1), 0.01);
  EXPECT_NEAR(strength(decoded.left, 2), strength(decoded.left, 0) * std::sqrt(0.5), 0.01);
  EXPECT_NEAR(strength(decoded.right, 2), strength(decoded.left, 2), 0.01);
  EXPECT_NEAR(strength(decoded.right, 5), strength(decoded.left, 4), 0.01);
}

// After a seek the sound belongs to the new position, as shown by a tone whose pitch rises with the film's time.
TEST_F(FfmpegAudio, AfterASeekTheSoundIsOfItsTime) {
  ClipSound steps{.codec = "aac"};
  steps.sound = [](double t, int) {
    return 0.5 * std::sin(2 * std::numbers::pi * (400 + 100 * std::floor(2 * t)) * t);
  };
  const auto source = openFilm(steps, "a.mkv");
  ASSERT_TRUE(source->seek(mediaTime(2.0)));
  const Decoded decoded = decode(*source);
  EXPECT_LE(toSeconds(decoded.begin), 2.05);
  EXPECT_GT(toneOf(decoded.left, decoded.begin, 800, 2.05, 2.45).amplitude, 0.4);
  EXPECT_GT(toneOf(decoded.left, decoded.begin, 900, 2.55, 2.95).amplitude, 0.4);
}

TEST_F(FfmpegAudio, SaysWhenACodecIsUnknown) {
  const auto decoder = makeFfmpegAudioDecoder();
  StreamInfo stream;
  stream.kind = StreamKind::Audio;
  stream.codec = "nonsense";
  EXPECT_EQ(decoder->open(stream, {}).error().code, ErrorCode::Unsupported);
}

}  // namespace
}  // namespace relievo
