// SPDX-License-Identifier: Apache-2.0
// Converts bottom-up RGBA to planar BT.709 and keeps the file's frame rate.
#include "drivers/egl/y4m_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <thread>

#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr const char* kCannotWrite = "the capture file cannot be written; check its folder and permissions";

// In periods: how late a picture may be before the last one is repeated, and how early before it is dropped. A picture
// that jitter makes late and the file then repeats leaves the next one half a period early: it is kept.
constexpr double kLatePeriods = 0.5;
constexpr double kEarlyPeriods = 1.0;

// ITU-R BT.709-6, 3.2 to 3.5, limited range, in 1/65536: the rows sum to 219/255 and to 0.
constexpr int kShift = 16;
constexpr int kYr = 11966, kYg = 40254, kYb = 4064;
constexpr int kUr = -6596, kUg = -22189, kUb = 28785;
constexpr int kVr = 28784, kVg = -26145, kVb = -2639;
constexpr int kHalf = 1 << (kShift - 1);

std::uint8_t luma(const std::uint8_t* p) noexcept {
  return static_cast<std::uint8_t>(16 + ((kYr * p[0] + kYg * p[1] + kYb * p[2] + kHalf) >> kShift));
}

// Never NotFound, since the player would then wait for the display to appear.
ErrorCode codeOf(int os_error) noexcept {
  if (os_error == EACCES || os_error == EROFS) return ErrorCode::PermissionDenied;
  return ErrorCode::Io;
}

// Without O_NONBLOCK, open(2) would wait for the reader of a pipe; the pictures then wait for it. A reader that is
// started together with the player, as in `encode < pipe & relievo ..`, may open the pipe a moment later.
UniqueFd openCapture(const std::string& path) noexcept {
  constexpr int kLooks = 50;
  for (int look = 0;; ++look) {
    UniqueFd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666));
    if (fd.valid() || errno != ENXIO || look == kLooks) return fd;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

// Two programs that write one file would mix their pictures. False, with errno: another one writes it.
bool takeForItself(int fd) noexcept {
  struct stat status{};
  if (::fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) return true;
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;  // some mounts have no locks
  return ::ftruncate(fd, 0) == 0;
}

}  // namespace

Y4mWriter::Y4mWriter(std::FILE* file, int width, int height, double rate)
    : file_(file),
      width_(width),
      height_(height),
      rate_(rate),
      picture_(static_cast<std::size_t>(width) * height +
               2 * static_cast<std::size_t>((width + 1) / 2) * static_cast<std::size_t>((height + 1) / 2)) {}

Result<Y4mWriter> Y4mWriter::create(const std::string& path, int width, int height, double rate) {
  UniqueFd fd = openCapture(path);
  if (!fd.valid() && errno == ENXIO) {
    return fail(ErrorCode::Io, "no program reads this pipe; start its reader first", errno);
  }
  if (fd.valid() && !takeForItself(fd.get())) {
    const bool is_taken = errno == EWOULDBLOCK;
    return fail(ErrorCode::Io, is_taken ? "another program writes this file; choose another file" : kCannotWrite,
                errno);
  }
  const bool waits = fd.valid() && ::fcntl(fd.get(), F_SETFL, O_WRONLY) == 0;
  std::FILE* const file = waits ? ::fdopen(fd.get(), "wb") : nullptr;
  if (file == nullptr) {
    return fail(codeOf(errno), kCannotWrite, errno);
  }
  static_cast<void>(fd.release());
  const long thousandths = std::lround(rate * 1000.0);
  Y4mWriter writer(file, width, height, static_cast<double>(thousandths) / 1000.0);
  if (std::fprintf(file, "YUV4MPEG2 W%d H%d F%ld:1000 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n", width, height,
                   thousandths) < 0) {
    return fail(ErrorCode::Io, "the capture file cannot be written; is the disk full?", errno);
  }
  return writer;
}

Result<void> Y4mWriter::write(std::span<const std::uint8_t> rgba, MonotonicTime time) {
  if (written_ == 0) first_ = time;
  const double due = toSeconds(time - first_) * rate_;  // the file's number of pictures before this one
  while (static_cast<double>(written_) + kLatePeriods < due) {
    if (auto repeated = append(); !repeated) return repeated;
  }
  if (static_cast<double>(written_) > due + kEarlyPeriods) return {};
  convert(rgba);
  return append();
}

void Y4mWriter::convert(std::span<const std::uint8_t> rgba) noexcept {
  const std::ptrdiff_t row_bytes = static_cast<std::ptrdiff_t>(width_) * 4;
  const auto rowFromTop = [&](int y) { return rgba.data() + (height_ - 1 - y) * row_bytes; };

  std::uint8_t* out = picture_.data();
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* row = rowFromTop(y);
    for (int x = 0; x < width_; ++x) *out++ = luma(row + static_cast<std::ptrdiff_t>(x) * 4);
  }

  const int chroma_width = (width_ + 1) / 2;
  const int chroma_height = (height_ + 1) / 2;
  std::uint8_t* u = out;
  std::uint8_t* v = u + static_cast<std::ptrdiff_t>(chroma_width) * chroma_height;
  for (int y = 0; y < chroma_height; ++y) {
    const std::uint8_t* upper = rowFromTop(2 * y);
    const std::uint8_t* lower = rowFromTop(std::min(2 * y + 1, height_ - 1));
    for (int x = 0; x < chroma_width; ++x) {
      const std::ptrdiff_t left = static_cast<std::ptrdiff_t>(x) * 8;
      const std::ptrdiff_t right = std::min(left + 4, row_bytes - 4);
      const auto sum = [&](int channel) {
        return upper[left + channel] + upper[right + channel] + lower[left + channel] + lower[right + channel];
      };
      const int r = sum(0), g = sum(1), b = sum(2);
      *u++ = static_cast<std::uint8_t>(128 + ((kUr * r + kUg * g + kUb * b + 4 * kHalf) >> (kShift + 2)));
      *v++ = static_cast<std::uint8_t>(128 + ((kVr * r + kVg * g + kVb * b + 4 * kHalf) >> (kShift + 2)));
    }
  }
}

Result<void> Y4mWriter::append() {
  if (std::fputs("FRAME\n", file_.get()) < 0 ||
      std::fwrite(picture_.data(), 1, picture_.size(), file_.get()) != picture_.size() ||
      std::fflush(file_.get()) != 0) {
    return fail(ErrorCode::Io, "the capture file cannot be continued; is the disk full?", errno);
  }
  ++written_;
  return {};
}

}  // namespace relievo
