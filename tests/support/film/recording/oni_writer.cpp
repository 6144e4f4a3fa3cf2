// SPDX-License-Identifier: Apache-2.0
#include "tests/support/film/recording/oni_writer.h"

#include <algorithm>
#include <cstdlib>
#include <set>

namespace relievo::test {
namespace {

constexpr std::uint32_t kInt = 3, kGeneral = 6, kReady = 9, kBegin = 8, kPicture = 10, kEnd = 11, kAddedOld = 12,
                        kAdded = 13, kTable = 14;
constexpr std::uint32_t kUnknown32 = ~std::uint32_t{0};
constexpr std::uint64_t kUnknown64 = ~std::uint64_t{0};

std::string zeroEnded(std::string_view text) {
  return std::string(text) + '\0';
}

// OpenNI's half bytes, two in a byte. Pairs without a step are only counted; `behind` is added after the byte that a
// half completes.
class HalfBytes {
 public:
  void half(unsigned value, std::string_view behind = {}) {
    if (!pending_ && value != 0xf) {
      first_ = value, pending_ = true;
      return;
    }
    const unsigned byte = (pending_ ? first_ << 4 : 0xf0U) | value;
    pending_ = false;
    if (byte == 0x66) {
      if (++still_ == 15) flush();
      return;
    }
    flush();
    bytes_ += static_cast<char>(byte);
    bytes_ += behind;
  }
  [[nodiscard]] std::string finish() {
    flush();
    if (pending_) bytes_ += static_cast<char>(first_ << 4 | 0xd);
    return bytes_;
  }

 private:
  void flush() {
    if (still_ > 0) bytes_ += static_cast<char>(0xe0 | still_);
    still_ = 0;
  }
  std::string bytes_;
  unsigned first_ = 0, still_ = 0;
  bool pending_ = false;
};

}  // namespace

std::string oni16z(std::span<const std::uint16_t> samples) {
  HalfBytes halves;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const int fall = samples[i - 1] - samples[i];
    if (std::abs(fall) <= 6) {
      halves.half(static_cast<unsigned>(fall + 6));
    } else if (std::abs(fall) <= 63) {
      halves.half(0xf, std::string(1, static_cast<char>(fall + 192)));
    } else {
      halves.half(0xf, std::string{static_cast<char>(samples[i] >> 8), static_cast<char>(samples[i])});
    }
  }
  return ByteWriter().add(samples[0]).raw(halves.finish()).bytes();
}

std::string oni16zTable(std::span<const std::uint16_t> samples) {
  const std::set<std::uint16_t> sorted(samples.begin(), samples.end());
  const std::vector<std::uint16_t> values(sorted.begin(), sorted.end());
  std::vector<std::uint16_t> places;
  for (const std::uint16_t sample : samples) {
    places.push_back(static_cast<std::uint16_t>(std::ranges::lower_bound(values, sample) - values.begin()));
  }
  ByteWriter packed;
  packed.add(static_cast<std::uint16_t>(values.size()));
  for (const std::uint16_t value : values) packed.add(value);
  return packed.raw(oni16z(places)).bytes();
}

OniWriter::OniWriter(bool wide) : wide_(wide) {
  ByteWriter header;
  header.raw("NI10").add(std::uint8_t{1}).add(std::uint8_t{0});
  header.add(static_cast<std::uint16_t>(wide ? 1 : 0)).add(wide ? 0U : 5U);
  file_ = header.add(std::uint64_t{1} << 40).add(std::uint32_t{8}).bytes();  // latest time, highest node
}

void OniWriter::record(std::uint32_t op, std::uint32_t node, std::string_view fields, std::string_view data) {
  const std::uint32_t header = wide_ ? 28 : 24;
  ByteWriter bytes;
  bytes.raw(std::string_view("NIR\0", 4)).add(op).add(node);
  bytes.add(static_cast<std::uint32_t>(header + fields.size())).add(static_cast<std::uint32_t>(data.size()));
  wide_ ? bytes.add(std::uint64_t{0}) : bytes.add(std::uint32_t{0});  // where the record before it is, for OpenNI
  file_ += bytes.raw(fields).raw(data).bytes();
}

void OniWriter::property(std::uint32_t op, std::uint32_t node, std::string_view name, std::string_view value) {
  record(op, node, ByteWriter().text(zeroEnded(name)).text(value).bytes());
}

std::uint32_t OniWriter::add(const OniNode& node) {
  const auto id = static_cast<std::uint32_t>(nodes_.size() + 1);
  ByteWriter fields;
  fields.text(zeroEnded("Node" + std::to_string(id))).add(node.kind).raw(node.codec);
  const std::size_t counts = fields.bytes().size();
  fields.add(kUnknown32).add(std::uint64_t{0}).add(kUnknown64);
  if (wide_) fields.add(std::uint64_t{0});
  nodes_.push_back({.counts = file_.size() + (wide_ ? 28 : 24) + counts, .times = {}, .places = {}});
  record(wide_ ? kAdded : kAddedOld, id, fields.bytes());
  const auto number = [&](std::string_view name, std::uint64_t value) {
    property(kInt, id, name, ByteWriter().add(value).bytes());
  };
  number("xnIsGenerating", 1);
  property(kGeneral, id, "xnMapOutputMode", ByteWriter().add(node.cols).add(node.rows).add(30U).bytes());
  if (node.kind == kOniDepth) number("xnDeviceMaxDepth", 10000);
  if (node.old_format != 0) number("xnPixelFormat", node.old_format);
  if (node.format != 0) number("oniPixelFormat", node.format);
  if (node.format != 0) number("oniRequiredFrameSize", std::uint64_t{node.cols} * node.rows * 3);
  ByteWriter cropping;
  cropping.add(node.cropped ? 1U : 0U);
  for (int i = 0; i < 4; ++i) cropping.add(std::uint16_t{4});
  property(kGeneral, id, "xnCropping", cropping.bytes());
  record(kReady, id, {});
  return id;
}

void OniWriter::write(std::uint32_t node, std::uint64_t time_us, std::string_view picture) {
  for (std::uint32_t id = 1; !started_ && id <= nodes_.size(); ++id) {
    record(kBegin, id, ByteWriter().add(kUnknown32).add(kUnknown64).bytes());
  }
  started_ = true;
  Added& added = nodes_[node - 1];
  added.times.push_back(time_us);
  added.places.push_back(file_.size());
  const auto number = static_cast<std::uint32_t>(added.times.size());
  record(kPicture, node, ByteWriter().add(time_us).add(number).bytes(), picture);
}

std::string OniWriter::finish(bool tables) {
  if (!tables) return file_;
  for (std::uint32_t id = 1; wide_ && id <= nodes_.size(); ++id) {
    const Added& added = nodes_[id - 1];
    ByteWriter counts, table;
    counts.add(static_cast<std::uint32_t>(added.times.size())).add(std::uint64_t{0});
    counts.add(added.times.empty() ? 0 : added.times.back()).add(static_cast<std::uint64_t>(file_.size()));
    file_.replace(added.counts, counts.bytes().size(), counts.bytes());
    table.add(std::uint64_t{0}).add(0U).add(std::uint64_t{0});
    for (std::size_t i = 0; i < added.times.size(); ++i) table.add(added.times[i]).add(0U).add(added.places[i]);
    record(kTable, id, {}, table.bytes());
  }
  record(kEnd, 0, {});
  return file_;
}

}  // namespace relievo::test
