// SPDX-License-Identifier: Apache-2.0
// A GLES 3 context on an EGL display, destroyed with its owner.
#pragma once

#include <EGL/egl.h>

#include <optional>

#include "platform/error.h"

namespace relievo {

// Owns one context. The EGL display is shared by the process and never terminated: that would end the other contexts on
// it and unload the GL driver, and Mesa's software driver leaks when it is unloaded. Thread: the one that makes it
// current.
class EglContext {
 public:
  // Initialises `display` and creates a context that can draw on pbuffers, or on windows of a native pixel format (one
  // of GBM's). Unsupported without EGL or GLES 3, Exhausted if out of memory.
  [[nodiscard]] static Result<EglContext> createForPbuffers(EGLDisplay display);
  [[nodiscard]] static Result<EglContext> createForWindows(EGLDisplay display, EGLint native_format);
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&&) = delete;
  ~EglContext();

  // Does nothing if it is current already. InvalidState if it is current on another thread.
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
