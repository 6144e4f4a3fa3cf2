// SPDX-License-Identifier: Apache-2.0
// Pictures of numbers that need no library: PFM (portable float map), NumPy's npy and Sintel's dpt.
#pragma once

#include <memory>
#include <string>

#include "drivers/floats/picture_file_decoder.h"
#include "hal/media/media_source.h"

namespace relievo {

// "Pf" and "PF": 32-bit floats of either byte order, rows from the bottom up.
extern const PictureFormat kPfm;

// 32-bit floats, rows from the top down.
extern const PictureFormat kDpt;
// The picture of a dpt file, as a stream; nullopt if the file does not begin like one.
[[nodiscard]] std::optional<StreamInfo> describeDpt(const std::string& path);

// One picture: an array of rows x columns, or rows x columns x 1 or 3, with leading dimensions of 1. Floats of 16, 32
// and 64 bits, whole numbers of 8 to 64 bits, of either byte order, in C or Fortran order.
extern const PictureFormat kNpy;

// True if a file exists at the path and begins like a npy file.
[[nodiscard]] bool isNpyFile(const std::string& path);

// A npy file of one picture, or of pictures x rows x columns (x 1 or 3): a film without times. Its packets are npy
// files of one picture each. Unsupported for other arrays, and for a film in Fortran order.
[[nodiscard]] std::unique_ptr<MediaSource> makeNpySource();

}  // namespace relievo
