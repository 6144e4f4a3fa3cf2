// SPDX-License-Identifier: Apache-2.0
// A GLES 3 context on an EGL display, given back when it goes.
#pragma once

#include <EGL/egl.h>

#include <optional>

#include "platform/error.h"

namespace relievo {

// Owns one context. The EGL display is one per process however often it is asked for, and stays initialised like a
// library stays loaded: to terminate it would end the other contexts on it, and unload the GL driver, which Mesa's
// software one does not survive without leaks. Thread: the one that makes it current.
class EglContext {
 public:
  // Starts `display` and makes a context that can draw on pbuffers, or on windows of a native pixel format (one of
  // GBM's). Unsupported where there is no EGL or no GLES 3, Exhausted without memory.
  [[nodiscard]] static Result<EglContext> createForPbuffers(EGLDisplay display);
  [[nodiscard]] static Result<EglContext> createForWindows(EGLDisplay display, EGLint native_format);
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&&) = delete;
  ~EglContext();

  // Does nothing when it is current already. InvalidState when another thread holds it.
  [[nodiscard]] Result<void> makeCurrent(EGLSurface surface) noexcept;

  [[nodiscard]] EGLDisplay display() const noexcept { return display_; }
  [[nodiscard]] EGLConfig config() const noexcept { return config_; }

 private:
  explicit EglContext(EGLDisplay display) noexcept : display_(display) {}
  static Result<EglContext> create(EGLDisplay display, EGLint surface_type, std::optional<EGLint> native_format);

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLConfig config_ = nullptr;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace relievo
