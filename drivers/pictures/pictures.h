// SPDX-License-Identifier: Apache-2.0
// Media source of single pictures: folders, patterns, lists, and a picture alone.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "hal/media/media_source.h"
#include "platform/error.h"

namespace relievo {

// Describes the video of one picture's file, as a source that opens it would: codec, size, signalling.
using DescribePicture = std::function<Result<StreamInfo>(const std::string& path)>;

// Opens a picture's file whose bytes are not the picture itself, such as an archive; null for other files.
using UnpackPicture = std::function<std::unique_ptr<MediaSource>(const std::string& path)>;

// The tag of a described picture whose file holds its depth too: the codec that reads it there. Alone or as colour it
// makes a second stream.
inline constexpr const char* kInsideTag = "DEPTH_INSIDE";

// The tag of a described picture with a line for the user about its file, which becomes a note of the source.
inline constexpr const char* kNoteTag = "NOTE_ON_FILE";

// Whether makePicturesSource opens `url`: a folder, a picture or a list of pictures (.txt) that exists, or a pattern of
// names ("a/%06d.png", "a/*.png"). Reads no file.
[[nodiscard]] bool isPictures(const std::string& url);

// One packet for each file (of at most 140 MB; EXR, PFM and npy 300 MB), whole, with its exact time
// (drivers/pictures/recording.h); every packet is a key frame, and a seek finds the picture by index. A recording of
// colour and depth has two streams, colour first; the depth has the tag TITLE=depth. A folder is listed but only the
// first picture of each stream is opened before it is read. A picture that cannot be opened any more is passed over and
// counted (`missedPictures`). Depth beside colour that cannot be opened is left out, with a note.
[[nodiscard]] std::unique_ptr<MediaSource> makePicturesSource(DescribePicture describe, UnpackPicture unpack = {});

}  // namespace relievo
