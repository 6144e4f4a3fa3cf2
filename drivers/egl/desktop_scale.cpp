// SPDX-License-Identifier: Apache-2.0
// Uses the libX11 that SDL has loaded, since SDL 2.26 reports a screen's size in mm, not the desktop's scale.
#include "drivers/egl/desktop_scale.h"

#include <SDL.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace relievo {
namespace {

struct XServer;  // Xlib's Display

template <class Function>
Function* find(void* library, const char* name) noexcept {
  return reinterpret_cast<Function*>(SDL_LoadFunction(library, name));
}

double dpiOf(void* x11) noexcept {
  const auto open = find<XServer*(const char*)>(x11, "XOpenDisplay");
  const auto read = find<char*(XServer*, const char*, const char*)>(x11, "XGetDefault");
  const auto close = find<int(XServer*)>(x11, "XCloseDisplay");
  if (open == nullptr || read == nullptr || close == nullptr) return 0;
  XServer* const server = open(nullptr);
  if (server == nullptr) return 0;
  const char* const text = read(server, "Xft", "dpi");
  const double dpi = text == nullptr ? 0 : std::strtod(text, nullptr);
  close(server);
  return dpi;
}

}  // namespace

int desktopScale() noexcept {
  constexpr double kUsualDpi = 96, kNearly = 0.25;  // kNearly: from 168 dpi on, the scale is 2, not 1
  constexpr double kMost = 8;
  const char* const driver = SDL_GetCurrentVideoDriver();
  if (driver == nullptr || std::string_view(driver) != "x11") return 1;
  void* const x11 = SDL_LoadObject("libX11.so.6");
  if (x11 == nullptr) return 1;
  const double dpi = dpiOf(x11);
  SDL_UnloadObject(x11);
  return static_cast<int>(std::clamp(dpi / kUsualDpi + kNearly, 1.0, kMost));
}

}  // namespace relievo
