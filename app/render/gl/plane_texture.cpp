// SPDX-License-Identifier: Apache-2.0
// Uploads a plane, using GL's row length and alignment if they can describe its stride.
#include "app/render/gl/plane_texture.h"

#include <array>
#include <cstring>
#include <utility>

#include "app/render/gl/dma_import.h"

namespace relievo {
namespace {

constexpr std::array<GLenum, 4> kTexels{GL_R8, GL_RG8, GL_RGB8, GL_RGBA8};
constexpr std::array<GLenum, 4> kSamples{GL_RED, GL_RG, GL_RGB, GL_RGBA};

struct Unpacking {
  GLint row_length;  // texels
  GLint alignment;   // bytes
};

// In GL a row is `row_length` texels, rounded up to `alignment` bytes.
std::optional<Unpacking> unpackingOf(std::ptrdiff_t stride_bytes, int texel_bytes, int width) noexcept {
  const std::ptrdiff_t row_length = stride_bytes / texel_bytes;
  if (row_length < width) return std::nullopt;
  for (const int alignment : {1, 2, 4, 8}) {
    const std::ptrdiff_t row = (row_length * texel_bytes + alignment - 1) / alignment * alignment;
    if (row == stride_bytes) return Unpacking{static_cast<GLint>(row_length), alignment};
  }
  return std::nullopt;
}

}  // namespace

void PlaneTexture::bind(GLuint unit) const noexcept {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, texture_.get());
}

void PlaneTexture::allocate(std::uint8_t channels, int width, int height) {
  if (texture_.get() != 0 && !imported_ && channels == channels_ && width == width_ && height == height_) {
    glBindTexture(GL_TEXTURE_2D, texture_.get());
    return;
  }
  texture_ = gl::generate<GlTexture>(glGenTextures);
  channels_ = channels;
  width_ = width;
  height_ = height;
  imported_ = false;
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, kTexels[channels - 1U], width, height);
  configure();
}

void PlaneTexture::configure() const {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void PlaneTexture::send(const void* samples) const {
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, kSamples[channels_ - 1U], GL_UNSIGNED_BYTE, samples);
}

bool PlaneTexture::import(std::uint8_t channels, const DmaBuf& dma_buf, std::ptrdiff_t stride_bytes, int width,
                          int height, std::optional<std::uint64_t> modifier) {
  auto texture = importDmaBuf(dma_buf, stride_bytes, width, height, channels, modifier);
  if (!texture) return false;
  texture_ = std::move(*texture);
  channels_ = channels;
  imported_ = true;
  configure();
  return true;
}

void PlaneTexture::upload(std::uint8_t channels, const Plane& plane, int width, int height) {
  allocate(channels, width, height);
  if (const auto unpacking = unpackingOf(plane.stride_bytes, channels, width)) {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, unpacking->row_length);
    glPixelStorei(GL_UNPACK_ALIGNMENT, unpacking->alignment);
    send(plane.data);
    return;
  }
  const std::size_t row_bytes = static_cast<std::size_t>(width) * channels;
  staging_.resize(row_bytes * height);
  for (int r = 0; r < height; ++r) {
    std::memcpy(staging_.data() + r * row_bytes, plane.data + r * plane.stride_bytes, row_bytes);
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  send(staging_.data());
}

void PlaneTexture::uploadNarrowed(std::uint8_t channels, const Plane& plane, int width, int height, int shift) {
  allocate(channels, width, height);
  const std::size_t row_samples = static_cast<std::size_t>(width) * channels;
  staging_.resize(row_samples * height);
  for (int r = 0; r < height; ++r) {
    const std::uint8_t* in = plane.data + r * plane.stride_bytes;
    std::uint8_t* out = staging_.data() + r * row_samples;
    for (std::size_t i = 0; i < row_samples; ++i) {
      const unsigned word = in[2 * i] | static_cast<unsigned>(in[2 * i + 1]) << 8;
      out[i] = static_cast<std::uint8_t>(word >> shift);
    }
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  send(staging_.data());
}

}  // namespace relievo
