// SPDX-License-Identifier: Apache-2.0
// Where a decoder's big pictures lie: on huge pages (platform/memory/huge_pages.h), in one block each, which the next
// picture reuses.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>

#include "drivers/ffmpeg/library.h"

namespace relievo::ffmpeg {

// FFmpeg's own pool clears each buffer before anyone can ask for huge pages under it, hence this one. It outlives the
// decoder that it serves; pictures may outlive it.
class PictureMemory {
 public:
  // Before the decoder is opened. Small pictures, and those of a codec or format that this cannot serve, come from
  // FFmpeg's pool as before.
  void serve(AVCodecContext& context) noexcept;

 private:
  struct PoolDeleter {
    void operator()(AVBufferPool* pool) const noexcept { av_buffer_pool_uninit(&pool); }
  };

  static int getBuffer(AVCodecContext* context, AVFrame* picture, int flags) noexcept;
  [[nodiscard]] AVBufferRef* block(std::size_t bytes) noexcept;

  std::mutex mutex_;  // each thread of the decoder asks for pictures
  std::unique_ptr<AVBufferPool, PoolDeleter> pool_;
  std::size_t bytes_ = 0;  // of a block
};

}  // namespace relievo::ffmpeg
