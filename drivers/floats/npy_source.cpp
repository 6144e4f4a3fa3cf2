// SPDX-License-Identifier: Apache-2.0
// Media source of a npy file: reads one picture of the array at a time.
#include <span>
#include <string>

#include "drivers/floats/counted_source.h"
#include "drivers/floats/floats.h"
#include "drivers/floats/npy_header.h"
#include "platform/print.h"

namespace relievo {
namespace {

std::vector<std::uint8_t> beginningOf(const AnsweredFile& file, std::size_t bytes) {
  std::vector<std::uint8_t> begin(bytes);
  begin.resize(file.read(0, begin).value_or(0));
  return begin;
}

// The header of an npy file that holds one picture of the film.
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

class NpySource final : public CountedSource {
 public:
  ~NpySource() override { close(); }

 private:
  Result<Description> describe(const std::string&) override {
    const auto header = npy::parseHeader(beginningOf(file_, npy::kLongestHeader));
    if (const auto failure = file_.failure()) return std::unexpected(*failure);
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
    StreamInfo stream{.kind = StreamKind::Video, .codec = kNpy.codec, .counted = true, .frame_period = kPeriod};
    stream.width = static_cast<int>(header_.cols);
    stream.height = static_cast<int>(header_.rows);
    stream.range = ColorRange::Full;
    return Description{.streams = {stream}};
  }

  Result<std::optional<Packet>> readPacket() override {
    if (isInterrupted()) return fail(ErrorCode::Cancelled, "interrupted");
    if (next_ == header_.pictures) return std::nullopt;
    const std::string header = headerFor(header_);
    const auto bytes = static_cast<std::size_t>(header_.pictureBytes());
    auto data = std::make_shared<std::vector<std::uint8_t>>(header.begin(), header.end());
    data->resize(header.size() + bytes);
    const auto got = file_.read(header_.begin + next_ * bytes, std::span(*data).subspan(header.size()));
    if (const auto failure = file_.failure()) return std::unexpected(*failure);
    if (*got < bytes) {
      cut_off_ = header_.pictures - next_;
      return std::nullopt;
    }
    ++next_;
    return packetOf(std::move(data));
  }

  [[nodiscard]] Duration missingTime() const noexcept override { return static_cast<std::int64_t>(cut_off_) * kPeriod; }
  void closeSource() noexcept override {
    CountedSource::closeSource();
    cut_off_ = 0;
  }

  npy::Header header_;
  std::uint64_t cut_off_ = 0;  // pictures that the file's end has cut off
};

}  // namespace

bool isNpyFile(const std::string& path) {
  const auto file = AnsweredFile::open(path);
  return file && npy::isNpy(beginningOf(*file, 16));
}

std::unique_ptr<MediaSource> makeNpySource() {
  return std::make_unique<NpySource>();
}

}  // namespace relievo
