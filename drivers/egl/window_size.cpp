// SPDX-License-Identifier: Apache-2.0
// The window's size: a film's own, and the whole screen.
#include <EGL/egl.h>

#include <algorithm>
#include <cmath>

#include "drivers/egl/desktop_scale.h"
#include "drivers/egl/window_display.h"

namespace relievo {
namespace {

constexpr double kRoomAcross = 0.95, kRoomDown = 0.92;  // shares of a screen that a window takes by itself

// Where a window begins that grows or shrinks around its middle, within that share of the screen.
int aroundMiddle(int from, int before, int size, int room_from, int room, double share) noexcept {
  const int edge = static_cast<int>(std::lround(0.5 * (1 - share) * room));
  const int last = std::max(room_from + edge, room_from + room - edge - size);
  return std::clamp(from + (before - size) / 2, room_from + edge, last);
}

int trueSize(EGLint side) noexcept {
  EGLint pixels = 0;
  eglQuerySurface(eglGetCurrentDisplay(), eglGetCurrentSurface(EGL_DRAW), side, &pixels);
  return pixels;
}

}  // namespace

int WindowDisplay::trueWidth() noexcept {
  return trueSize(EGL_WIDTH);
}

int WindowDisplay::trueHeight() noexcept {
  return trueSize(EGL_HEIGHT);
}

void WindowDisplay::setFullScreen(FullScreen wish) {
  const bool fill = wish == FullScreen::Toggle ? !fillsScreen() : wish == FullScreen::On;
  if (fill == fillsScreen()) return;
  if (by_hand_) return leaveByHand();
  if (fill) {
    SDL_GetWindowPosition(window_, &before_.x, &before_.y);
    SDL_GetWindowSize(window_, &before_.w, &before_.h);
  }
  int x = 0, y = 0;
  SDL_PumpEvents();
  SDL_GetGlobalMouseState(&x, &y);
  SDL_SetWindowFullscreen(window_, fill ? Uint32{SDL_WINDOW_FULLSCREEN_DESKTOP} : 0U);
  // SDL has moved the mouse to where it last heard of it in the window: moves it back to its place on the screen.
  if (SDL_GetMouseFocus() == window_) SDL_WarpMouseGlobal(x, y);
  const bool unanswered = fill_asked_.has_value();  // SDL may have a size that the window never got
  fill_asked_ = fill ? std::optional(clock_.now()) : std::nullopt;
  if (!fill && unanswered) leaveByHand();
}

// A window manager fills the screen with the window on SDL's request. Without one, this does it.
void WindowDisplay::followFullScreen() {
  constexpr Duration kPatience = std::chrono::milliseconds(500);
  if (!fill_asked_ || hidden_ || clock_.now() < *fill_asked_ + kPatience || !makeCurrent()) return;
  fill_asked_.reset();
  int width = 0, height = 0;
  SDL_GL_GetDrawableSize(window_, &width, &height);
  if (trueWidth() != width || trueHeight() != height) fillByHand();
  redraw_ = true;
}

void WindowDisplay::fillByHand() noexcept {
  SDL_Rect screen{};
  if (SDL_GetDisplayBounds(SDL_GetWindowDisplayIndex(window_), &screen) != 0) return;
  by_hand_ = true;
  SDL_SetWindowFullscreen(window_, 0);
  SDL_SetWindowPosition(window_, screen.x, screen.y);
  SDL_SetWindowSize(window_, screen.w, screen.h);
}

void WindowDisplay::leaveByHand() noexcept {
  by_hand_ = false;
  SDL_SetWindowSize(window_, before_.w, before_.h);
  SDL_SetWindowPosition(window_, before_.x, before_.y);
}

// Sets the window's size in pixels: enlarged by the desktop's scale, then shrunk in its own shape if the screen is too
// small. The window's frame and title take space too: up to 1/14 of a screen of 600 rows. A window that is shown stays
// where the viewer has moved it.
void WindowDisplay::takeSize(int width, int height) noexcept {
  const int enlarged = desktopScale();
  width *= enlarged;
  height *= enlarged;
  SDL_Rect room{};
  if (SDL_GetDisplayUsableBounds(SDL_GetWindowDisplayIndex(window_), &room) == 0) {
    const double scale = std::min({1.0, kRoomAcross * room.w / width, kRoomDown * room.h / height});
    width = std::max(1, static_cast<int>(std::lround(scale * width)));
    height = std::max(1, static_cast<int>(std::lround(scale * height)));
  }
  const bool fills = fillsScreen();  // then SDL tells the screen's place and size
  int x = SDL_WINDOWPOS_CENTERED, y = SDL_WINDOWPOS_CENTERED;
  if (film_size_ && (fills || !hidden_)) {
    SDL_Rect now = before_;
    if (!fills) {
      SDL_GetWindowPosition(window_, &now.x, &now.y);
      SDL_GetWindowSize(window_, &now.w, &now.h);
    }
    if (now.w == width && now.h == height) return;
    x = aroundMiddle(now.x, now.w, width, room.x, room.w, kRoomAcross);
    y = aroundMiddle(now.y, now.h, height, room.y, room.h, kRoomDown);
  }
  if (fills) before_ = {x, y, width, height};
  if (by_hand_) return;
  SDL_SetWindowSize(window_, width, height);
  SDL_SetWindowPosition(window_, x, y);
  placed_at_ = clock_.now();
}

}  // namespace relievo
