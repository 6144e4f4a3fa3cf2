// SPDX-License-Identifier: Apache-2.0
// SDL opens the window and makes the GLES context through EGL.
#include "drivers/egl/window_display.h"

#include <EGL/egl.h>

#include <cstdlib>
#include <utility>

#include "drivers/egl/desktop_loss.h"
#include "drivers/egl/desktop_scale.h"

namespace relievo {
namespace {

constexpr const char* kNoGles =
    "the desktop cannot open a window with GLES 3; install a GL driver (Debian: libegl1, libgl1-mesa-dri)";

// Initialises SDL's video and GL once for the process; neither is ever shut down, since Mesa's software driver leaks
// when it is unloaded. The user's environment variables override the hints.
bool startSdl() {
  if (SDL_WasInit(SDL_INIT_VIDEO) != 0) return true;
  // Never the console, which the kms display uses. Without a Wayland server, libwayland would complain on stderr.
  SDL_SetHint(SDL_HINT_VIDEODRIVER, std::getenv("WAYLAND_DISPLAY") != nullptr ? "x11,wayland" : "x11");
  SDL_SetHint(SDL_HINT_VIDEO_X11_FORCE_EGL, "1");       // instead of GLX
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");        // the program has its own
  SDL_SetHint(SDL_HINT_MOUSE_FOCUS_CLICKTHROUGH, "1");  // the click that focuses the window counts as well
  SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  SDL_SetHint(SDL_HINT_APP_NAME, kWindowTitle);
  SDL_setenv("SDL_IM_MODULE", "none", 0);  // keep input methods from consuming keys
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) return false;
  SDL_StopTextInput();
  SDL_EventState(SDL_TEXTINPUT, SDL_ENABLE);  // the signs of keys
  SDL_GL_ResetAttributes();
  for (const auto& [attribute, value] : {std::pair{SDL_GL_CONTEXT_PROFILE_MASK, int{SDL_GL_CONTEXT_PROFILE_ES}},
                                         {SDL_GL_CONTEXT_MAJOR_VERSION, 3},
                                         {SDL_GL_CONTEXT_MINOR_VERSION, 0},
                                         {SDL_GL_RED_SIZE, 8},
                                         {SDL_GL_GREEN_SIZE, 8},
                                         {SDL_GL_BLUE_SIZE, 8},
                                         {SDL_GL_DEPTH_SIZE, 24}}) {
    SDL_GL_SetAttribute(attribute, value);
  }
  SDL_GL_LoadLibrary(nullptr);  // keeps the driver loaded; opening a window reports any failure
  return true;
}

}  // namespace

Result<void> WindowDisplay::openDisplay(const DisplayConfig& config) {
  if (!startSdl()) {
    return fail(ErrorCode::Unsupported,
                "there is no desktop to open a window on; start relievo from one (X11 or Wayland)");
  }
  film_size_ = hidden_ = config.film_size;
  window_ =
      SDL_CreateWindow(kWindowTitle, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, config.width, config.height,
                       SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI |
                           (film_size_ ? SDL_WINDOW_HIDDEN : SDL_WINDOW_SHOWN));
  if (window_ == nullptr) return fail(ErrorCode::Unsupported, kNoGles);
  endWithXServer(*window_);
  SDL_SetWindowData(window_, kWindowOwner, this);
  if (film_size_ || config.fits_desktop) takeSize(config.width, config.height);
  context_ = SDL_GL_CreateContext(window_);
  if (context_ == nullptr) return fail(ErrorCode::Unsupported, kNoGles);
  paced_ = SDL_GL_SetSwapInterval(1) == 0;
  readRefresh();

  redraw_ = closed_by_viewer_ = by_hand_ = false;
  fill_asked_.reset();
  mouse_ = {};
  views_ = {};
  showPointer();
  publishMouse();
  input_->open = true;
  return {};
}

void WindowDisplay::readRefresh() noexcept {
  SDL_DisplayMode mode{};
  const bool known = SDL_GetCurrentDisplayMode(SDL_GetWindowDisplayIndex(window_), &mode) == 0 && mode.refresh_rate > 0;
  refresh_period_ = known ? fromSeconds(1.0 / mode.refresh_rate) : Duration(0);
}

// SDL caches the current context and does not notice when other code makes another one current.
Result<void> WindowDisplay::makeCurrent() noexcept {
  if (eglGetCurrentContext() != context_) SDL_GL_MakeCurrent(nullptr, nullptr);
  if (SDL_GL_MakeCurrent(window_, context_) == 0) return {};
  return fail(ErrorCode::Lost, "the window's GL context was lost; opening the window again");
}

Result<DisplaySurface> WindowDisplay::startFrame() {
  if (auto current = makeCurrent(); !current) return std::unexpected(current.error());
  DisplaySurface surface;
  if (fill_asked_) surface.width = trueWidth(), surface.height = trueHeight();
  else SDL_GL_GetDrawableSize(window_, &surface.width, &surface.height);
  return surface;
}

// SDL_GL_SwapWindow reports failures only by SDL_GetError. A frame is on the screen at the next refresh.
Result<Duration> WindowDisplay::showFrame() {
  if (auto current = makeCurrent(); !current) return std::unexpected(current.error());
  shown_at_ = clock_.now();
  if (std::exchange(hidden_, false)) {
    SDL_ShowWindow(window_);  // fills the screen, if that was asked for
    if (fill_asked_) fill_asked_ = shown_at_;
  }
  SDL_DisableScreenSaver();
  SDL_ClearError();
  SDL_GL_SwapWindow(window_);
  if (*SDL_GetError() != '\0') return fail(ErrorCode::Lost, "the window cannot be drawn on any more; opening it again");
  return paced_ ? refresh_period_ : Duration(0);
}

void WindowDisplay::nameFilm(const AnnouncedFilm& film) {
  if (film_size_ && film.width > 0 && film.height > 0) takeSize(film.width, film.height);
  SDL_SetWindowTitle(window_, film.title.empty() ? kWindowTitle : (film.title + " - " + kWindowTitle).c_str());
}

void WindowDisplay::closeDisplay() noexcept {
  if (window_ != nullptr) input_->open = false, SDL_EnableScreenSaver();
  if (context_ != nullptr) SDL_GL_DeleteContext(std::exchange(context_, nullptr));
  if (window_ != nullptr) SDL_DestroyWindow(std::exchange(window_, nullptr));
}

bool desktopIsThere() {
  const bool named = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  return named && startSdl();
}

std::unique_ptr<Display> makeWindowDisplay(std::shared_ptr<WindowInput> input, const Clock& clock) {
  return std::make_unique<WindowDisplay>(std::move(input), clock);
}

}  // namespace relievo
