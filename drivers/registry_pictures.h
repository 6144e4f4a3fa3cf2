// SPDX-License-Identifier: Apache-2.0
// Single pictures: what a file holds, for the source of pictures (drivers/pictures/pictures.h), and who reads it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "drivers/floats/picture_file_decoder.h"
#include "hal/media/media_source.h"

namespace relievo::drivers {

// The first video of the file. One that holds its depth too is described as its colour, with kInsideTag.
[[nodiscard]] Result<StreamInfo> describePicture(const std::string& path);

// What reads the picture in an archive (npz); null for other files.
[[nodiscard]] std::unique_ptr<MediaSource> unpackPicture(const std::string& path);

// The project's own reader of the stream's pictures; nullopt if FFmpeg decodes them.
[[nodiscard]] std::optional<PictureFormat> pictureFormat(const StreamInfo& stream);

}  // namespace relievo::drivers
