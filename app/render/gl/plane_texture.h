// SPDX-License-Identifier: Apache-2.0
// A texture that holds one memory plane of a picture, sample for sample, whatever its stride.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/render/gl/gl_objects.h"
#include "hal/media/frame.h"

namespace relievo {

// A texel has 1 to 4 channels of 8 bits, which the shader reads as fractions of 255 with linear filtering.
class PlaneTexture {
 public:
  // Leaves the texture bound to the active unit. A stride that GL cannot express (negative, or neither a whole number
  // of texels nor one rounded up to 2, 4 or 8 bytes) costs one copy of the plane.
  void upload(std::uint8_t channels, const Plane& plane, int width, int height);
  // The same from the 16-bit words of `plane`, each reduced to (word >> shift) as a byte.
  void uploadNarrowed(std::uint8_t channels, const Plane& plane, int width, int height, int shift);

  // Without a copy: uses the texels of a dma-buf (importDmaBuf). On failure returns false and changes nothing.
  [[nodiscard]] bool import(std::uint8_t channels, const DmaBuf& dma_buf, std::ptrdiff_t stride_bytes, int width,
                            int height, std::optional<std::uint64_t> modifier);

  void bind(GLuint unit) const noexcept;

 private:
  void allocate(std::uint8_t channels, int width, int height);
  void configure() const;
  void send(const void* samples) const;

  GlTexture texture_;
  std::uint8_t channels_ = 1;
  int width_ = 0;
  int height_ = 0;
  bool imported_ = false;
  std::vector<std::uint8_t> staging_;
};

}  // namespace relievo
