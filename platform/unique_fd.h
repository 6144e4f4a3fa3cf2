// SPDX-License-Identifier: Apache-2.0
// A file descriptor with one owner, closed by its destructor.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace relievo {

// Of a file that cannot be opened.
[[nodiscard]] inline bool lacksDescriptors(int os_error) noexcept {
  return os_error == EMFILE || os_error == ENFILE;
}
inline constexpr const char* kNoDescriptors =
    "cannot be opened: as many files are open as the limit on open files allows; raise it (ulimit -n) or close some";

class UniqueFd {
 public:
  UniqueFd() noexcept = default;
  explicit UniqueFd(int fd) noexcept : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    if (this != &other) reset(std::exchange(other.fd_, -1));
    return *this;
  }
  UniqueFd(const UniqueFd&) = delete;
  UniqueFd& operator=(const UniqueFd&) = delete;
  ~UniqueFd() { reset(); }

  [[nodiscard]] int get() const noexcept { return fd_; }
  [[nodiscard]] bool valid() const noexcept { return fd_ >= 0; }
  [[nodiscard]] int release() noexcept { return std::exchange(fd_, -1); }
  void reset(int fd = -1) noexcept {
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
  }

 private:
  int fd_ = -1;
};

}  // namespace relievo
