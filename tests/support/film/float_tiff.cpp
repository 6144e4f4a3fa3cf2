// SPDX-License-Identifier: Apache-2.0
#include "tests/support/film/float_tiff.h"

#include <tiffio.h>

#include <algorithm>
#include <stdexcept>

namespace relievo::test {
namespace {

void write(const std::string& path, const char* mode, const FloatTiff& picture) {
  TIFF* const file = TIFFOpen(path.c_str(), mode);
  if (file == nullptr) throw std::runtime_error(path + ": cannot be written");
  TIFFSetField(file, TIFFTAG_IMAGEWIDTH, picture.width);
  TIFFSetField(file, TIFFTAG_IMAGELENGTH, picture.height);
  TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, 32);
  TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, picture.sample_format);
  TIFFSetField(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(file, TIFFTAG_COMPRESSION, picture.compression);
  if (picture.predictor != 1) TIFFSetField(file, TIFFTAG_PREDICTOR, picture.predictor);
  bool written = true;
  if (picture.tile == 0) {
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, 7);
    for (std::uint32_t r = 0; r < picture.height; ++r) {
      const float* const first = picture.samples.data() + std::size_t{r} * picture.width;
      std::vector<float> row(first, first + picture.width);
      written = written && TIFFWriteScanline(file, row.data(), r, 0) >= 0;
    }
  } else {
    TIFFSetField(file, TIFFTAG_TILEWIDTH, picture.tile);
    TIFFSetField(file, TIFFTAG_TILELENGTH, picture.tile);
    for (std::uint32_t y = 0; y < picture.height; y += picture.tile) {
      for (std::uint32_t x = 0; x < picture.width; x += picture.tile) {
        std::vector<float> tile(std::size_t{picture.tile} * picture.tile, -1.0F);
        for (std::uint32_t r = y; r < std::min(y + picture.tile, picture.height); ++r) {
          const std::uint32_t end = std::min(x + picture.tile, picture.width);
          const float* const row = picture.samples.data() + std::size_t{r} * picture.width;
          std::copy(row + x, row + end, tile.data() + std::size_t{r - y} * picture.tile);
        }
        written = written && TIFFWriteTile(file, tile.data(), x, y, 0, 0) >= 0;
      }
    }
  }
  TIFFClose(file);
  if (!written) throw std::runtime_error(path + ": cannot be written");
}

}  // namespace

void writeFloatTiff(const std::string& path, const FloatTiff& picture) {
  write(path, "w", picture);
}
void addFloatPage(const std::string& path, const FloatTiff& picture) {
  write(path, "a", picture);
}

}  // namespace relievo::test
