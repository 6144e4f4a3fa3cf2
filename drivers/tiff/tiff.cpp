// SPDX-License-Identifier: Apache-2.0
// Reads floats in strips or tiles and converts them to whole millimetres.
#include "drivers/tiff/tiff.h"

#include <tiffio.h>
#include <tiffio.hxx>

#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>
#include <spanstream>
#include <utility>
#include <vector>

#include "hal/distance.h"

namespace relievo {
namespace {

constexpr std::size_t kQueued = 4;
constexpr int kMaxHeldFrames = 64;
constexpr std::uint32_t kLongestSide = 16384;
constexpr Duration kDefaultPeriod = std::chrono::milliseconds(40);

struct TiffCloser {
  void operator()(TIFF* file) const noexcept { TIFFClose(file); }
};
using TiffPtr = std::unique_ptr<TIFF, TiffCloser>;

struct Size {
  std::uint32_t width = 0, height = 0;
};

std::optional<Size> sizeOfFloats(TIFF* file) noexcept {
  Size size;
  std::uint16_t bits = 0, components = 1, format = 0;
  if (TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &size.width) == 0) return std::nullopt;
  if (TIFFGetField(file, TIFFTAG_IMAGELENGTH, &size.height) == 0) return std::nullopt;
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &components);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &format);
  const bool sound = size.width > 0 && size.height > 0 && std::max(size.width, size.height) <= kLongestSide &&
                     std::uint64_t{size.width} * size.height <= std::uint64_t{VideoDecoder::kMostSamples};
  if (!sound || bits != 32 || components != 1 || format != SAMPLEFORMAT_IEEEFP) return std::nullopt;
  return size;
}

// The two layouts of a TIFF picture: rows, or tiles of `across` x `down` samples.
bool readStrips(TIFF* file, Size size, std::uint16_t* out) {
  if (TIFFScanlineSize64(file) != std::uint64_t{size.width} * sizeof(float)) return false;
  std::vector<float> row(size.width);
  for (std::uint32_t r = 0; r < size.height; ++r) {
    if (TIFFReadScanline(file, row.data(), r) < 0) return false;
    out = std::transform(row.begin(), row.end(), out, millimetres);
  }
  return true;
}
bool readTiles(TIFF* file, Size size, std::uint16_t* out) {
  std::uint32_t across = 0, down = 0;
  TIFFGetField(file, TIFFTAG_TILEWIDTH, &across);
  TIFFGetField(file, TIFFTAG_TILELENGTH, &down);
  if (across == 0 || down == 0 || std::max(across, down) > kLongestSide) return false;
  if (TIFFTileSize64(file) != std::uint64_t{across} * down * sizeof(float)) return false;
  std::vector<float> tile(std::size_t{across} * down);
  for (std::uint32_t y = 0; y < size.height; y += down) {
    for (std::uint32_t x = 0; x < size.width; x += across) {
      if (TIFFReadTile(file, tile.data(), x, y, 0, 0) < 0) return false;
      const std::uint32_t wide = std::min(across, size.width - x), high = std::min(down, size.height - y);
      for (std::uint32_t r = 0; r < high; ++r) {
        std::transform(&tile[std::size_t{r} * across], &tile[std::size_t{r} * across] + wide,
                       out + std::size_t{y + r} * size.width + x, millimetres);
      }
    }
  }
  return true;
}

// nullopt unless the packet is a picture of floats.
std::optional<Frame> pictureOf(const Packet& packet) {
  std::ispanstream bytes(std::span(reinterpret_cast<const char*>(packet.data), packet.bytes));
  const TiffPtr file(TIFFStreamOpen("picture", &bytes));
  if (!file) return std::nullopt;
  const auto size = sizeOfFloats(file.get());
  if (!size) return std::nullopt;
  auto pixels = std::make_shared<std::vector<std::uint16_t>>(std::size_t{size->width} * size->height);
  const bool tiled = TIFFIsTiled(file.get()) != 0;
  if (!(tiled ? readTiles : readStrips)(file.get(), *size, pixels->data())) return std::nullopt;
  Frame frame;
  frame.width = static_cast<int>(size->width);
  frame.height = static_cast<int>(size->height);
  frame.range = ColorRange::Full;
  frame.components[0] = {.step_bytes = 2, .bits = 16};
  frame.plane_count = 1;
  frame.planes[0] = {reinterpret_cast<const std::uint8_t*>(pixels->data()), std::ptrdiff_t{2} * frame.width};
  frame.owner = std::move(pixels);
  return frame;
}

class TiffDecoder final : public VideoDecoder {
 public:
  TiffDecoder() noexcept {
    static std::once_flag silenced;  // libtiff would print to stderr
    std::call_once(silenced, [] {
      TIFFSetErrorHandler(nullptr);
      TIFFSetWarningHandler(nullptr);
    });
  }
  [[nodiscard]] Capabilities capabilities() const noexcept override {
    return {.name = "tiff", .max_held_frames = kMaxHeldFrames, .hardware = false};
  }

 private:
  Result<void> openDecoder(const StreamInfo& stream) override {
    if (stream.codec != "tiff") return fail(ErrorCode::Unsupported, "the stream holds no TIFF pictures");
    period_ = stream.frame_period > Duration(0) ? stream.frame_period : kDefaultPeriod;
    forget();
    return {};
  }

  Result<Feed> feedPacket(const Packet& packet) override {
    if (queue_.size() >= kQueued) return Feed::Full;
    queue_.push_back(packet);
    return Feed::Accepted;
  }

  Result<Progress> receiveFrame(Frame& frame) override {
    while (!queue_.empty()) {
      const Packet packet = std::move(queue_.front());
      queue_.pop_front();
      const MediaTime pts = packet.pts.value_or(next_pts_);
      next_pts_ = pts + period_;
      auto picture = pictureOf(packet);
      if (!picture) {
        countDamaged();
        continue;
      }
      frame = std::move(*picture);
      frame.pts = pts;
      frame.duration = period_;
      return Progress::Picture;
    }
    return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
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

  Duration period_ = kDefaultPeriod;
  std::deque<Packet> queue_;
  MediaTime next_pts_;  // for a packet without a time
  bool draining_ = false;
};

}  // namespace

bool isFloatTiff(const StreamInfo& stream) noexcept {
  return stream.codec == "tiff" && stream.width == 0;
}

std::unique_ptr<VideoDecoder> makeTiffDecoder() {
  return std::make_unique<TiffDecoder>();
}

}  // namespace relievo
