// SPDX-License-Identifier: Apache-2.0
// A plane of a dma-buf as a texture, without a copy, where the GL driver can do it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "app/render/gl/gl_objects.h"
#include "hal/frame.h"

namespace relievo {

// Whether the GL context that is current takes dma-bufs: EGL_EXT_image_dma_buf_import and GL_OES_EGL_image.
[[nodiscard]] bool takesDmaBufs() noexcept;

// A texture of one or two channels of 8 bits whose texels are those of `plane`, now and later: they are to stay as they
// are until they are drawn. With the modifier first, if one is told, and then without, as older drivers want it. None
// where the driver refuses, which leaves no GL error behind. On the thread of the GL context; left bound to the unit.
[[nodiscard]] std::optional<GlTexture> importDmaBuf(const DmaBuf& plane, std::ptrdiff_t stride_bytes, int width,
                                                    int height, int channels, std::optional<std::uint64_t> modifier);

}  // namespace relievo
