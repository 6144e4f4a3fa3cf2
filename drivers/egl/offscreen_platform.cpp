// SPDX-License-Identifier: Apache-2.0
// Asks EGL's client extensions which platforms there are.
#include "drivers/egl/offscreen_platform.h"

#include <EGL/eglext.h>

#include <array>
#include <string_view>

namespace relievo {
namespace {

constexpr int kMostDevices = 16;

// Client extensions can be queried without a display; if not supported, the string is null.
bool clientHas(std::string_view extension) {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return extensions != nullptr && std::string_view(extensions).find(extension) != std::string_view::npos;
}

template <class Function>
Function functionNamed(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::vector<EGLDeviceEXT> devices() {
  if (!clientHas("EGL_EXT_platform_device")) return {};
  const auto query = functionNamed<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  std::array<EGLDeviceEXT, kMostDevices> found{};
  EGLint count = 0;
  if (query == nullptr || query(kMostDevices, found.data(), &count) != EGL_TRUE) return {};
  return std::vector<EGLDeviceEXT>(found.begin(), found.begin() + count);
}

}  // namespace

std::vector<EGLDisplay> offscreenDisplays() {
  std::vector<EGLDisplay> displays;
  const auto add = [&](EGLDisplay display) {
    if (display != EGL_NO_DISPLAY) displays.push_back(display);
  };
  if (const auto get = functionNamed<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT"); get != nullptr) {
    if (clientHas("EGL_MESA_platform_surfaceless")) add(get(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr));
    for (EGLDeviceEXT device : devices()) add(get(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
  }
  add(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return displays;
}

}  // namespace relievo
