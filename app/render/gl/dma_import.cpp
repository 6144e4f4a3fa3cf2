// SPDX-License-Identifier: Apache-2.0
// EGL_EXT_image_dma_buf_import and its modifiers extension, one plane at a time: every driver that imports dma-bufs
// supports R8 and GR88, but not every one supports YUV images.
#include "app/render/gl/dma_import.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES2/gl2.h>
#include <GLES2/gl2ext.h>
#include <unistd.h>

#include <array>
#include <string_view>

namespace relievo {
namespace {

constexpr EGLint fourcc(char a, char b, char c, char d) noexcept {
  return a | b << 8 | c << 16 | d << 24;
}
constexpr EGLint kOneChannel = fourcc('R', '8', ' ', ' '), kTwoChannels = fourcc('G', 'R', '8', '8');

struct Entries {
  PFNEGLCREATEIMAGEKHRPROC create = nullptr;
  PFNEGLDESTROYIMAGEKHRPROC destroy = nullptr;
  PFNGLEGLIMAGETARGETTEXTURE2DOESPROC to_texture = nullptr;
};

const Entries& entries() noexcept {
  static const Entries all{
      .create = reinterpret_cast<PFNEGLCREATEIMAGEKHRPROC>(eglGetProcAddress("eglCreateImageKHR")),
      .destroy = reinterpret_cast<PFNEGLDESTROYIMAGEKHRPROC>(eglGetProcAddress("eglDestroyImageKHR")),
      .to_texture =
          reinterpret_cast<PFNGLEGLIMAGETARGETTEXTURE2DOESPROC>(eglGetProcAddress("glEGLImageTargetTexture2DOES"))};
  return all;
}

bool has(const char* extensions, std::string_view name) noexcept {
  std::string_view rest = extensions == nullptr ? "" : extensions;
  while (!rest.empty()) {
    const auto end = rest.find(' ');
    if (rest.substr(0, end) == name) return true;
    rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
  }
  return false;
}

bool displayHas(std::string_view name) noexcept {
  const EGLDisplay display = eglGetCurrentDisplay();
  return display != EGL_NO_DISPLAY && has(eglQueryString(display, EGL_EXTENSIONS), name);
}

// Whether the buffer holds `bytes` from the plane's first on. Mesa 25's software driver takes one that does not, and
// crashes when it draws.
bool holds(const DmaBuf& plane, std::ptrdiff_t bytes) noexcept {
  return lseek(plane.fd, 0, SEEK_END) >= static_cast<off_t>(plane.offset_bytes) + bytes;
}

}  // namespace

bool takesDmaBufs() noexcept {
  const Entries& call = entries();
  return displayHas("EGL_EXT_image_dma_buf_import") &&
         has(reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS)), "GL_OES_EGL_image") && call.create != nullptr &&
         call.destroy != nullptr && call.to_texture != nullptr;
}

std::optional<GlTexture> importDmaBuf(const DmaBuf& plane, std::ptrdiff_t stride_bytes, int width, int height,
                                      int channels, std::optional<std::uint64_t> modifier) {
  const EGLDisplay display = eglGetCurrentDisplay();
  const Entries& call = entries();
  const auto create = [&](bool with_modifier) {
    std::array<EGLint, 17> words{EGL_WIDTH,
                                 width,
                                 EGL_HEIGHT,
                                 height,
                                 EGL_LINUX_DRM_FOURCC_EXT,
                                 channels == 1 ? kOneChannel : kTwoChannels,
                                 EGL_DMA_BUF_PLANE0_FD_EXT,
                                 plane.fd,
                                 EGL_DMA_BUF_PLANE0_OFFSET_EXT,
                                 static_cast<EGLint>(plane.offset_bytes),
                                 EGL_DMA_BUF_PLANE0_PITCH_EXT,
                                 static_cast<EGLint>(stride_bytes),
                                 EGL_NONE};
    if (with_modifier) {
      words[12] = EGL_DMA_BUF_PLANE0_MODIFIER_LO_EXT;
      words[13] = static_cast<EGLint>(*modifier & 0xffffffffU);
      words[14] = EGL_DMA_BUF_PLANE0_MODIFIER_HI_EXT;
      words[15] = static_cast<EGLint>(*modifier >> 32);
      words[16] = EGL_NONE;
    }
    return call.create(display, EGL_NO_CONTEXT, EGL_LINUX_DMA_BUF_EXT, nullptr, words.data());
  };
  if (stride_bytes <= 0 || channels < 1 || channels > 2) return std::nullopt;
  const bool linear = modifier.value_or(0) == 0;  // other layouts need a size of their own
  if (!holds(plane, linear ? stride_bytes * (height - 1) + width * channels : 1)) return std::nullopt;
  EGLImageKHR image = EGL_NO_IMAGE_KHR;
  if (modifier && displayHas("EGL_EXT_image_dma_buf_import_modifiers")) image = create(true);
  if (image == EGL_NO_IMAGE_KHR) image = create(false);
  if (image == EGL_NO_IMAGE_KHR) return std::nullopt;

  auto texture = gl::generate<GlTexture>(glGenTextures);
  glBindTexture(GL_TEXTURE_2D, texture.get());
  call.to_texture(GL_TEXTURE_2D, image);
  call.destroy(display, image);  // the texture keeps its own reference
  if (!glOutcome()) return std::nullopt;
  return texture;
}

}  // namespace relievo
