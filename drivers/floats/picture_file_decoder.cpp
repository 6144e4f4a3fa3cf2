// SPDX-License-Identifier: Apache-2.0
// Queues files, reads them one by one, and converts their numbers to codes on the first picture's scale.
#include "drivers/floats/picture_file_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

#include "hal/media/float_codes.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr std::size_t kQueued = 4;
constexpr std::size_t kQueuedBytes = std::size_t{64} << 20;  // unless one picture alone is larger
constexpr int kMaxHeldFrames = 64;
constexpr std::uint64_t kLongestSide = 32768;
constexpr Duration kDefaultPeriod = std::chrono::milliseconds(40);
constexpr float kStretch = 257;  // 8 bits to 16
constexpr double kTop = 65535;

using Codes = std::vector<std::uint16_t>;

bool isGrayRgb(const FilePicture& picture) noexcept {
  for (std::size_t i = 0; i + 2 < picture.samples.size(); i += 3) {
    const auto same = [&](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    if (!same(picture.samples[i], picture.samples[i + 1]) || !same(picture.samples[i], picture.samples[i + 2]))
      return false;
  }
  return true;
}

// Numbers in red, and nothing in green and blue: Unity's depth.
bool isRedAlone(const FilePicture& picture) noexcept {
  for (std::size_t i = 0; i + 2 < picture.samples.size(); i += 3) {
    if (picture.samples[i + 1] != 0 || picture.samples[i + 2] != 0) return false;
  }
  return true;
}

// Whether the three components are the places of points, whose distance is the third: left and right of the camera, and
// above and below, are negative as well, distances are not; OpenGL's are nothing else. Normals are all of length 1.
bool isPoints(const FilePicture& picture) noexcept {
  constexpr std::size_t kLeastShare = 10;
  constexpr float kUnit = 0.02F;
  std::array<std::size_t, 3> below{}, above{};
  std::size_t normals = 0;
  for (std::size_t i = 0; i < picture.samples.size(); ++i) {
    if (picture.samples[i] < 0) ++below[i % 3];
    if (picture.samples[i] > 0) ++above[i % 3];
  }
  for (std::size_t i = 0; i + 2 < picture.samples.size(); i += 3) {
    const float length = std::hypot(picture.samples[i], picture.samples[i + 1], picture.samples[i + 2]);
    if (std::abs(length - 1) < kUnit) ++normals;
  }
  const std::size_t least = picture.samples.size() / 3 / kLeastShare;
  const auto both = [&](std::size_t k) { return std::min(below[k], above[k]) > least; };
  return both(0) && both(1) && std::min(below[2], above[2]) == 0 && normals < picture.samples.size() / 6;
}

// IEC 61966-2-1: light, 0 to 1, as a screen's code, 0 to 1.
double encoded(double light) noexcept {
  light = std::clamp(light, 0.0, 1.0);
  return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

std::uint8_t colorCode(float sample, const FilePicture& picture) noexcept {
  constexpr double kWhite = 255;
  if (std::isnan(sample)) return 0;
  const double share = picture.whole_bits > 0 ? static_cast<double>(sample) / ((1 << picture.whole_bits) - 1)
                                              : encoded(static_cast<double>(sample));
  return static_cast<std::uint8_t>(std::lround(kWhite * std::clamp(share, 0.0, 1.0)));
}

// 8 bits of RGB, which depth in colours can be read from.
Frame colorFrame(const FilePicture& picture) {
  auto codes = std::make_shared<std::vector<std::uint8_t>>(picture.samples.size());
  std::transform(picture.samples.begin(), picture.samples.end(), codes->begin(),
                 [&](float sample) { return colorCode(sample, picture); });
  Frame frame;
  frame.width = picture.width;
  frame.height = picture.height;
  frame.model = ColorModel::Rgb;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  for (std::uint8_t k = 0; k < 3; ++k) frame.components[k] = {.offset_bytes = k, .step_bytes = 3};
  frame.planes[0] = {codes->data(), std::ptrdiff_t{3} * picture.width};
  frame.owner = std::move(codes);
  return frame;
}

class PictureFileDecoder final : public VideoDecoder {
 public:
  explicit PictureFileDecoder(PictureFormat format) noexcept : format_(format) {}
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = format_.codec, .max_held_frames = kMaxHeldFrames, .hardware = false};
  }

 private:
  // How the film's pictures are converted, as its first one that has a number decides.
  struct Reading {
    bool gray = true;
    std::size_t component = 0;  // of gray
    float stretch = 1;
    bool plain = false;  // whole numbers: the codes themselves, not values of a float
    FloatCodes codes = FloatCodes::identity();
    bool decided = true;  // false while every sample has been a hole
    bool said_beyond = false;
  };

  Result<void> openDecoder(const StreamInfo& stream) override {
    if (stream.codec != format_.codec) return fail(ErrorCode::Unsupported, "the stream holds no pictures of this kind");
    period_ = stream.frame_period > Duration(0) ? stream.frame_period : kDefaultPeriod;
    reading_.reset();
    forget();
    return {};
  }

  Result<Feed> feedPacket(const Packet& packet) override {
    std::size_t bytes = packet.bytes;
    for (const Packet& queued : queue_) bytes += queued.bytes;
    if (queue_.size() >= kQueued || (!queue_.empty() && bytes > kQueuedBytes)) return Feed::Full;
    queue_.push_back(packet);
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    while (!queue_.empty()) {
      const Packet packet = std::move(queue_.front());
      queue_.pop_front();
      const MediaTime pts = packet.pts.value_or(next_pts_);
      next_pts_ = pts + period_;
      const auto picture = format_.read({packet.data, packet.bytes});
      if (!picture) {
        countDamaged();
        continue;
      }
      auto decoded = frameOf(*picture);
      if (!decoded) {
        countDamaged();
        continue;
      }
      frame = std::move(*decoded);
      frame.pts = pts;
      frame.duration = period_;
      return Progress::Picture;
    }
    return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
  }

  static Reading readingOf(const FilePicture& first) {
    Reading reading;
    reading.gray = first.components == 1 || isGrayRgb(first);
    const auto step = static_cast<std::size_t>(first.components);
    reading.plain = first.whole_bits > 0;
    if (!reading.gray && !reading.plain) reading.gray = isRedAlone(first);
    if (first.whole_bits == 8) reading.stretch = kStretch;
    if (!reading.gray && !reading.plain && isPoints(first)) {
      reading.gray = true;
      reading.component = 2;
    }
    if (reading.gray) {
      const std::size_t begin = reading.component;
      const auto codes = FloatCodes::chosenFor([&](std::size_t i) { return first.samples[begin + i * step]; },
                                               first.samples.size() / step);
      if (codes && codes->valueAtZero() != 0) reading.plain = false;
      if (reading.plain) return reading;
      reading.decided = codes.has_value();
      if (codes) reading.codes = *codes;
    }
    return reading;
  }

  // nullopt for a picture of fewer components than the film's first one.
  std::optional<Frame> frameOf(const FilePicture& picture) {
    if (!picture.frame.empty()) return picture.frame;
    if (!reading_ || !reading_->decided) reading_ = readingOf(picture);
    if (!reading_->gray && picture.components == 3) return colorFrame(picture);
    const auto step = static_cast<std::size_t>(picture.components);
    if (reading_->component >= step) return std::nullopt;
    Codes codes(picture.samples.size() / step);
    bool beyond = false;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const float value = picture.samples[reading_->component + i * step] * reading_->stretch;
      codes[i] = reading_->codes.codeOf(value);
      beyond = beyond || reading_->codes.isBeyond(value);
    }
    if (beyond) sayBeyond();
    Frame frame = grayFrame(std::make_shared<const Codes>(std::move(codes)), picture.width, picture.height);
    if (!reading_->plain) {
      frame.value_per_code = reading_->codes.valuePerCode();
      frame.value_at_zero = reading_->codes.valueAtZero();
    }
    return frame;
  }

  void sayBeyond() {
    if (std::exchange(reading_->said_beyond, true)) return;
    log(LogLevel::Warning, "media", "values beyond %g, the range of the film's first picture, are cut to it",
        kTop * std::abs(reading_->codes.valuePerCode()) + reading_->codes.valueAtZero());
  }

  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  Result<void> flushDecoder() override {
    forget();
    return {};
  }
  void closeDecoder() noexcept override { forget(); }
  void forget() noexcept {
    queue_.clear();
    draining_ = false;
    next_pts_ = MediaTime{};
  }

  const PictureFormat format_;
  std::optional<Reading> reading_;
  Duration period_ = kDefaultPeriod;
  std::deque<Packet> queue_;
  MediaTime next_pts_;  // for a packet without a time
  bool draining_ = false;
};

}  // namespace

bool isSoundSize(std::uint64_t width, std::uint64_t height) noexcept {
  return width > 0 && height > 0 && width <= kLongestSide && height <= kLongestSide &&
         width * height <= std::uint64_t{VideoDecoder::kMostSamples};
}

int wholeBits(const NumberType& type, std::span<const float> samples) noexcept {
  if (type.kind == 'f') return 0;
  if (type.bytes == 1) return type.kind == 'u' ? 8 : 0;
  const auto fits = [](float value) { return value <= static_cast<float>(kTop); };
  return std::all_of(samples.begin(), samples.end(), fits) ? 16 : 0;
}

std::unique_ptr<VideoDecoder> makePictureFileDecoder(PictureFormat format) {
  return std::make_unique<PictureFileDecoder>(format);
}

}  // namespace relievo
