// SPDX-License-Identifier: Apache-2.0
// Counts the tags of a Matroska file before FFmpeg reads them: its time for them grows with the square of their number.
// Chapters take it 430 bytes of memory each, tracks 55 times the bytes that they have in the file, places to seek
// to 18.
#pragma once

#include "platform/files/answered_file.h"

namespace relievo::ffmpeg {

// 100,000 tags take FFmpeg three minutes, in which nothing can interrupt it; programs write a few for each track.
inline constexpr int kMostTags = 5000;
inline constexpr const char* kTooManyTags =
    "it is a Matroska film with more than 5000 tags, the most that it may have; convert it without them: ffmpeg -i "
    "FILE -map 0 -map_metadata -1 -c copy film.mp4";
inline constexpr const char* kTooLongTags =
    "it is a Matroska film whose tags are longer than 1 MiB, the most that they may be; convert it without them: "
    "ffmpeg -i FILE -map 0 -map_metadata -1 -c copy film.mp4";
inline constexpr const char* kTooLongChapters =
    "it is a Matroska film whose chapters are longer than 1 MiB, the most that they may be; convert it without them: "
    "ffmpeg -i FILE -map 0 -map_chapters -1 -c copy film.mp4";

inline constexpr const char* kTooManyTracks =
    "it is a Matroska film whose list of tracks is longer than 4 MiB, the most that it may be; keep a few of them: "
    "ffmpeg -i FILE -map 0:v -map 0:a? -c copy film.mkv";
inline constexpr const char* kTooManyCues =
    "it is a Matroska film whose list of places to seek to is longer than 24 MiB, the most that it may be; cut it in "
    "two: ffmpeg -i FILE -map 0 -c copy -f segment -segment_time 1:00:00 film-%d.mkv";

// Which of these holds, or null. Looks where FFmpeg looks: before the first cluster, and where seek heads point to.
// Null for what is no Matroska, and for what cannot be read.
[[nodiscard]] const char* tooManyTags(const AnsweredFile& file);

}  // namespace relievo::ffmpeg
