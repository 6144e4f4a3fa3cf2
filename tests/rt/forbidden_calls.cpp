// SPDX-License-Identifier: Apache-2.0
// Lock functions that count and then call the C library's, and a seccomp filter of four instructions.
#include "tests/rt/forbidden_calls.h"

#include <dlfcn.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <cstddef>

#include "tests/support/machine/sanitizers.h"

namespace relievo::test {
namespace {

constinit thread_local std::uint64_t locks = 0;

}  // namespace

std::uint64_t threadLocks() noexcept {
  return locks;
}

bool forbidSystemCalls() noexcept {
  sock_filter program[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
  };
  const sock_fprog filter{.len = sizeof program / sizeof program[0], .filter = program};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

}  // namespace relievo::test

#if !defined(__SANITIZE_THREAD__) && !RELIEVO_HAS_FEATURE(thread_sanitizer) && !RELIEVO_HAS_FEATURE(realtime_sanitizer)

namespace {

template <class Lock>
using Taker = int (*)(Lock*);

// Counts, then calls the C library's function of that name; `real` is looked up once.
template <class Lock>
int countedLock(Lock* lock, Taker<Lock>& real, const char* name) noexcept {
  ++relievo::test::locks;
  if (real == nullptr) real = reinterpret_cast<Taker<Lock>>(::dlsym(RTLD_NEXT, name));
  return real(lock);
}

constinit Taker<pthread_mutex_t> real_mutex_lock = nullptr, real_mutex_trylock = nullptr;
constinit Taker<pthread_rwlock_t> real_rwlock_rdlock = nullptr, real_rwlock_wrlock = nullptr;

}  // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* lock) noexcept {
  return countedLock(lock, real_mutex_lock, "pthread_mutex_lock");
}
int pthread_mutex_trylock(pthread_mutex_t* lock) noexcept {
  return countedLock(lock, real_mutex_trylock, "pthread_mutex_trylock");
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  return countedLock(lock, real_rwlock_rdlock, "pthread_rwlock_rdlock");
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  return countedLock(lock, real_rwlock_wrlock, "pthread_rwlock_wrlock");
}

}  // extern "C"

#endif
