// SPDX-License-Identifier: Apache-2.0
// GBM's buffers, and EGL's surfaces on them: pbuffers of Mesa's surfaceless platform, read back at every swap.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <dlfcn.h>
#include <drm_fourcc.h>
#include <gbm.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "tests/support/device/card/card_state.h"

struct gbm_device {
  int card;
};
struct gbm_bo {
  gbm_surface* surface = nullptr;
  bool locked = false;
  void* data = nullptr;
  void (*destroy)(gbm_bo*, void*) = nullptr;
};
struct gbm_surface {
  std::uint32_t width, height;
  std::array<gbm_bo, 4> buffers;
};

namespace {

// EGL's own function, which this program's hides.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_DEFAULT, name));
}

EGLDisplay surfaceless(EGLenum platform, void* native, const EGLint* attributes) {
  const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      real<decltype(eglGetProcAddress)>("eglGetProcAddress")("eglGetPlatformDisplayEXT"));
  if (platform != EGL_PLATFORM_GBM_KHR) return get(platform, native, attributes);
  return get(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

}  // namespace

extern "C" {

gbm_device* gbm_create_device(int card) {
  return new gbm_device{card};
}
void gbm_device_destroy(gbm_device* device) {
  delete device;
}
int gbm_device_get_fd(gbm_device* device) {
  return device->card;
}
gbm_surface* gbm_surface_create(gbm_device* /*device*/, std::uint32_t width, std::uint32_t height,
                                std::uint32_t /*format*/, std::uint32_t /*flags*/) {
  auto* const surface = new gbm_surface{width, height, {}};
  for (gbm_bo& buffer : surface->buffers) buffer.surface = surface;
  return surface;
}
void gbm_surface_destroy(gbm_surface* surface) {
  for (gbm_bo& buffer : surface->buffers) {
    if (buffer.destroy != nullptr) buffer.destroy(&buffer, buffer.data);
  }
  delete surface;
}
gbm_bo* gbm_surface_lock_front_buffer(gbm_surface* surface) {
  for (gbm_bo& buffer : surface->buffers) {
    if (!std::exchange(buffer.locked, true)) return &buffer;
  }
  return nullptr;
}
void gbm_surface_release_buffer(gbm_surface* /*surface*/, gbm_bo* buffer) {
  buffer->locked = false;
}
void* gbm_bo_get_user_data(gbm_bo* buffer) {
  return buffer->data;
}
void gbm_bo_set_user_data(gbm_bo* buffer, void* data, void (*destroy)(gbm_bo*, void*)) {
  buffer->data = data;
  buffer->destroy = destroy;
}
int gbm_bo_get_plane_count(gbm_bo* /*buffer*/) {
  return 1;
}
gbm_bo_handle gbm_bo_get_handle_for_plane(gbm_bo* /*buffer*/, int /*plane*/) {
  return {.u32 = 1};
}
std::uint32_t gbm_bo_get_stride_for_plane(gbm_bo* buffer, int /*plane*/) {
  return buffer->surface->width * 4;
}
std::uint32_t gbm_bo_get_offset(gbm_bo* /*buffer*/, int /*plane*/) {
  return 0;
}
std::uint64_t gbm_bo_get_modifier(gbm_bo* /*buffer*/) {
  return DRM_FORMAT_MOD_LINEAR;
}
std::uint32_t gbm_bo_get_width(gbm_bo* buffer) {
  return buffer->surface->width;
}
std::uint32_t gbm_bo_get_height(gbm_bo* buffer) {
  return buffer->surface->height;
}

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
  if (std::strcmp(name, "eglGetPlatformDisplayEXT") == 0) {
    return reinterpret_cast<__eglMustCastToProperFunctionPointerType>(surfaceless);
  }
  return real<decltype(eglGetProcAddress)>("eglGetProcAddress")(name);
}
// The display is shared with whatever draws off screen in this program.
EGLBoolean eglTerminate(EGLDisplay /*display*/) {
  return EGL_TRUE;
}
EGLBoolean eglChooseConfig(EGLDisplay display, const EGLint* wanted, EGLConfig* configs, EGLint most, EGLint* found) {
  std::vector<EGLint> changed;
  for (; *wanted != EGL_NONE; wanted += 2) {
    const bool window = wanted[0] == EGL_SURFACE_TYPE && wanted[1] == EGL_WINDOW_BIT;
    changed.insert(changed.end(), {wanted[0], window ? EGL_PBUFFER_BIT : wanted[1]});
  }
  changed.push_back(EGL_NONE);
  return real<decltype(eglChooseConfig)>("eglChooseConfig")(display, changed.data(), configs, most, found);
}
EGLBoolean eglGetConfigAttrib(EGLDisplay display, EGLConfig config, EGLint attribute, EGLint* value) {
  if (attribute != EGL_NATIVE_VISUAL_ID) {
    return real<decltype(eglGetConfigAttrib)>("eglGetConfigAttrib")(display, config, attribute, value);
  }
  *value = GBM_FORMAT_XRGB8888;
  return EGL_TRUE;
}
EGLSurface eglCreateWindowSurface(EGLDisplay display, EGLConfig config, EGLNativeWindowType window,
                                  const EGLint* /*attributes*/) {
  const auto* const surface = reinterpret_cast<const gbm_surface*>(window);
  const std::array<EGLint, 5> size{EGL_WIDTH, static_cast<EGLint>(surface->width), EGL_HEIGHT,
                                   static_cast<EGLint>(surface->height), EGL_NONE};
  return eglCreatePbufferSurface(display, config, size.data());
}
EGLBoolean eglSwapBuffers(EGLDisplay display, EGLSurface surface) {
  EGLint width = 0, height = 0;
  eglQuerySurface(display, surface, EGL_WIDTH, &width);
  eglQuerySurface(display, surface, EGL_HEIGHT, &height);
  auto& drawn = relievo::test::theCard().drawn;
  drawn = {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * 4)};
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, drawn.rgba.data());
  const auto row = static_cast<std::ptrdiff_t>(width) * 4;
  for (int r = 0; r < height / 2; ++r) {  // GL's first row is at the bottom
    std::swap_ranges(drawn.rgba.begin() + r * row, drawn.rgba.begin() + (r + 1) * row,
                     drawn.rgba.begin() + (height - 1 - r) * row);
  }
  return EGL_TRUE;
}

}  // extern "C"
