// SPDX-License-Identifier: Apache-2.0
// What the simulated decoder does between two requests: it decodes packets and fills buffers of pictures.
#include <cstring>

#include "tests/support/device/codec_library.h"
#include "tests/support/device/umockdev_codec.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace relievo::test {

void UmockdevCodec::work() {
  if (!library_ || !packets_run_ || (kind_.waits && !pictures_run_)) return;
  while (!hung_ && (deliver() || decodeOne())) {
    if (hangs_left_ == 0 || given_ < hang_after_) continue;
    --hangs_left_;
    hung_ = true;
  }
  if (!hung_) finishDrain();
}

// False without a picture or without a free buffer for it.
bool UmockdevCodec::deliver() {
  if (library_->pictures.empty()) return false;
  const AVFrame& picture = *library_->pictures.front();
  const Size size{static_cast<std::uint32_t>(picture.width), static_cast<std::uint32_t>(picture.height)};
  if (size != size_ && !changing_) announce(size);
  if (changing_) giveLast();
  if (changing_ || !pictures_run_ || empty_.empty() || last_given_) return false;
  const std::uint32_t index = empty_.front();
  empty_.pop_front();
  fill(index);
  const bool damaged = (picture.flags & AV_FRAME_FLAG_CORRUPT) != 0 || picture.decode_error_flags != 0;
  pictures_done_.push_back({index, kind_.planes ? lumaBytes() : lumaBytes() * 3 / 2,
                            damaged ? static_cast<std::uint32_t>(V4L2_BUF_FLAG_ERROR) : 0U,
                            static_cast<std::uint64_t>(picture.pts)});
  library_->pop();
  ++given_;
  ++pictures_;
  return true;
}

void UmockdevCodec::announce(const Size& size) {
  size_ = size;
  ++events_;
  changing_ = true;
}

// An empty last buffer, as with most drivers.
void UmockdevCodec::giveLast() {
  if (!pictures_run_ || last_given_ || empty_.empty()) return;
  last_given_ = true;
  pictures_done_.push_back({empty_.front(), 0, V4L2_BUF_FLAG_LAST, 0});
  empty_.pop_front();
}

// Only once the earlier pictures are out.
bool UmockdevCodec::decodeOne() {
  if (library_->pictures.size() > kind_.ahead || packets_.empty() || last_given_) return false;
  const Packet packet = packets_.front();
  packets_.pop_front();
  const bool good = library_->feed(memory_ + packet_offsets_[packet.index], packet.bytes, packet.tag);
  const AVCodecContext& known = *library_->context;
  if (known.width > 0 && size_ == kUntold) {
    announce({static_cast<std::uint32_t>(known.width), static_cast<std::uint32_t>(known.height)});
  }
  packets_done_.push_back({packet.index, 0, good ? 0U : static_cast<std::uint32_t>(V4L2_BUF_FLAG_ERROR), packet.tag});
  return true;
}

void UmockdevCodec::finishDrain() {
  if (!draining_ || changing_ || !packets_.empty() || !library_->pictures.empty()) return;
  if (!drained_) {
    drained_ = true;
    library_->drain();
    return work();
  }
  giveLast();
}

void UmockdevCodec::fill(std::uint32_t index) {
  const AVFrame& picture = *library_->pictures.front();
  std::uint8_t* const luma = memory_ + picture_offsets_[index];
  std::uint8_t* const chroma = luma + (kind_.planes ? wholePages(lumaBytes()) : lumaBytes());
  for (int r = 0; r < picture.height; ++r) {
    std::memcpy(luma + std::size_t{stride()} * static_cast<std::size_t>(r), picture.data[0] + r * picture.linesize[0],
                static_cast<std::size_t>(picture.width));
  }
  const bool apart = kind_.pictures == V4L2_PIX_FMT_YUV420;
  for (int i = 1; i <= 2; ++i) {
    for (int r = 0; r < (picture.height + 1) / 2; ++r) {
      const std::uint8_t* const from = picture.data[i] + r * picture.linesize[i];
      std::uint8_t* const to =
          apart ? chroma + (i - 1) * (lumaBytes() / 4) + std::size_t{stride() / 2} * static_cast<std::size_t>(r)
                : chroma + (i - 1) + std::size_t{stride()} * static_cast<std::size_t>(r);
      for (int c = 0; c < (picture.width + 1) / 2; ++c) to[apart ? c : 2 * c] = from[c];
    }
  }
}

}  // namespace relievo::test
