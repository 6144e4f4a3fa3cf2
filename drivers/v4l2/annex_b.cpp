// SPDX-License-Identifier: Apache-2.0
// Parses avcC and hvcC (ISO/IEC 14496-15, 5.3.3 and 8.3.3) and the beginning of sequence parameter sets.
#include "drivers/v4l2/annex_b.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace relievo::v4l2 {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 4> kStartCode{0, 0, 0, 1};
constexpr std::array<std::uint8_t, 3> kShortStartCode{0, 0, 1};
constexpr int kAvcSlice = 1, kAvcKeySlice = 5, kAvcSequenceSet = 7, kHevcSequenceSet = 33;  // types of units

// Reads bytes in order; beyond the end it returns 0 and sets `ok` to false.
struct Reader {
  Bytes rest;
  bool ok = true;

  unsigned number(std::size_t bytes) noexcept {
    unsigned value = 0;
    for (const std::uint8_t byte : take(bytes)) value = value << 8 | byte;
    return value;
  }
  Bytes take(std::size_t bytes) noexcept {
    ok = ok && bytes <= rest.size();
    if (!ok) return {};
    const Bytes taken = rest.first(bytes);
    rest = rest.subspan(bytes);
    return taken;
  }
};

// Reads bits of a unit, skipping its emulation prevention bytes.
class BitReader {
 public:
  explicit BitReader(Bytes unit) noexcept : unit_(unit) {}

  unsigned bits(int count) noexcept {
    unsigned value = 0;
    for (; count > 0; --count) value = value << 1 | bit();
    return value;
  }
  // Exp-Golomb (9.1).
  unsigned number() noexcept {
    int zeros = 0;
    while (zeros < 31 && at_ < unit_.size() && bit() == 0) ++zeros;
    return (1U << zeros) - 1 + bits(zeros);
  }

 private:
  unsigned bit() noexcept {
    if (at_ >= unit_.size()) return 0;
    const unsigned value = unit_[at_] >> (7 - bit_) & 1U;
    if (++bit_ == 8) nextByte();
    return value;
  }
  void nextByte() noexcept {
    bit_ = 0;
    zeros_ = unit_[at_] == 0 ? zeros_ + 1 : 0;
    ++at_;
    if (zeros_ < 2 || at_ >= unit_.size() || unit_[at_] != 3) return;
    ++at_;
    zeros_ = 0;
  }

  Bytes unit_;
  std::size_t at_ = 0;
  int bit_ = 0, zeros_ = 0;
};

CodingProfile avcProfile(Bytes set) noexcept {
  BitReader reader(set.subspan(1));
  CodingProfile found{.profile = static_cast<int>(reader.bits(8))};
  static_cast<void>(reader.bits(16));  // constraints, level
  static_cast<void>(reader.number());  // seq_parameter_set_id
  constexpr std::array kPlain{66, 77, 88};
  if (std::find(kPlain.begin(), kPlain.end(), found.profile) != kPlain.end()) {
    found.plain = true;
  } else {
    const unsigned chroma = reader.number(), luma_bits = reader.number(), chroma_bits = reader.number();
    found.plain = chroma == 1 && luma_bits == 0 && chroma_bits == 0;
  }
  return found;
}

CodingProfile hevcProfile(Bytes set) noexcept {
  constexpr int kMain = 1;
  BitReader reader(set.subspan(2));
  static_cast<void>(reader.bits(8 + 3));  // video set id, sub-layers; profile space and tier
  const auto profile = static_cast<int>(reader.bits(5));
  return {.profile = profile, .plain = profile == kMain};
}

}  // namespace

bool isAvcKey(Bytes units) noexcept {
  for (;;) {
    const auto code = std::search(units.begin(), units.end(), kShortStartCode.begin(), kShortStartCode.end());
    if (units.end() - code < 4) return false;
    const int type = code[3] & 0x1f;
    if (type == kAvcSequenceSet || type == kAvcKeySlice) return true;
    if (type == kAvcSlice) return false;
    units = {code + 3, units.end()};
  }
}

Result<AnnexB> AnnexB::make(const StreamInfo& stream) {
  AnnexB form;
  form.codec_ = stream.codec == "h264" ? Codec::H264 : stream.codec == "hevc" ? Codec::Hevc : Codec::Other;
  const Bytes extradata(stream.extradata);
  const bool described = form.codec_ != Codec::Other && extradata.size() > 3 && extradata[0] == 1;
  if (!described) {
    form.parameters_ = form.codec_ == Codec::Other ? std::vector<std::uint8_t>{} : stream.extradata;
    return form;
  }
  const bool read =
      form.codec_ == Codec::H264 ? form.readAvcDescription(extradata) : form.readHevcDescription(extradata);
  if (!read) return fail(ErrorCode::Corrupt, "the video stream's parameters are invalid; convert the film");
  return form;
}

bool AnnexB::readAvcDescription(Bytes extradata) {
  Reader reader{extradata};
  static_cast<void>(reader.take(4));
  length_bytes_ = (reader.number(1) & 3U) + 1;
  for (const unsigned mask : {0x1fU, 0xffU}) {  // sequence sets, then picture sets
    for (unsigned count = reader.number(1) & mask; reader.ok && count > 0; --count)
      addUnit(reader.take(reader.number(2)));
  }
  return reader.ok;
}

bool AnnexB::readHevcDescription(Bytes extradata) {
  Reader reader{extradata};
  static_cast<void>(reader.take(21));
  length_bytes_ = (reader.number(1) & 3U) + 1;
  for (unsigned kinds = reader.number(1); reader.ok && kinds > 0; --kinds) {
    static_cast<void>(reader.take(1));
    for (unsigned count = reader.number(2); reader.ok && count > 0; --count) addUnit(reader.take(reader.number(2)));
  }
  return reader.ok;
}

void AnnexB::addUnit(Bytes unit) {
  parameters_.insert(parameters_.end(), kStartCode.begin(), kStartCode.end());
  parameters_.insert(parameters_.end(), unit.begin(), unit.end());
}

// The first sequence parameter set, from its header on, and all after it. `units` have start codes.
Bytes AnnexB::sequenceSetIn(Bytes units) const noexcept {
  for (auto at = units.begin();; ++at) {
    at = std::search(at, units.end(), kShortStartCode.begin(), kShortStartCode.end());
    if (units.end() - at < 8) return {};
    const int type = codec_ == Codec::H264 ? at[3] & 0x1f : at[3] >> 1 & 0x3f;
    if (type == (codec_ == Codec::H264 ? kAvcSequenceSet : kHevcSequenceSet)) return {at + 3, units.end()};
  }
}

std::optional<CodingProfile> AnnexB::profile() const noexcept {
  if (codec_ == Codec::Other) return std::nullopt;
  const Bytes set = sequenceSetIn(parameters_);
  if (set.empty()) return std::nullopt;
  return codec_ == Codec::H264 ? avcProfile(set) : hevcProfile(set);
}

std::optional<std::size_t> AnnexB::write(const Packet& packet, bool with_parameters,
                                         std::span<std::uint8_t> room) const noexcept {
  std::size_t written = 0;
  const auto put = [&](Bytes bytes) {
    if (bytes.size() > room.size() - written) return false;
    std::memcpy(room.data() + written, bytes.data(), bytes.size());
    written += bytes.size();
    return true;
  };
  const bool apart = length_bytes_ > 0;
  Reader reader{{packet.data, packet.bytes}};
  const bool wanted = with_parameters && (apart || sequenceSetIn(reader.rest).empty());
  if ((wanted || (apart && packet.keyframe)) && !parameters_.empty() && !put(parameters_)) return std::nullopt;
  if (!apart) return put(reader.rest) ? std::optional(written) : std::nullopt;
  while (!reader.rest.empty()) {
    const Bytes unit = reader.take(reader.number(length_bytes_));
    if (!reader.ok || !put(kStartCode) || !put(unit)) return std::nullopt;
  }
  return written;
}

}  // namespace relievo::v4l2
