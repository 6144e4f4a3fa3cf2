// SPDX-License-Identifier: Apache-2.0
// Buffers that GL draws on and a card's screen shows: GBM's, as a surface of EGL.
#pragma once

#include <EGL/egl.h>
#include <gbm.h>

#include <cstdint>
#include <memory>

#include "platform/error.h"

namespace relievo::kms {

inline constexpr std::uint32_t kPixelFormat = GBM_FORMAT_XRGB8888;

// GL on a card. It is made once for a card, since EGL keeps what it knows of it; borrows the card.
class CardGl {
 public:
  [[nodiscard]] static Result<std::unique_ptr<CardGl>> start(int card);
  ~CardGl();
  CardGl(const CardGl&) = delete;
  CardGl& operator=(const CardGl&) = delete;

  [[nodiscard]] EGLDisplay display() const noexcept { return display_; }
  [[nodiscard]] gbm_device* device() const noexcept { return device_; }

 private:
  CardGl() = default;
  gbm_device* device_ = nullptr;
  EGLDisplay display_ = EGL_NO_DISPLAY;
};

// Some buffers that take turns: one is drawn on, one is on its way to the screen, one is on it. It borrows the GL.
class Buffers {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Buffers>> make(const CardGl& gl, EGLConfig config, int width, int height);
  // The screen shows none of them any more, and no context is current on the surface.
  ~Buffers();
  Buffers(const Buffers&) = delete;
  Buffers& operator=(const Buffers&) = delete;

  [[nodiscard]] EGLSurface surface() const noexcept { return surface_; }
  // What was drawn, as the card's framebuffer. The next frame is drawn on another. Lost with the GL context.
  [[nodiscard]] Result<std::uint32_t> swap();
  // The framebuffer of the last swap is on the screen: the one before it is free to be drawn on.
  void shown() noexcept;

 private:
  explicit Buffers(const CardGl& gl) noexcept : gl_(gl) {}
  Result<std::uint32_t> framebufferOf(gbm_bo* buffer);

  const CardGl& gl_;
  gbm_surface* surface_of_buffers_ = nullptr;
  EGLSurface surface_ = EGL_NO_SURFACE;
  gbm_bo* on_screen_ = nullptr;
  gbm_bo* next_ = nullptr;
};

}  // namespace relievo::kms
