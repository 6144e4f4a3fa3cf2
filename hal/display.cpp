// SPDX-License-Identifier: Apache-2.0
// State guards of the display.
#include "hal/display.h"

namespace relievo {

Result<void> Display::open(const DisplayConfig& config) {
  if (state_ != State::Closed) return fail(ErrorCode::InvalidState, "the display is open already; close it first");
  if (config.width < 1 || config.height < 1 || config.width > 16384 || config.height > 16384) {
    return fail(ErrorCode::InvalidArgument, "a display must be 1 to 16384 pixels wide and high");
  }
  auto opened = openDisplay(config);
  if (!opened) {
    closeDisplay();
    return opened;
  }
  state_ = State::Open;
  return {};
}

Result<DisplaySurface> Display::beginFrame() {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, "a frame can begin only on an open display");
  auto surface = startFrame();
  if (surface) state_ = State::Drawing;
  return surface;
}

Result<Duration> Display::present() {
  if (state_ != State::Drawing) return fail(ErrorCode::InvalidState, "no frame was begun; call beginFrame first");
  state_ = State::Open;
  return showFrame();
}

Result<bool> Display::attend() {
  if (state_ != State::Open) return fail(ErrorCode::InvalidState, "call attend on an open display, between frames");
  return attendScreen();
}

void Display::announce(const AnnouncedFilm& film) {
  if (state_ == State::Open) nameFilm(film);
}

void Display::setViews(const SceneViews& views) {
  if (state_ != State::Closed) showViews(views);
}

void Display::fillScreen(FullScreen wish) {
  if (state_ == State::Open) setFullScreen(wish);
}

void Display::close() noexcept {
  if (state_ == State::Closed) return;
  closeDisplay();
  state_ = State::Closed;
}

}  // namespace relievo
