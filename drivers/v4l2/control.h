// SPDX-License-Identifier: Apache-2.0
// ioctl(2) for V4L2 devices.
#pragma once

#include <sys/ioctl.h>

#include <cerrno>

namespace relievo::v4l2 {

// ioctl(2), retried after a signal.
inline int control(int fd, unsigned long request, void* argument) noexcept {
  int answer = 0;
  do {
    answer = ::ioctl(fd, request, argument);
  } while (answer < 0 && errno == EINTR);
  return answer;
}

}  // namespace relievo::v4l2
