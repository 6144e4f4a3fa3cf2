// SPDX-License-Identifier: Apache-2.0
// Uploading a plane, by GL's own strides where they can say it.
#include "app/render/gl/plane_texture.h"

#include <array>
#include <cstring>
#include <utility>

#include "app/render/gl/dma_import.h"

namespace relievo {
namespace {

struct GlFormat {
  GLenum internal;
  GLenum format;
  GLenum type;
};

GlFormat glFormat(const TexelLayout& layout) noexcept {
  static constexpr std::array<GLenum, 4> kFractions{GL_R8, GL_RG8, GL_RGB8, GL_RGBA8};
  static constexpr std::array<GLenum, 4> kBytes{GL_R8UI, GL_RG8UI, GL_RGB8UI, GL_RGBA8UI};
  static constexpr std::array<GLenum, 4> kWords{GL_R16UI, GL_RG16UI, GL_RGB16UI, GL_RGBA16UI};
  static constexpr std::array<GLenum, 4> kFormat{GL_RED, GL_RG, GL_RGB, GL_RGBA};
  static constexpr std::array<GLenum, 4> kWholeFormat{GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER, GL_RGBA_INTEGER};
  const std::size_t i = layout.channels - 1u;
  if (!layout.whole) return {kFractions[i], kFormat[i], GL_UNSIGNED_BYTE};
  if (layout.bytes == 1) return {kBytes[i], kWholeFormat[i], GL_UNSIGNED_BYTE};
  return {kWords[i], kWholeFormat[i], GL_UNSIGNED_SHORT};
}

struct Unpacking {
  GLint row_length;  // texels
  GLint alignment;   // bytes
};

// GL's row is `row_length` texels, rounded up to `alignment` bytes.
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

void PlaneTexture::allocate(const TexelLayout& layout, int width, int height) {
  if (texture_.get() != 0 && !imported_ && layout == layout_ && width == width_ && height == height_) {
    glBindTexture(GL_TEXTURE_2D, texture_.get());
    return;
  }
  texture_ = gl::generate<GlTexture>(glGenTextures);
  layout_ = layout;
  width_ = width;
  height_ = height;
  imported_ = false;
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, glFormat(layout).internal, width, height);
  configure();
}

void PlaneTexture::configure() const {
  const GLint filter = layout_.whole ? GL_NEAREST : GL_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void PlaneTexture::send(const void* samples) const {
  const GlFormat format = glFormat(layout_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, format.format, format.type, samples);
}

bool PlaneTexture::import(const TexelLayout& layout, const DmaBuf& dma_buf, std::ptrdiff_t stride_bytes, int width,
                          int height, std::optional<std::uint64_t> modifier) {
  auto texture = importDmaBuf(dma_buf, stride_bytes, width, height, layout.channels, modifier);
  if (!texture) return false;
  texture_ = std::move(*texture);
  layout_ = layout;
  imported_ = true;
  configure();
  return true;
}

void PlaneTexture::upload(const TexelLayout& layout, const Plane& plane, int width, int height) {
  allocate(layout, width, height);
  if (const auto unpacking = unpackingOf(plane.stride_bytes, layout.texelBytes(), width)) {
    glPixelStorei(GL_UNPACK_ROW_LENGTH, unpacking->row_length);
    glPixelStorei(GL_UNPACK_ALIGNMENT, unpacking->alignment);
    send(plane.data);
    return;
  }
  const std::size_t row_bytes = static_cast<std::size_t>(width) * layout.texelBytes();
  staging_.resize(row_bytes * height);
  for (int r = 0; r < height; ++r) {
    std::memcpy(staging_.data() + r * row_bytes, plane.data + r * plane.stride_bytes, row_bytes);
  }
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  send(staging_.data());
}

void PlaneTexture::uploadNarrowed(std::uint8_t channels, const Plane& plane, int width, int height, int shift) {
  allocate({.channels = channels}, width, height);
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
