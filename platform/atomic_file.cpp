// SPDX-License-Identifier: Apache-2.0
// Writes to an unnamed file (O_TMPFILE) that is linked in place, or to a temporary one that is renamed; with fsync.
#include "platform/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "platform/files/file_system_answer.h"
#include "platform/files/litter.h"
#include "platform/files/move.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr const char* kThereMeanwhile =
    "another program created this file meanwhile, so it was not replaced; choose another name";
constexpr const char* kMounted =
    "is mounted by itself, so it cannot be replaced; name a file in a folder that is mounted";
constexpr const char* kLongName = "its name is too long; choose a shorter one";
constexpr std::size_t kTextAtOnce = 65536;
constexpr const char* kCannotWrite = "could not be written completely; is the disk full?";

// mkstemp makes files that only the owner can read; reports get the usual permissions.
mode_t ordinaryMode() noexcept {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

Error cannotCreate(int os_error) noexcept {
  if (os_error == ELOOP) return {ErrorCode::Io, os_error, "is a link that leads back to itself; delete the link"};
  if (os_error == ENAMETOOLONG) return {ErrorCode::Io, os_error, kLongName};
  if (os_error == ENXIO) return {ErrorCode::Timeout, 0, "no program reads this pipe; start its reader first"};
  if (os_error == ENOENT) return {ErrorCode::NotFound, os_error, "its folder does not exist; create it first"};
  if (os_error == EACCES || os_error == EROFS) {
    return {ErrorCode::PermissionDenied, os_error, "no permission to write there; choose another folder"};
  }
  return {ErrorCode::Io, os_error, "cannot create a file there; choose another folder"};
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
  if (existing != Existing::Replace) return false;
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

// A file without a final place. Deleted if nobody takes it, since the call that created it may have timed out.
struct Made {
  Made() = default;
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;
  ~Made() {
    if (fd.valid() && !temporary.empty() && !nameless) ::unlink(temporary.c_str());
  }

  UniqueFd fd;
  std::string target, temporary;
  bool nameless = false;
  std::optional<Error> error;
};

void makeTemporary(Made& made) {
  if (made.fd = openNameless(made.target); made.fd.valid()) {
    made.nameless = true;
    made.temporary = "/proc/self/fd/" + std::to_string(made.fd.get());
    return;
  }
  made.temporary = litterPattern(made.target);
  made.fd.reset(::mkostemp(made.temporary.data(), O_CLOEXEC));
}

// A file that is mounted over another, as containers do with single ones.
bool isMountPoint(const std::string& path) noexcept {
  struct statx status{};
  if (::statx(AT_FDCWD, path.c_str(), AT_NO_AUTOMOUNT, STATX_TYPE, &status) != 0) return false;
  return (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

// Devices that take what is written to them in its order, as /dev/stdout does. A disk would lose what is on it.
const char* refusalOf(mode_t mode) noexcept {
  if (S_ISDIR(mode)) return "is a folder; give the name of a file";
  if (S_ISBLK(mode)) return "is a disk, which would lose its files; give the name of a file";
  if (S_ISSOCK(mode)) return "is a socket; give the name of a file";
  return nullptr;
}

// Waits for a pipe's reader no longer than a shell takes to start one beside this program.
UniqueFd openDirectly(const std::string& path, bool pipe) {
  constexpr std::chrono::milliseconds kPatience{200}, kLook{20};
  const auto until = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CLOEXEC | (pipe ? O_NONBLOCK : 0)));
    if (fd.valid() && pipe) ::fcntl(fd.get(), F_SETFL, O_WRONLY);
    if (fd.valid() || errno != ENXIO || !pipe || std::chrono::steady_clock::now() >= until) return fd;
    std::this_thread::sleep_for(kLook);
  }
}

void makeNow(const std::string& path, Made& made) {
  made.target = placeOf(path);
  struct stat status{};
  const bool exists = ::stat(made.target.c_str(), &status) == 0;
  if (!exists && (errno == ELOOP || errno == ENAMETOOLONG)) {
    made.error = cannotCreate(errno);
    return;
  }
  removeLitter(made.target);
  if (const char* const why = exists ? refusalOf(status.st_mode) : nullptr) {
    made.error = Error{ErrorCode::Io, S_ISDIR(status.st_mode) ? EISDIR : 0, why};
    return;
  }
  if (exists && S_ISREG(status.st_mode) && isMountPoint(made.target)) {
    made.error = Error{ErrorCode::Io, EBUSY, kMounted};
    return;
  }
  if (exists && !S_ISREG(status.st_mode)) {
    made.fd = openDirectly(made.target, S_ISFIFO(status.st_mode));
  } else {
    makeTemporary(made);
  }
  if (!made.fd.valid()) made.error = cannotCreate(errno);
  if (made.error || made.temporary.empty()) return;
  ::fchmod(made.fd.get(), exists ? status.st_mode & 0777 : ordinaryMode());
  holdLitter(made.fd.get());
}

// 0 or errno.
int putAt(const std::string& target, const std::string& temporary, bool nameless, Existing existing) {
  if (nameless) return linkInto(target, temporary, existing) ? 0 : errno;
  if (existing != Existing::Replace) return moveToNew(temporary, target);
  return std::rename(temporary.c_str(), target.c_str()) == 0 ? 0 : errno;
}

struct Put {
  std::string target;
  int code = 0;  // or errno
};
Put putInPlace(const std::filesystem::path& target, const std::string& temporary, bool nameless, Existing existing) {
  constexpr int kMostNames = 10'000;
  Put put{target.string()};
  for (int i = 2; i <= kMostNames; ++i) {
    put.code = putAt(put.target, temporary, nameless, existing);
    if (existing != Existing::Beside || put.code != EEXIST) break;
    put.target =
        (target.parent_path() / target.stem()).string() + "-" + std::to_string(i) + target.extension().string();
  }
  return put;
}

}  // namespace

std::string placeOf(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code failed;
  if (const auto real = fs::canonical(path, failed); !failed) return real.string();
  fs::path place = path;
  for (int links = 0; failed == std::errc::no_such_file_or_directory && links < 40; ++links) {
    std::error_code no_link;
    const fs::path next = fs::read_symlink(place, no_link);
    struct stat status{};
    if (no_link || ::stat(place.c_str(), &status) == 0) break;
    place = place.parent_path() / next;
  }
  return place.string();
}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : output_(std::move(other.output_)),
      text_(std::move(other.text_)),
      path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      existing_(other.existing_),
      nameless_(other.nameless_),
      answers_(other.answers_) {}

AtomicFile& AtomicFile::operator=(AtomicFile&& other) noexcept {
  if (this == &other) return *this;
  discard();
  output_ = std::move(other.output_);
  text_ = std::move(other.text_);
  path_ = std::move(other.path_);
  target_ = std::move(other.target_);
  temporary_ = std::exchange(other.temporary_, {});
  existing_ = other.existing_;
  nameless_ = other.nameless_;
  answers_ = other.answers_;
  return *this;
}

AtomicFile::~AtomicFile() {
  discard();
}

Result<AtomicFile> AtomicFile::create(const std::string& path, Existing existing) {
  if (path.empty()) return fail(ErrorCode::InvalidArgument, "the file name is empty; give a path", ENOENT);
  auto answer = answerOf(path, [path] {
    auto made = std::make_shared<Made>();
    makeNow(path, *made);
    return made;
  });
  if (!answer) return std::unexpected(answer.error());
  Made& made = **answer;
  if (made.error) return std::unexpected(*made.error);
  AtomicFile file;
  file.path_ = path;
  file.target_ = made.target;
  file.temporary_ = made.temporary;
  file.existing_ = existing;
  file.nameless_ = made.nameless;
  file.output_ = AnsweredOutput(std::move(made.fd), made.target);
  return file;
}

void AtomicFile::write(std::string_view text) {
  text_ += text;
  if (text_.size() >= kTextAtOnce) writeText();
}

void AtomicFile::writeText() {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text_.data());
  if (output_.valid()) static_cast<void>(output_.write(output_.bytes(), {bytes, text_.size()}));  // `commit` asks
  text_.clear();
}

Result<void> AtomicFile::commit() {
  if (!output_.valid()) return fail(ErrorCode::InvalidState, "the file is not open");
  if (!text_.empty()) writeText();
  auto done = temporary_.empty() ? output_.flush() : output_.sync();
  if (done && !temporary_.empty()) done = moveIntoPlace();
  answers_ = done || done.error().code == ErrorCode::Io;
  discard();
  return done;
}

Result<void> AtomicFile::moveIntoPlace() {
  const CancelsAnswers cancels(output_.cancelFlag());
  const auto moved =
      answerOf(target_, [target = target_, temporary = temporary_, nameless = nameless_, existing = existing_,
                         held = output_] { return putInPlace(target, temporary, nameless, existing); });
  if (!moved) return std::unexpected(moved.error());
  if (moved->code == EEXIST) return fail(ErrorCode::Io, kThereMeanwhile, EEXIST);
  if (moved->code != 0) return fail(ErrorCode::Io, kCannotWrite, moved->code);
  if (moved->target != target_) path_ = target_ = moved->target;
  temporary_.clear();
  return {};
}

void AtomicFile::discard() noexcept {
  if (const auto error = output_.valid() ? output_.error() : std::nullopt; error && error->code != ErrorCode::Io) {
    answers_ = false;
  }
  output_.close();
  text_.clear();
  if (!temporary_.empty() && !nameless_) {
    const auto remove = [name = temporary_] { ::unlink(name.c_str()); };
    const CancelsAnswers kept(nullptr);
    if (answers_) static_cast<void>(fileSystem().ask(target_, remove));  // not left behind when the program ends
    if (!answers_) fileSystem().leave(remove);
  }
  temporary_.clear();
}

}  // namespace relievo
