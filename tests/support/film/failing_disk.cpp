// SPDX-License-Identifier: Apache-2.0
// The functions are strong symbols: a sanitizer's runtime has weak ones of the same names.
#include "tests/support/film/failing_disk.h"

#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

namespace relievo::test {

std::atomic<bool> disk_fails = false;
std::atomic<bool> memory_looks_ended = false;

std::optional<ErrorCode> endOnFailingDisk(MediaSource& source) {
  auto packet = source.read();
  disk_fails = packet && *packet;
  while (packet && *packet) packet = source.read();
  disk_fails = false;
  return packet ? std::nullopt : std::optional(packet.error().code);
}

}  // namespace relievo::test

ssize_t pread(int fd, void* bytes, std::size_t size, off_t offset) {
  if (relievo::test::disk_fails) {
    errno = EIO;
    return -1;
  }
  return ::syscall(SYS_pread64, fd, bytes, size, offset);
}

ssize_t preadv2(int fd, const iovec* parts, int count, off_t offset, int flags) {
  if (relievo::test::disk_fails) {
    errno = EIO;
    return -1;
  }
  if (relievo::test::memory_looks_ended && (flags & RWF_NOWAIT) != 0) return 0;
  const std::int64_t wide = offset;
  return ::syscall(SYS_preadv2, fd, parts, count, static_cast<long>(wide), static_cast<long>(wide >> 32), flags);
}
