// SPDX-License-Identifier: Apache-2.0
// GBM buffers that GL draws on, through an EGL surface, and that a card's screen shows.
#pragma once

#include <EGL/egl.h>
#include <gbm.h>

#include <cstdint>
#include <memory>

#include "platform/error.h"

namespace relievo::kms {

inline constexpr std::uint32_t kPixelFormat = GBM_FORMAT_XRGB8888;

// GL on a card. Make it once for each card, since EGL keeps state for it. The card's descriptor must outlive it.
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

// Buffers used in turn: one is drawn on, one is queued for the screen, one is on the screen. The CardGl must outlive
// it.
class Buffers {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Buffers>> make(const CardGl& gl, EGLConfig config, int width, int height);
  // Before this, the screen must show none of the buffers, and no context may be current on the surface.
  ~Buffers();
  Buffers(const Buffers&) = delete;
  Buffers& operator=(const Buffers&) = delete;

  [[nodiscard]] EGLSurface surface() const noexcept { return surface_; }
  // Returns what was drawn as a framebuffer of the card; the next frame is drawn on another buffer. Lost if the GL
  // context is lost.
  [[nodiscard]] Result<std::uint32_t> swap();
  // Call when the framebuffer of the last swap is on the screen: the previous one can then be drawn on again.
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
