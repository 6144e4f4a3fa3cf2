// SPDX-License-Identifier: Apache-2.0
// Writes to an unnamed file (O_TMPFILE) that is linked in place, or to a temporary one that is renamed; with fsync.
#include "platform/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include "platform/litter.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr const char* kThereMeanwhile =
    "another program created this file meanwhile, so it was not replaced; choose another name";
constexpr const char* kCannotWrite = "could not be written completely; is the disk full?";

// mkstemp makes files that only the owner can read; reports get the usual permissions.
mode_t ordinaryMode() noexcept {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

std::unexpected<Error> cannotCreate(int os_error) noexcept {
  if (os_error == ENOENT) return fail(ErrorCode::NotFound, "its folder does not exist; create it first", os_error);
  if (os_error == EACCES || os_error == EROFS) {
    return fail(ErrorCode::PermissionDenied, "no permission to write there; choose another folder", os_error);
  }
  return fail(ErrorCode::Io, "cannot create a file there; choose another folder", os_error);
}

// Invalid where the file system has no unnamed files, or without /proc, whose path is the file's only name.
UniqueFd openNameless(const std::string& target) {
  const std::string folder = std::filesystem::path(target).parent_path().string();
  UniqueFd fd(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666));
  if (fd.valid() && ::access(("/proc/self/fd/" + std::to_string(fd.get())).c_str(), W_OK) != 0) fd.reset();
  return fd;
}

// linkat cannot replace an existing file: to do so, link under a temporary name and rename that.
bool linkInto(const std::string& target, const std::string& nameless, Existing existing) {
  const auto link = [&](const std::string& name) {
    return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (link(target)) return true;
  if (existing == Existing::Keep) return false;
  std::string beside;
  for (int i = 0; errno == EEXIST && i < 100; ++i) {
    beside = litterPattern(target);
    beside.replace(beside.size() - 6, 6, std::to_string(::getpid()) + "-" + std::to_string(i));
    if (!link(beside)) continue;
    if (std::rename(beside.c_str(), target.c_str()) == 0) return true;
    const int os_error = errno;
    ::unlink(beside.c_str());
    errno = os_error;
    return false;
  }
  return false;
}

}  // namespace

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)),
      path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      existing_(other.existing_),
      nameless_(other.nameless_) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  file_ = std::exchange(other.file_, nullptr);
  path_ = std::move(other.path_);
  target_ = std::move(other.target_);
  temporary_ = std::exchange(other.temporary_, {});
  existing_ = other.existing_;
  nameless_ = other.nameless_;
  return *this;
}

AtomicFile::~AtomicFile() {
  discard();
}

Result<AtomicFile> AtomicFile::create(const std::string& path, Existing existing) {
  AtomicFile made;
  made.existing_ = existing;
  made.path_ = path;
  made.target_ = path;
  std::error_code missing;
  if (const auto real = std::filesystem::canonical(path, missing); !missing) made.target_ = real.string();
  if (path.empty()) return fail(ErrorCode::InvalidArgument, "the file name is empty; give a path", ENOENT);

  removeLitter(made.target_);
  UniqueFd fd;
  struct stat status{};
  const bool exists = ::stat(made.target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return fail(ErrorCode::Io, "is a folder; give the name of a file", EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    fd.reset(::open(made.target_.c_str(), O_WRONLY | O_CLOEXEC));
  } else if (fd = openNameless(made.target_); fd.valid()) {
    made.nameless_ = true;
    made.temporary_ = "/proc/self/fd/" + std::to_string(fd.get());
  } else {
    made.temporary_ = litterPattern(made.target_);
    fd.reset(::mkostemp(made.temporary_.data(), O_CLOEXEC));
    if (!fd.valid()) made.temporary_.clear();
  }
  if (!fd.valid()) return cannotCreate(errno);
  if (!made.temporary_.empty()) ::fchmod(fd.get(), exists ? status.st_mode & 0777 : ordinaryMode());
  if (!made.temporary_.empty()) holdLitter(fd.get());
  made.file_ = ::fdopen(fd.get(), "w");
  if (made.file_ == nullptr) return cannotCreate(errno);
  static_cast<void>(fd.release());
  return made;
}

void AtomicFile::write(std::string_view text) noexcept {
  if (file_ != nullptr) static_cast<void>(std::fwrite(text.data(), 1, text.size(), file_));  // commit asks ferror
}

Result<void> AtomicFile::commit() {
  if (file_ == nullptr) return fail(ErrorCode::InvalidState, "the file is not open");
  bool good = std::fflush(file_) == 0 && std::ferror(file_) == 0;
  if (good && !temporary_.empty()) good = ::fsync(::fileno(file_)) == 0 && putInPlace();
  const int os_error = errno;
  good = std::fclose(std::exchange(file_, nullptr)) == 0 && good;
  if (good) return {};
  discard();
  if (os_error == EEXIST) return fail(ErrorCode::Io, kThereMeanwhile, os_error);
  return fail(ErrorCode::Io, kCannotWrite, os_error);
}

bool AtomicFile::putInPlace() {
  const unsigned how = existing_ == Existing::Keep ? RENAME_NOREPLACE : 0;
  const bool done = nameless_ ? linkInto(target_, temporary_, existing_)
                              : ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), how) == 0;
  if (done) temporary_.clear();
  return done;
}

void AtomicFile::discard() noexcept {
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  if (!temporary_.empty() && !nameless_) ::unlink(temporary_.c_str());
  temporary_.clear();
}

}  // namespace relievo
