// SPDX-License-Identifier: Apache-2.0
// The files that a source reads, including those that only a list or the source's own name tells of.
#pragma once

#include <string>
#include <vector>

namespace relievo {

// The local path that an address names; empty for other addresses.
[[nodiscard]] std::string localPathIn(const std::string& address);
// True for a file, a folder, a pattern or a name that is missing: no pipe, device or address, which may keep its reader
// waiting or can be read only once.
[[nodiscard]] bool isOfFiles(const std::string& address);

// The existing files that opening `address` reads: the file itself (also as a `file:` address), the pictures of a
// numbered sequence (`%04d`) or of a folder, and everything that a list names, nested lists included: playlists, HLS,
// FFmpeg's concat (known by its beginning, under any name) and DASH (also all files of its folder). With a film, its
// subtitles and the camera's file beside it, but not its depth, which may be another file. Of a folder's .json and
// .csv, only the camera's file: others may be reports. Empty if it is not a file.
// Bounded: four levels of lists of up to 256 MiB, 200,000 files.
[[nodiscard]] std::vector<std::string> filesReadBy(const std::string& address);

}  // namespace relievo
