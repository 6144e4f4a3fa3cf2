// SPDX-License-Identifier: Apache-2.0
// NumPy's archives of arrays (npz): ZIP files of npy files, stored or deflated.
#pragma once

#include <memory>
#include <string>

#include "hal/media/media_source.h"

namespace relievo {

// True if a file exists at the path and begins like a ZIP file whose first member is a npy file.
[[nodiscard]] bool isNpz(const std::string& path);

// The array of the archive that is a picture or a film and whose name says depth or disparity, or the only one that is
// a picture or a film: a film without times, as makeNpySource() gives it. Unsupported if none or several of them may be
// meant. The stream's FILE tag has the array's name behind the archive's.
[[nodiscard]] std::unique_ptr<MediaSource> makeNpzSource();

}  // namespace relievo
