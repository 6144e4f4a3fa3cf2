// SPDX-License-Identifier: Apache-2.0
// A disk that fails while a film is read from it. Replaces the C library's preadv2 in the program, and its pread, which
// reads where the file system (tmpfs) knows nothing of RWF_NOWAIT.
#pragma once

#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/media/media_source.h"

namespace relievo::test {

inline std::atomic<bool> disk_fails = false;
// As on Linux 5.9 and 5.10: what the kernel has not in its memory looks like the file's end.
inline std::atomic<bool> memory_looks_ended = false;

// How the open film ends if the disk fails behind its first packet; nullopt if it is told as a normal end.
inline std::optional<ErrorCode> endOnFailingDisk(MediaSource& source) {
  auto packet = source.read();
  disk_fails = packet && *packet;
  while (packet && *packet) packet = source.read();
  disk_fails = false;
  return packet ? std::nullopt : std::optional(packet.error().code);
}

}  // namespace relievo::test

[[gnu::weak]] ssize_t pread(int fd, void* bytes, std::size_t size, off_t offset) {
  if (relievo::test::disk_fails) {
    errno = EIO;
    return -1;
  }
  return ::syscall(SYS_pread64, fd, bytes, size, offset);
}

[[gnu::weak]] ssize_t preadv2(int fd, const iovec* parts, int count, off_t offset, int flags) {
  if (relievo::test::disk_fails) {
    errno = EIO;
    return -1;
  }
  if (relievo::test::memory_looks_ended && (flags & RWF_NOWAIT) != 0) return 0;
  const std::int64_t wide = offset;
  return ::syscall(SYS_preadv2, fd, parts, count, static_cast<long>(wide), static_cast<long>(wide >> 32), flags);
}
