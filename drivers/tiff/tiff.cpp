// SPDX-License-Identifier: Apache-2.0
// Reads numbers in strips or tiles.
#include "drivers/tiff/tiff.h"

#include <tiffio.h>
#include <tiffio.hxx>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <spanstream>
#include <vector>

namespace relievo {
namespace {

constexpr std::uint32_t kLongestTile = 16384;

struct TiffCloser {
  void operator()(TIFF* file) const noexcept { TIFFClose(file); }
};
using TiffPtr = std::unique_ptr<TIFF, TiffCloser>;

struct Layout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t components = 1;
  NumberType type;
  [[nodiscard]] std::size_t pixelBytes() const noexcept {
    return std::size_t{components} * static_cast<std::size_t>(type.bytes);
  }
};

std::optional<NumberType> typeOf(std::uint16_t bits, std::uint16_t format) noexcept {
  const NumberType type{.kind = format == SAMPLEFORMAT_IEEEFP ? 'f'
                                : format == SAMPLEFORMAT_INT  ? 'i'
                                                              : 'u',
                        .bytes = bits / 8};
  const bool known = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT || format == SAMPLEFORMAT_IEEEFP;
  const bool sound = bits == 16 || bits == 32 || bits == 64 || (bits == 8 && type.kind != 'f');
  return known && sound ? std::optional(type) : std::nullopt;
}

// Nullopt unless a pixel is a number, or three numbers that lie together.
std::optional<Layout> layoutOf(TIFF* file) noexcept {
  Layout layout;
  std::uint16_t bits = 1, format = SAMPLEFORMAT_UINT, planes = PLANARCONFIG_CONTIG, meaning = PHOTOMETRIC_MINISBLACK;
  if (TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &layout.width) == 0) return std::nullopt;
  if (TIFFGetField(file, TIFFTAG_IMAGELENGTH, &layout.height) == 0) return std::nullopt;
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &layout.components);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &planes);
  TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &meaning);
  const auto type = typeOf(bits, format);
  const bool gray = layout.components == 1 && meaning == PHOTOMETRIC_MINISBLACK;
  const bool rgb = layout.components == 3 && (meaning == PHOTOMETRIC_RGB || meaning == PHOTOMETRIC_MINISBLACK) &&
                   planes == PLANARCONFIG_CONTIG;
  if (!type || !(gray || rgb) || !isSoundSize(layout.width, layout.height)) return std::nullopt;
  layout.type = *type;
  return layout;
}

// Converts `pixels` of a row at `from`.
float* convert(const std::uint8_t* from, std::size_t pixels, const Layout& layout, float* to) noexcept {
  const std::uint8_t* const end = from + pixels * layout.pixelBytes();
  for (; from < end; from += layout.type.bytes) *to++ = numberAt(from, layout.type);
  return to;
}

// The two layouts of a TIFF picture: rows, or tiles of `across` x `down` pixels.
bool readStrips(TIFF* file, const Layout& layout, float* out) {
  std::vector<std::uint8_t> row(layout.width * layout.pixelBytes());
  if (TIFFScanlineSize64(file) != row.size()) return false;
  for (std::uint32_t r = 0; r < layout.height; ++r) {
    if (TIFFReadScanline(file, row.data(), r) < 0) return false;
    out = convert(row.data(), layout.width, layout, out);
  }
  return true;
}
bool readTiles(TIFF* file, const Layout& layout, float* out) {
  std::uint32_t across = 0, down = 0;
  TIFFGetField(file, TIFFTAG_TILEWIDTH, &across);
  TIFFGetField(file, TIFFTAG_TILELENGTH, &down);
  if (across == 0 || down == 0 || std::max(across, down) > kLongestTile || !isSoundSize(across, down)) return false;
  const std::size_t row_bytes = across * layout.pixelBytes();
  if (TIFFTileSize64(file) != std::uint64_t{row_bytes} * down) return false;
  std::vector<std::uint8_t> tile(row_bytes * down);
  for (std::uint32_t y = 0; y < layout.height; y += down) {
    for (std::uint32_t x = 0; x < layout.width; x += across) {
      if (TIFFReadTile(file, tile.data(), x, y, 0, 0) < 0) return false;
      const std::uint32_t wide = std::min(across, layout.width - x), high = std::min(down, layout.height - y);
      for (std::uint32_t r = 0; r < high; ++r) {
        float* const to = out + (std::size_t{y + r} * layout.width + x) * layout.components;
        convert(&tile[r * row_bytes], wide, layout, to);
      }
    }
  }
  return true;
}

void silenceLibrary() {  // libtiff would print to stderr
  static std::once_flag silenced;
  std::call_once(silenced, [] {
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
  });
}

std::optional<FilePicture> readTiff(std::span<const std::uint8_t> bytes) {
  silenceLibrary();
  std::ispanstream stream(std::span(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  const TiffPtr file(TIFFStreamOpen("picture", &stream));
  if (!file) return std::nullopt;
  const auto layout = layoutOf(file.get());
  if (!layout) return std::nullopt;
  FilePicture picture{.width = static_cast<int>(layout->width),
                      .height = static_cast<int>(layout->height),
                      .components = layout->components};
  picture.samples.resize(std::size_t{layout->width} * layout->height * layout->components);
  const bool tiled = TIFFIsTiled(file.get()) != 0;
  if (!(tiled ? readTiles : readStrips)(file.get(), *layout, picture.samples.data())) return std::nullopt;
  picture.whole_bits = wholeBits(layout->type, picture.samples);
  return picture;
}

}  // namespace

const PictureFormat kTiff{"tiff", readTiff};

bool isFloatTiff(const StreamInfo& stream) noexcept {
  return stream.codec == "tiff" && stream.width == 0;
}

}  // namespace relievo
