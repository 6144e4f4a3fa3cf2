// SPDX-License-Identifier: Apache-2.0
#include "platform/files/answered_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <optional>
#include <vector>

#include "platform/files/file_system_answer.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

static_assert(sizeof(off_t) == 8, "build with _FILE_OFFSET_BITS=64");  // else films of over 2 GiB are refused

constexpr std::size_t kMostAtOnce = std::size_t{1} << 20;  // bytes of one question
constexpr Duration kCancelledPatience = std::chrono::milliseconds(100);
constexpr const char* kFailed = "reading failed; check the disk";

std::optional<Error> refusalOf(const struct stat& status) noexcept {
  if (S_ISDIR(status.st_mode)) return Error{ErrorCode::Unsupported, EISDIR, "is a folder; give the name of a file"};
  if (S_ISREG(status.st_mode) || S_ISBLK(status.st_mode)) return std::nullopt;
  return Error{ErrorCode::Unsupported, 0, "is a device or a pipe; name a file"};
}

struct Opened {
  UniqueFd fd;
  std::optional<Error> error;
  bool regular = false;
};

// A pipe is not opened, since that would disturb it.
Opened openNow(const std::string& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) == 0) {
    if (const auto refused = refusalOf(status)) return {{}, refused};
    UniqueFd fd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    if (fd.valid()) return {std::move(fd), std::nullopt, S_ISREG(status.st_mode)};
  }
  if (lacksDescriptors(errno)) return {{}, Error{ErrorCode::Exhausted, errno, kNoDescriptors}};
  const ErrorCode code = errno == EACCES ? ErrorCode::PermissionDenied : ErrorCode::NotFound;
  return {{}, Error{code, errno, "cannot be opened; check the path"}};
}

struct Part {
  std::vector<std::uint8_t> bytes;
  int error = 0;
};

Part readNow(int fd, std::uint64_t offset, std::size_t most) {
  Part part{std::vector<std::uint8_t>(most)};
  ssize_t got = 0;
  do {
    got = ::pread(fd, part.bytes.data(), most, static_cast<off_t>(offset));
  } while (got < 0 && errno == EINTR);
  part.error = got < 0 ? errno : 0;
  part.bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  return part;
}

}  // namespace

struct AnsweredFile::State {
  State(UniqueFd file, std::string name, bool is_regular)
      : fd(std::move(file)), path(std::move(name)), regular(is_regular) {}
  ~State() {
    if (at_once != AtOnce::Yes) fileSystem().leave([fd = fd.release()] { ::close(fd); });
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  UniqueFd fd;
  const std::string path;
  const bool regular;
  // Whether the file system reports what the kernel has cached. Those that may stall do not.
  enum class AtOnce : std::uint8_t { Unknown, Yes, No };
  std::atomic<AtOnce> at_once = AtOnce::Unknown;
  std::atomic<Duration> waited_cancelled{Duration(0)};  // for answers to a thread that was cancelled
  std::mutex mutex;                                     // guards what follows
  std::optional<Error> first_error;

  // As answerOf. A thread that was cancelled gets 0.1 s for all its reads together: a slow mount may answer each in
  // time.
  Result<Part> readSlowly(const std::shared_ptr<State>& self, std::uint64_t offset, std::size_t most) {
    const std::atomic<bool>* const flag = CancelsAnswers::flag();
    const bool cancelled = flag != nullptr && *flag;
    if (cancelled && waited_cancelled.load() >= kCancelledPatience) return std::unexpected(kInterrupted);
    const MonotonicTime begun = MonotonicClock().now();
    auto part = answerOf(path, [self, offset, most] { return readNow(self->fd.get(), offset, most); });
    if (cancelled) waited_cancelled = waited_cancelled.load() + (MonotonicClock().now() - begun);
    return part;
  }

  std::unexpected<Error> noted(const Error& error) {
    const std::scoped_lock lock(mutex);
    if (!first_error) first_error = error;
    return std::unexpected(error);
  }

  // Nullopt if the kernel would have to wait.
  std::optional<Result<std::size_t>> readFromMemory(std::uint64_t offset, std::span<std::uint8_t> out) {
    if (at_once == AtOnce::No) return std::nullopt;
    const iovec part{.iov_base = out.data(), .iov_len = out.size()};
    const ssize_t got = ::preadv2(fd.get(), &part, 1, static_cast<off_t>(offset), RWF_NOWAIT);
    const bool able = got >= 0 || (errno != EOPNOTSUPP && errno != ENOSYS && errno != EINVAL);
    at_once = able ? AtOnce::Yes : AtOnce::No;
    if (got == 0 && !out.empty()) return std::nullopt;  // Linux 5.9 and 5.10: perhaps not the end (readv(2), BUGS)
    if (got >= 0) return static_cast<std::size_t>(got);
    if (!able || errno == EAGAIN || errno == EINTR) return std::nullopt;
    return noted({ErrorCode::Io, errno, kFailed});
  }
};

Result<AnsweredFile> AnsweredFile::open(const std::string& path) {
  auto opened = answerOf(path, [path] { return std::make_shared<Opened>(openNow(path)); });
  if (!opened) return std::unexpected(opened.error());
  Opened& file = **opened;
  if (file.error) return std::unexpected(*file.error);
  AnsweredFile answered;
  answered.state_ = std::make_shared<State>(std::move(file.fd), path, file.regular);
  return answered;
}

bool AnsweredFile::regular() const noexcept {
  return state_->regular;
}

Result<std::uint64_t> AnsweredFile::bytes() const {
  const auto bytes = answerOf(state_->path, [state = state_]() -> std::uint64_t {
    struct stat status{};
    return ::fstat(state->fd.get(), &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
  });
  if (!bytes) return state_->noted(bytes.error());
  return bytes;
}

Result<std::size_t> AnsweredFile::readSome(std::uint64_t offset, std::span<std::uint8_t> out) const {
  if (const auto at_once = state_->readFromMemory(offset, out)) return *at_once;
  const std::size_t most = std::min(out.size(), kMostAtOnce);
  const auto part = state_->readSlowly(state_, offset, most);
  if (!part) return state_->noted(part.error());
  if (part->error != 0) return state_->noted({ErrorCode::Io, part->error, kFailed});
  std::ranges::copy(part->bytes, out.begin());
  return part->bytes.size();
}

Result<std::size_t> AnsweredFile::read(std::uint64_t offset, std::span<std::uint8_t> out) const {
  std::size_t done = 0;
  while (done < out.size()) {
    const auto got = readSome(offset + done, out.subspan(done));
    if (!got) return got;
    if (*got == 0) break;
    done += *got;
  }
  return done;
}

std::optional<Error> AnsweredFile::failure() const {
  const std::scoped_lock lock(state_->mutex);
  auto error = state_->first_error;
  if (error && error->code == ErrorCode::Io) error->code = ErrorCode::Lost;
  return error;
}

}  // namespace relievo
