// SPDX-License-Identifier: Apache-2.0
// Looks at the lists of a Matroska file before FFmpeg reads them: its time for tags grows with the square of their
// number, and each list takes memory several times. A chapter takes it 430 bytes, a track 1500, an attachment 70 and
// twice its data, places to seek to 18 times the bytes that they have in the file.
#pragma once

#include "drivers/ffmpeg/bounds/readable.h"

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

// FFmpeg itself takes at most 1000 tracks and attachments.
inline constexpr const char* kTooManyTracks =
    "it is a Matroska film whose list of tracks is longer than 4 MiB or 1000 tracks, the most that it may be; keep a "
    "few of them: ffmpeg -i FILE -map 0:v -map 0:a? -c copy film.mkv";
// Fonts, mostly: films with subtitles in Chinese have up to 100 MB of them.
inline constexpr const char* kTooManyAttachments =
    "it is a Matroska film with more than 1000 attachments or 128 MiB of them, the most that it may have; copy it "
    "without them: ffmpeg -i FILE -map 0 -map -0:t -c copy film.mkv";
// A place is a point in time and a position for each track that it names; as programs write them, they take 11 bytes
// and more each. Those that hold nothing take FFmpeg 330 MB.
inline constexpr int kMostCues = 2'500'000;
inline constexpr const char* kTooManyCues =
    "it is a Matroska film whose list of places to seek to is longer than 24 MiB or 2.5 million points and positions, "
    "the most that it may be; cut it: ffmpeg -i FILE -map 0 -c copy -f segment -segment_time 1:00:00 film-%d.mkv";
// A film has about ten.
inline constexpr const char* kTooManyElements =
    "it is a Matroska film with more than 1000 elements before its pictures, or 1 MiB of information or of places of "
    "its elements, the most that it may have; write it anew: ffmpeg -i FILE -map 0 -c copy film.mkv";

// Which of these holds, or null. Looks where FFmpeg looks: before the first cluster, and where seek heads point to.
// Null for what is no Matroska, and for what cannot be read.
[[nodiscard]] const char* exceededMatroskaBound(const Readable& file);

}  // namespace relievo::ffmpeg
