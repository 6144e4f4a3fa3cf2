// SPDX-License-Identifier: Apache-2.0
// A disk that fails while a film is read from it. Replaces the C library's preadv2 in the program, and its pread, which
// reads where the file system (tmpfs) knows nothing of RWF_NOWAIT.
#pragma once

#include <atomic>
#include <optional>

#include "hal/media/media_source.h"

namespace relievo::test {

extern std::atomic<bool> disk_fails;
// As on Linux 5.9 and 5.10: what the kernel has not in its memory looks like the file's end.
extern std::atomic<bool> memory_looks_ended;

// How the open film ends if the disk fails behind its first packet; nullopt if it is told as a normal end.
std::optional<ErrorCode> endOnFailingDisk(MediaSource& source);

}  // namespace relievo::test
