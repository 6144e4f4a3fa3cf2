// SPDX-License-Identifier: Apache-2.0
// A machine at its limit of processes.
#pragma once

#include <pthread.h>

#include <cstddef>
#include <limits>

namespace relievo::test {

// While this lives, no thread can be started: its stack would be larger than the address space.
class NoThreads {
 public:
  NoThreads() {
    ::pthread_getattr_default_np(&before_);
    pthread_attr_t huge;
    ::pthread_attr_init(&huge);
    ::pthread_attr_setstacksize(&huge, std::numeric_limits<std::size_t>::max() / 4);
    ::pthread_setattr_default_np(&huge);
    ::pthread_attr_destroy(&huge);
  }
  ~NoThreads() {
    ::pthread_setattr_default_np(&before_);
    ::pthread_attr_destroy(&before_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t before_{};
};

}  // namespace relievo::test
