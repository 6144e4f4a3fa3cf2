// SPDX-License-Identifier: Apache-2.0
// Looks at the tables of an MP4 or QuickTime film before FFmpeg reads them: 20 bytes of a table say that a track has
// four thousand million pictures, and each takes FFmpeg 24 bytes or more. Its time for tags and for the places of
// fragments grows with the square of their number.
#pragma once

#include "drivers/ffmpeg/bounds/readable.h"

namespace relievo::ffmpeg {

// Ten hours of colour and depth, 60 pictures a second each, with sound are six million.
inline constexpr std::uint64_t kMostMp4Samples = 8'000'000;
inline constexpr const char* kTooManyMp4Samples =
    "it is an MP4 or QuickTime film whose tables and edits list more than 8 million samples (pictures, pieces of "
    "sound, readings of sensors), the most that they may list; cut it: ffmpeg -i FILE -map 0:v -map 0:a? -c copy -f "
    "segment -segment_time 1:00:00 film-%d.mkv";
inline constexpr int kMostMp4Tags = 5000;
inline constexpr const char* kTooManyMp4Tags =
    "it is an MP4 or QuickTime film with more than 5000 tags, the most that it may have; convert it without them: "
    "ffmpeg -i FILE -map 0:v -map 0:a? -map_metadata -1 -c copy film.mkv";
// FFmpeg itself takes at most 1000 tracks.
inline constexpr const char* kTooManyMp4Boxes =
    "it is an MP4 or QuickTime film with more than 1000 tracks, 100,000 boxes or 200,000 fragments, the most that it "
    "may have; write it anew: ffmpeg -i FILE -map 0:v -map 0:a? -c copy film.mkv";
inline constexpr const char* kTooLongMp4Header =
    "it is a QuickTime film whose packed header is damaged, not the only one, or longer than 16 MiB, the most that it "
    "may be; write it anew: ffmpeg -i FILE -map 0:v -map 0:a? -c copy film.mkv";

// Which of these holds, or null. Looks at the header and the first fragments, as FFmpeg does when it opens a film. Null
// for what is no such film, and for what cannot be read.
[[nodiscard]] const char* exceededMp4Bound(const Readable& file);

}  // namespace relievo::ffmpeg
