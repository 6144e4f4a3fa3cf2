// SPDX-License-Identifier: Apache-2.0
// Lays out a picture as avcodec_default_get_buffer2 does, but with all planes in one block.
#include "drivers/ffmpeg/pictures/picture_memory.h"

extern "C" {
#include <libavutil/imgutils.h>
#include <libavutil/mem.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "platform/memory/huge_pages.h"

namespace relievo::ffmpeg {
namespace {

constexpr std::size_t kAlignment = 64;                    // of a plane, for the widest vectors
constexpr std::size_t kReadBehind = 16 + kAlignment - 1;  // that a codec may read behind a plane

struct Layout {
  std::array<int, 4> strides{};
  std::array<std::size_t, 4> offsets{};
  std::size_t bytes = 0;  // with room to align the first plane
};

std::size_t aligned(std::size_t n) noexcept {
  return (n + kAlignment - 1) / kAlignment * kAlignment;
}

bool isServed(const AVCodecContext& context, const AVFrame& picture) noexcept {
  if (context.codec_type != AVMEDIA_TYPE_VIDEO || (context.codec->capabilities & AV_CODEC_CAP_DR1) == 0) return false;
  const AVPixFmtDescriptor* const format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(picture.format));
  return format != nullptr && (format->flags & (AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_PAL)) == 0;
}

std::optional<Layout> layoutOf(AVCodecContext& context, const AVFrame& picture) noexcept {
  const auto format = static_cast<AVPixelFormat>(picture.format);
  int width = picture.width, height = picture.height;
  std::array<int, AV_NUM_DATA_POINTERS> alignments{};
  avcodec_align_dimensions2(&context, &width, &height, alignments.data());
  Layout layout;
  for (bool unaligned = true; unaligned;) {
    if (av_image_fill_linesizes(layout.strides.data(), format, width) < 0) return std::nullopt;
    width += width & ~(width - 1);  // the strides' ratio stays
    unaligned = false;
    for (std::size_t i = 0; i < 4; ++i) unaligned = unaligned || layout.strides[i] % alignments[i] != 0;
  }
  std::array<std::ptrdiff_t, 4> strides{};
  std::array<std::size_t, 4> sizes{};
  std::copy(layout.strides.begin(), layout.strides.end(), strides.begin());
  if (av_image_fill_plane_sizes(sizes.data(), format, height, strides.data()) < 0) return std::nullopt;
  for (std::size_t i = 0; i < 4 && sizes[i] > 0; ++i) {
    layout.offsets[i] = layout.bytes;
    layout.bytes += aligned(sizes[i] + kReadBehind);
  }
  layout.bytes += kAlignment;
  return layout;
}

// Zeroed, as FFmpeg zeroes its own buffers.
AVBufferRef* newBlock(std::size_t bytes) noexcept {
  auto* const begin = static_cast<std::uint8_t*>(av_malloc(bytes));
  if (begin == nullptr) return nullptr;
  askForHugePages(begin, bytes);
  std::memset(begin, 0, bytes);
  AVBufferRef* const block = av_buffer_create(begin, bytes, av_buffer_default_free, nullptr, 0);
  if (block == nullptr) av_free(begin);
  return block;
}

}  // namespace

void PictureMemory::serve(AVCodecContext& context) noexcept {
  context.opaque = this;
  context.get_buffer2 = getBuffer;
#if LIBAVCODEC_VERSION_MAJOR < 60  // newer versions assume it
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
  context.thread_safe_callbacks = 1;
#pragma GCC diagnostic pop
#endif
}

int PictureMemory::getBuffer(AVCodecContext* context, AVFrame* picture, int flags) noexcept {
  const auto layout = isServed(*context, *picture) ? layoutOf(*context, *picture) : std::nullopt;
  if (!layout || layout->bytes < kHugePagesFrom) return avcodec_default_get_buffer2(context, picture, flags);
  AVBufferRef* const block = static_cast<PictureMemory*>(context->opaque)->block(layout->bytes);
  if (block == nullptr) return AVERROR(ENOMEM);
  picture->buf[0] = block;
  std::uint8_t* const first = block->data + (kAlignment - reinterpret_cast<std::uintptr_t>(block->data) % kAlignment);
  for (std::size_t i = 0; i < 4 && layout->strides[i] != 0; ++i) {
    picture->data[i] = first + layout->offsets[i];
    picture->linesize[i] = layout->strides[i];
  }
  picture->extended_data = picture->data;
  return 0;
}

AVBufferRef* PictureMemory::block(std::size_t bytes) noexcept {
  const std::scoped_lock lock(mutex_);
  if (!pool_ || bytes_ != bytes) {
    pool_.reset(av_buffer_pool_init(bytes, newBlock));  // the old pool's buffers are freed with their pictures
    bytes_ = bytes;
  }
  return pool_ ? av_buffer_pool_get(pool_.get()) : nullptr;
}

}  // namespace relievo::ffmpeg
