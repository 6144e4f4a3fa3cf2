// SPDX-License-Identifier: Apache-2.0
// Exchanges buffers of a GBM surface, and registers each as a framebuffer of the card once.
#include "drivers/egl/kms/kms_buffers.h"

#include <EGL/eglext.h>
#include <drm_fourcc.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <array>
#include <cerrno>
#include <utility>

namespace relievo::kms {
namespace {

// Attached to a GBM buffer and removed together with it.
struct Framebuffer {
  int card = -1;
  std::uint32_t id = 0;
};
void removeFramebuffer(gbm_bo* /*buffer*/, void* data) {
  const std::unique_ptr<Framebuffer> framebuffer(static_cast<Framebuffer*>(data));
  drmModeRmFB(framebuffer->card, framebuffer->id);
}

}  // namespace

Result<std::unique_ptr<CardGl>> CardGl::start(int card) {
  std::unique_ptr<CardGl> gl(new CardGl);
  gl->device_ = gbm_create_device(card);
  const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (gl->device_ != nullptr && get != nullptr) gl->display_ = get(EGL_PLATFORM_GBM_KHR, gl->device_, nullptr);
  if (gl->display_ != EGL_NO_DISPLAY && eglInitialize(gl->display_, nullptr, nullptr) == EGL_TRUE) return gl;
  return fail(ErrorCode::Unsupported, "this card has no GL driver; install one (Debian: libgl1-mesa-dri)");
}

CardGl::~CardGl() {
  if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
  if (device_ != nullptr) gbm_device_destroy(device_);
}

Result<std::unique_ptr<Buffers>> Buffers::make(const CardGl& gl, EGLConfig config, int width, int height) {
  std::unique_ptr<Buffers> buffers(new Buffers(gl));
  buffers->surface_of_buffers_ =
      gbm_surface_create(gl.device(), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                         kPixelFormat, GBM_BO_USE_SCANOUT | GBM_BO_USE_RENDERING);
  if (buffers->surface_of_buffers_ != nullptr) {
    buffers->surface_ = eglCreateWindowSurface(
        gl.display(), config, reinterpret_cast<EGLNativeWindowType>(buffers->surface_of_buffers_), nullptr);
  }
  if (buffers->surface_ != EGL_NO_SURFACE) return buffers;
  return fail(ErrorCode::Exhausted, "the card cannot allocate buffers of this size; choose a smaller --size");
}

// Mesa releases a buffer through the EGL surface.
Buffers::~Buffers() {
  for (gbm_bo* buffer : {on_screen_, next_}) {
    if (buffer != nullptr) gbm_surface_release_buffer(surface_of_buffers_, buffer);
  }
  if (surface_ != EGL_NO_SURFACE) eglDestroySurface(gl_.display(), surface_);
  if (surface_of_buffers_ != nullptr) gbm_surface_destroy(surface_of_buffers_);
}

Result<std::uint32_t> Buffers::swap() {
  if (eglSwapBuffers(gl_.display(), surface_) != EGL_TRUE) {
    return fail(ErrorCode::Lost, "GL cannot draw on the screen any more; opening it again");
  }
  gbm_bo* drawn = gbm_surface_lock_front_buffer(surface_of_buffers_);
  if (drawn == nullptr)
    return fail(ErrorCode::Exhausted, "the card has no buffer left to draw on; choose a smaller --size");
  if (next_ != nullptr) gbm_surface_release_buffer(surface_of_buffers_, next_);  // it was never shown
  next_ = drawn;
  return framebufferOf(drawn);
}

void Buffers::shown() noexcept {
  if (next_ == nullptr) return;
  if (on_screen_ != nullptr) gbm_surface_release_buffer(surface_of_buffers_, on_screen_);
  on_screen_ = std::exchange(next_, nullptr);
}

Result<std::uint32_t> Buffers::framebufferOf(gbm_bo* buffer) {
  if (auto* known = static_cast<Framebuffer*>(gbm_bo_get_user_data(buffer))) return known->id;
  const int card = gbm_device_get_fd(gl_.device());
  std::array<std::uint32_t, 4> handles{}, strides{}, offsets{};
  std::array<std::uint64_t, 4> modifiers{};
  for (int plane = 0; plane < gbm_bo_get_plane_count(buffer); ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    handles[i] = gbm_bo_get_handle_for_plane(buffer, plane).u32;
    strides[i] = gbm_bo_get_stride_for_plane(buffer, plane);
    offsets[i] = gbm_bo_get_offset(buffer, plane);
    modifiers[i] = gbm_bo_get_modifier(buffer);
  }
  const bool modified = modifiers[0] != DRM_FORMAT_MOD_INVALID && modifiers[0] != DRM_FORMAT_MOD_LINEAR;
  auto framebuffer = std::make_unique<Framebuffer>(card);
  if (drmModeAddFB2WithModifiers(card, gbm_bo_get_width(buffer), gbm_bo_get_height(buffer), kPixelFormat,
                                 handles.data(), strides.data(), offsets.data(), modified ? modifiers.data() : nullptr,
                                 &framebuffer->id, modified ? DRM_MODE_FB_MODIFIERS : 0U) != 0) {
    return fail(ErrorCode::Io, "the card cannot show the GL driver's buffers; install another GL driver", errno);
  }
  const std::uint32_t id = framebuffer->id;
  gbm_bo_set_user_data(buffer, framebuffer.release(), removeFramebuffer);
  return id;
}

}  // namespace relievo::kms
