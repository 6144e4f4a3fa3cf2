// SPDX-License-Identifier: Apache-2.0
#include "drivers/floats/array_source.h"

#include <string_view>

#include "drivers/floats/floats.h"
#include "platform/print.h"

namespace relievo {
namespace {

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

// What to do with an array that is no picture, by its header (numpy's format).
const char* whyNoPicture(std::span<const std::uint8_t> begin) {
  const std::string_view header = npy::headerText(begin);
  if (header.find("'descr': '|O'") != header.npos)
    return "it holds objects of Python, such as a dictionary; if you trust the file, take its depth out: python3 -c "
           "'import numpy; d = numpy.load(\"FILE\", allow_pickle=True).item(); print(list(d)); "
           "numpy.save(\"depth.npy\", d[\"depth\"])', depth being one of the names that are printed";
  if (header.find(", 4)") != header.npos || header.find(", 4,)") != header.npos)
    return "it has four numbers a sample; if the fourth is the depth: numpy.save(\"depth.npy\", a[..., 3])";
  return "this array is no picture: give floats or whole numbers of rows x columns, or pictures x rows x columns, with "
         "at most 16.7 million samples and 300 MB a picture; rows x columns x pictures are put in order by "
         "numpy.moveaxis(a, -1, 0)";
}

}  // namespace

std::vector<std::uint8_t> ArraySource::beginning() {
  std::vector<std::uint8_t> begin(npy::kLongestHeader);
  begin.resize(readArray(0, begin));
  return begin;
}

Result<MediaSource::Description> ArraySource::describe(const std::string& url) {
  StreamInfo stream{.kind = StreamKind::Video, .codec = kNpy.codec, .counted = true, .frame_period = kPeriod};
  const auto found = findArray(url, stream.tags);
  const std::vector<std::uint8_t> begin = found ? beginning() : std::vector<std::uint8_t>();
  const auto header = found ? npy::parseHeader(begin) : std::nullopt;
  if (const auto failure = file_.failure()) return std::unexpected(*failure);
  if (!found) return std::unexpected(found.error());
  if (!header) return fail(ErrorCode::Unsupported, whyNoPicture(begin));
  if (header->fortran && header->pictures > 1) {
    return fail(ErrorCode::Unsupported,
                "a film in Fortran order cannot be read picture by picture; save numpy.ascontiguousarray(film)");
  }
  header_ = *header;
  stream.width = static_cast<int>(header_.cols);
  stream.height = static_cast<int>(header_.rows);
  stream.range = ColorRange::Full;
  return Description{.streams = {stream}};
}

Result<std::optional<Packet>> ArraySource::readPacket() {
  if (isInterrupted()) return fail(ErrorCode::Cancelled, "interrupted");
  if (next_ == header_.pictures) return std::nullopt;
  const std::string header = headerFor(header_);
  const auto bytes = static_cast<std::size_t>(header_.pictureBytes());
  auto data = std::make_shared<std::vector<std::uint8_t>>(header.begin(), header.end());
  data->resize(header.size() + bytes);
  const std::size_t got = readArray(header_.begin + next_ * bytes, std::span(*data).subspan(header.size()));
  if (const auto failure = file_.failure()) return std::unexpected(*failure);
  if (got < bytes) {
    cut_off_ = header_.pictures - next_;
    return std::nullopt;
  }
  ++next_;
  return packetOf(std::move(data));
}

void ArraySource::closeSource() noexcept {
  CountedSource::closeSource();
  cut_off_ = 0;
}

}  // namespace relievo
