// SPDX-License-Identifier: Apache-2.0
// Reads TIFF pictures of numbers (a renderer's Z buffers, disparities) by libtiff, and the pages of a file as a film.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "drivers/floats/picture_file_decoder.h"
#include "hal/media/media_source.h"

namespace relievo {

// Floats of 16, 32 and 64 bits and whole numbers of 8 to 64 bits, of one component or three, in strips or tiles, in any
// compression that libtiff supports.
extern const PictureFormat kTiff;

// True for a TIFF stream whose size FFmpeg could not determine, as with floats.
[[nodiscard]] bool isFloatTiff(const StreamInfo& stream) noexcept;

// True if the file is a TIFF with several pages of one size and type. Reads the pages' directories.
[[nodiscard]] bool isTiffFilm(const std::string& path);

// Describes the first page of a file, as a source of single pictures would.
using DescribeFirstPage = std::function<Result<StreamInfo>(const std::string& path)>;

// The pages of the first one's size and type: a film without times. Its packets are TIFF files of one page each. Notes
// how many other pages there are; passes over damaged ones and counts them (`missedPictures`).
[[nodiscard]] std::unique_ptr<MediaSource> makeTiffSource(DescribeFirstPage describe);

}  // namespace relievo
