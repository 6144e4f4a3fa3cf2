// SPDX-License-Identifier: Apache-2.0
// Initialises an EGL display, and creates and destroys a context on it.
#include "drivers/egl/egl_context.h"

#include <array>
#include <span>
#include <utility>

namespace relievo {
namespace {

// With a native format the surface is a window's: the config needs a depth buffer, may lack alpha, and must have that
// format, since EGL sorts configs by their sizes, not by their format.
EGLConfig chooseConfig(EGLDisplay display, EGLint surface_type, std::optional<EGLint> native_format) {
  constexpr EGLint kMostConfigs = 256;
  const std::array<EGLint, 15> wanted{EGL_SURFACE_TYPE,
                                      surface_type,
                                      EGL_RENDERABLE_TYPE,
                                      EGL_OPENGL_ES3_BIT,
                                      EGL_RED_SIZE,
                                      8,
                                      EGL_GREEN_SIZE,
                                      8,
                                      EGL_BLUE_SIZE,
                                      8,
                                      EGL_ALPHA_SIZE,
                                      native_format ? 0 : 8,
                                      EGL_DEPTH_SIZE,
                                      native_format ? 24 : 0,
                                      EGL_NONE};
  std::array<EGLConfig, kMostConfigs> configs{};
  EGLint found = 0;
  if (eglChooseConfig(display, wanted.data(), configs.data(), kMostConfigs, &found) != EGL_TRUE) return nullptr;
  for (const EGLConfig config : std::span(configs).first(static_cast<std::size_t>(found))) {
    EGLint format = 0;
    if (!native_format) return config;
    if (eglGetConfigAttrib(display, config, EGL_NATIVE_VISUAL_ID, &format) == EGL_TRUE && format == *native_format) {
      return config;
    }
  }
  return nullptr;
}

}  // namespace

EglContext::EglContext(EglContext&& other) noexcept
    : display_(std::exchange(other.display_, EGL_NO_DISPLAY)),
      config_(other.config_),
      context_(std::exchange(other.context_, EGL_NO_CONTEXT)) {}

EglContext::~EglContext() {
  if (context_ == EGL_NO_CONTEXT) return;
  if (eglGetCurrentContext() == context_) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display_, context_);
}

Result<EglContext> EglContext::createForPbuffers(EGLDisplay display) {
  return create(display, EGL_PBUFFER_BIT, std::nullopt);
}

Result<EglContext> EglContext::createForWindows(EGLDisplay display, EGLint native_format) {
  return create(display, EGL_WINDOW_BIT, native_format);
}

Result<EglContext> EglContext::create(EGLDisplay display, EGLint surface_type, std::optional<EGLint> native_format) {
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    return fail(ErrorCode::Unsupported,
                "EGL cannot be started; install a GL driver (Debian: libegl1, libgl1-mesa-dri)");
  }
  EglContext made(display);
  if (eglBindAPI(EGL_OPENGL_ES_API) == EGL_TRUE) made.config_ = chooseConfig(display, surface_type, native_format);
  if (made.config_ == nullptr) {
    return fail(ErrorCode::Unsupported, "the GL driver has no GLES 3 with 8-bit colour; install a newer one");
  }
  constexpr std::array<EGLint, 3> kVersion3{EGL_CONTEXT_CLIENT_VERSION, 3, EGL_NONE};
  made.context_ = eglCreateContext(display, made.config_, EGL_NO_CONTEXT, kVersion3.data());
  if (made.context_ != EGL_NO_CONTEXT) return made;
  if (eglGetError() == EGL_BAD_ALLOC)
    return fail(ErrorCode::Exhausted, "no memory for a GL context; close other programs");
  return fail(ErrorCode::Unsupported, "the GL driver cannot make a GLES 3 context; install a newer one");
}

Result<void> EglContext::makeCurrent(EGLSurface surface) noexcept {
  if (eglGetCurrentContext() == context_ && eglGetCurrentSurface(EGL_DRAW) == surface) return {};
  if (eglMakeCurrent(display_, surface, surface, context_) == EGL_TRUE) return {};
  switch (eglGetError()) {
    case EGL_BAD_ACCESS:
      return fail(ErrorCode::InvalidState, "the GL context is current on another thread; use the one that opened it");
    case EGL_BAD_ALLOC:
      return fail(ErrorCode::Exhausted, "no memory to make the GL context current; close other programs");
    case EGL_CONTEXT_LOST:
      return fail(ErrorCode::Lost, "the GL context is lost; close the display and open it again");
    default:
      return fail(ErrorCode::Io, "the GL context cannot be made current; start relievo again");
  }
}

}  // namespace relievo
