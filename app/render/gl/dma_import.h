// SPDX-License-Identifier: Apache-2.0
// Uses a plane of a dma-buf as a texture, without a copy, if the GL driver can.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "app/render/gl/gl_objects.h"
#include "hal/media/frame.h"

namespace relievo {

// Whether the current GL context accepts dma-bufs: EGL_EXT_image_dma_buf_import and GL_OES_EGL_image.
[[nodiscard]] bool takesDmaBufs() noexcept;

// A texture of one or two 8-bit channels that shares the memory of `plane`: the memory must not change until it is
// drawn. Tries the modifier first, if there is one, then none, as older drivers need. Nullopt if the driver refuses; no
// GL error is left behind. Call on the thread of the GL context; leaves the texture bound to the unit.
[[nodiscard]] std::optional<GlTexture> importDmaBuf(const DmaBuf& plane, std::ptrdiff_t stride_bytes, int width,
                                                    int height, int channels, std::optional<std::uint64_t> modifier);

}  // namespace relievo
