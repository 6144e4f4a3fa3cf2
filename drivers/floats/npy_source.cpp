// SPDX-License-Identifier: Apache-2.0
// Media source of a npy file: reads one picture of the array at a time.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <string>

#include "drivers/floats/floats.h"
#include "drivers/floats/npy_header.h"
#include "platform/print.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(40);  // as FFmpeg's of numbered pictures

// Reads until `bytes` are there or the file ends; the number read, or -1.
ssize_t readAt(int file, std::uint8_t* to, std::size_t bytes, std::uint64_t offset) noexcept {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got = ::pread(file, to + done, bytes - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return -1;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return static_cast<ssize_t>(done);
}

UniqueFd openFile(const std::string& path) noexcept {
  return UniqueFd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
}

std::vector<std::uint8_t> beginningOf(int file, std::size_t bytes) {
  std::vector<std::uint8_t> begin(bytes);
  begin.resize(static_cast<std::size_t>(std::max<ssize_t>(0, readAt(file, begin.data(), bytes, 0))));
  return begin;
}

// A npy file's bytes before its numbers, for one picture of a film.
std::string headerFor(const npy::Header& h) {
  const std::string text =
      print("{'descr': '%c%c%d', 'fortran_order': %s, 'shape': (%llu, %llu, %llu), }\n", h.type.swapped ? '>' : '<',
            h.type.kind, h.type.bytes, h.fortran ? "True" : "False", static_cast<unsigned long long>(h.rows),
            static_cast<unsigned long long>(h.cols), static_cast<unsigned long long>(h.components));
  std::string header = "\x93NUMPY\x01";
  header += '\0';
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

class NpySource final : public MediaSource {
 public:
  ~NpySource() override { close(); }

 private:
  Result<Description> openSource(const std::string& url) override {
    interrupted_ = false;
    file_ = openFile(url);
    if (!file_.valid()) return fail(ErrorCode::NotFound, "cannot be opened; check the path", errno);
    const auto header = npy::parseHeader(beginningOf(file_.get(), npy::kLongestHeader));
    if (!header) {
      return fail(ErrorCode::Unsupported,
                  "this array is no picture: give floats or whole numbers of rows x columns, or pictures x rows x "
                  "columns, with at most 16.7 million samples a picture");
    }
    if (header->fortran && header->pictures > 1) {
      return fail(ErrorCode::Unsupported,
                  "a film in Fortran order cannot be read picture by picture; save numpy.ascontiguousarray(film)");
    }
    header_ = *header;
    next_ = 0;
    StreamInfo stream{.kind = StreamKind::Video, .codec = kNpy.codec, .counted = true, .frame_period = kPeriod};
    stream.width = static_cast<int>(header_.cols);
    stream.height = static_cast<int>(header_.rows);
    stream.range = ColorRange::Full;
    return Description{.streams = {stream}};
  }

  Result<std::optional<Packet>> readPacket() override {
    if (interrupted_) return fail(ErrorCode::Cancelled, "interrupted");
    if (next_ == header_.pictures) return std::nullopt;
    const std::string header = headerFor(header_);
    const auto bytes = static_cast<std::size_t>(header_.pictureBytes());
    auto data = std::make_shared<std::vector<std::uint8_t>>(header.begin(), header.end());
    data->resize(header.size() + bytes);
    const ssize_t got = readAt(file_.get(), data->data() + header.size(), bytes, header_.begin + next_ * bytes);
    if (got < 0) return fail(ErrorCode::Io, "cannot be read; check the disk", errno);
    if (static_cast<std::size_t>(got) < bytes) {
      cut_off_ = header_.pictures - next_;
      return std::nullopt;
    }
    ++next_;
    return Packet{.data = data->data(), .bytes = data->size(), .keyframe = true, .owner = data};
  }

  // Pictures without times are counted from the beginning.
  Result<void> seekTo(MediaTime) override {
    next_ = 0;
    return {};
  }
  [[nodiscard]] Duration missingTime() const noexcept override { return static_cast<std::int64_t>(cut_off_) * kPeriod; }
  void closeSource() noexcept override {
    file_.reset();
    cut_off_ = 0;
  }
  void interrupted() noexcept override { interrupted_ = true; }

  std::atomic<bool> interrupted_ = false;
  UniqueFd file_;
  npy::Header header_;
  std::uint64_t next_ = 0;
  std::uint64_t cut_off_ = 0;  // pictures that the file's end has cut off
};

}  // namespace

bool isNpyFile(const std::string& path) {
  struct stat status{};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;  // opening a pipe disturbs it
  const UniqueFd file = openFile(path);
  return file.valid() && npy::isNpy(beginningOf(file.get(), 16));
}

std::unique_ptr<MediaSource> makeNpySource() {
  return std::make_unique<NpySource>();
}

}  // namespace relievo
