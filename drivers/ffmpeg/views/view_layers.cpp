// SPDX-License-Identifier: Apache-2.0
// Reads the video parameter set as far as its extension (ITU-T H.265, 7.3.2.1, 7.3.3, F.7.3.2.1.1), and which layers a
// packet's units belong to.
#include "drivers/ffmpeg/views/view_layers.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "drivers/ffmpeg/stream_tags.h"

namespace relievo::ffmpeg {
namespace {

constexpr int kVideoParameters = 32;  // a unit's type; slices are below it

int typeOf(Bytes unit) noexcept {
  return unit[0] >> 1 & 0x3f;
}
int layerOf(Bytes unit) noexcept {
  return (unit[0] & 1) << 5 | unit[1] >> 3;
}

// Bits of a unit; zeros beyond its end.
class Bits {
 public:
  explicit Bits(Bytes data) noexcept : data_(data) {}
  unsigned take(int count) noexcept {
    unsigned value = 0;
    for (; count > 0; --count, ++at_) {
      const bool one = at_ / 8 < data_.size() && (data_[at_ / 8] >> (7 - at_ % 8) & 1) != 0;
      value = value << 1 | (one ? 1U : 0U);
    }
    return value;
  }
  void skip(std::size_t count) noexcept { at_ += count; }
  void align() noexcept { at_ = (at_ + 7) / 8 * 8; }
  // Exp-Golomb (9.2).
  unsigned number() noexcept {
    int zeros = 0;
    while (zeros < 31 && at_ / 8 < data_.size() && take(1) == 0) ++zeros;
    return (1U << zeros) - 1 + take(zeros);
  }

 private:
  Bytes data_;
  std::size_t at_ = 0;
};

// profile_tier_level.
void skipProfile(Bits& in, bool with_profile, unsigned sub_layers) noexcept {
  constexpr std::size_t kProfile = 88, kLevel = 8;
  in.skip((with_profile ? kProfile : 0) + kLevel);
  if (sub_layers == 0) return;
  std::size_t more = 0;
  for (unsigned i = 0; i < sub_layers; ++i) {
    if (in.take(1) != 0) more += kProfile;
    if (in.take(1) != 0) more += kLevel;
  }
  in.skip(std::size_t{2} * (8 - sub_layers) + more);
}

bool announcesViews(Bytes unit) {
  const std::vector<std::uint8_t> plain = withoutPrevention(unit.subspan(2));
  Bits in(plain);
  in.skip(4);  // its number
  const bool base_inside = in.take(1) != 0;
  in.skip(1);
  const unsigned layers = in.take(6), sub_layers = in.take(3);
  in.skip(1 + 16);
  skipProfile(in, true, sub_layers);
  for (unsigned i = in.take(1) != 0 ? 0 : sub_layers; i <= sub_layers; ++i) {
    for (int k = 0; k < 3; ++k) in.number();
  }
  const std::size_t last_layer = in.take(6), sets = in.number();
  in.skip(sets * (last_layer + 1));
  if (in.take(1) != 0) {  // timing
    in.skip(64);
    if (in.take(1) != 0) in.number();
    if (in.number() != 0) return false;  // buffering models
  }
  const bool extended = in.take(1) != 0;
  if (!extended || layers == 0 || !base_inside) return false;
  in.align();
  skipProfile(in, false, sub_layers);
  in.skip(2);              // splitting_flag; the first kind of scalability
  return in.take(1) != 0;  // the second: by views
}

// The parameter sets of hvcC (ISO/IEC 14496-15, 8.3.3.1), or units with start codes.
void eachParameterSet(Bytes extradata, const std::function<void(Bytes)>& visit) {
  constexpr std::size_t kArrays = 23;
  if (extradata.size() < kArrays || extradata[0] != 1) return eachUnitByStartCode(extradata, visit);
  const auto number = [&](std::size_t at) { return std::size_t{extradata[at]} << 8 | extradata[at + 1]; };
  std::size_t at = kArrays;
  for (int array = extradata[kArrays - 1]; array > 0 && at + 3 <= extradata.size(); --array) {
    std::size_t count = number(at + 1);
    for (at += 3; count > 0 && at + 2 <= extradata.size(); --count) {
      const std::size_t bytes = std::min(number(at), extradata.size() - at - 2);
      visit(extradata.subspan(at + 2, bytes));
      at += 2 + bytes;
    }
  }
}

}  // namespace

int viewLayers(const AVPacket& packet, const AVCodecParameters& parameters) {
  if (parameters.codec_id != AV_CODEC_ID_HEVC) return 0;
  bool announced = false, second = false;
  const auto look = [&](Bytes unit) {
    if (unit.size() <= 2) return;
    if (typeOf(unit) == kVideoParameters) announced = announced || announcesViews(unit);
    else second = second || (typeOf(unit) < kVideoParameters && layerOf(unit) > 0);
  };
  eachParameterSet({parameters.extradata, static_cast<std::size_t>(std::max(parameters.extradata_size, 0))}, look);
  eachUnit(packet, parameters, look);
  if (!announced) return 0;
  return second ? 2 : 1;
}

}  // namespace relievo::ffmpeg
