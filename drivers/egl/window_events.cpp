// SPDX-License-Identifier: Apache-2.0
// The window's events: keys, the mouse, dropped files, the desktop.
#include <linux/input-event-codes.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/egl/window_display.h"
#include "drivers/egl/window_keys.h"

namespace relievo {
namespace {

// Where the centre of a pixel lies, from 0 to 1 across all pixels. A pixel outside counts as the nearest one inside.
double shareOf(int pixel, int pixels) noexcept {
  return (std::clamp(pixel, 0, std::max(pixels - 1, 0)) + 0.5) / std::max(pixels, 1);
}

// The text of the key press that SDL has just told of: its next event, if it makes any.
std::string typedNext() {
  SDL_Event next{};
  const bool any = SDL_PeepEvents(&next, 1, SDL_PEEKEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT) == 1;
  return any && next.type == SDL_TEXTINPUT ? next.text.text : "";
}

// Of all that a window tells: the mouse, at rest, may point at another place of it afterwards.
bool mayLieElsewhere(const SDL_WindowEvent& event) {
  switch (event.event) {
    case SDL_WINDOWEVENT_SHOWN:
    case SDL_WINDOWEVENT_MOVED:
    case SDL_WINDOWEVENT_SIZE_CHANGED:
    case SDL_WINDOWEVENT_ENTER:
    case SDL_WINDOWEVENT_FOCUS_GAINED:
      return true;
    default:
      return false;
  }
}

constexpr Duration kStill = std::chrono::seconds(15);  // without a new picture: a film is paused, or there is none
constexpr Duration kPointerShown = std::chrono::seconds(2);  // after the mouse was used

}  // namespace

// SDL has one event queue for the process: events of another window are passed to its display.
Result<bool> WindowDisplay::attendScreen() {
  for (SDL_Event event; SDL_PollEvent(&event) != 0;) {
    if (event.type == SDL_DROPFILE || event.type == SDL_DROPTEXT) {
      hearDrop(event.drop);
      continue;
    }
    SDL_Window* window =
        SDL_GetWindowFromID(event.window.windowID);  // windowID is at the same offset in the other kinds of event
    if (window == nullptr) continue;
    if (void* owner = SDL_GetWindowData(window, kWindowOwner)) static_cast<WindowDisplay*>(owner)->hear(event);
  }
  followFullScreen();
  followPlace();
  if (clock_.now() > hand_seen_ + kPointerShown) SDL_ShowCursor(SDL_DISABLE);
  if (clock_.now() > shown_at_ + kStill) SDL_EnableScreenSaver();
  if (closed_by_viewer_) return fail(ErrorCode::Cancelled, "the viewer has closed the window");
  return std::exchange(redraw_, false);
}

void WindowDisplay::hear(const SDL_Event& event) {
  switch (event.type) {
    case SDL_WINDOWEVENT:
      return hearWindow(event.window);
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      return hearKey(event.key);
    case SDL_MOUSEMOTION:
      showPointer();
      moveMouse(event.motion.x, event.motion.y);
      static_cast<void>(tellMouse(press_taken_));
      return;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      return hearButton(event.button);
    case SDL_MOUSEWHEEL:
      return hearWheel(event.wheel.direction == SDL_MOUSEWHEEL_FLIPPED ? -event.wheel.y : event.wheel.y);
    default:
      return;
  }
}

void WindowDisplay::hearWindow(const SDL_WindowEvent& event) {
  if (event.event == SDL_WINDOWEVENT_CLOSE) closed_by_viewer_ = true;
  if (event.event == SDL_WINDOWEVENT_EXPOSED) redraw_ = true;
  if (event.event == SDL_WINDOWEVENT_FOCUS_GAINED) input_->focused = true;
  if (event.event == SDL_WINDOWEVENT_FOCUS_LOST) input_->focused = false;
  if (mayLieElsewhere(event)) placed_at_ = clock_.now();
  if (event.event == SDL_WINDOWEVENT_RESIZED && !fillsScreen()) film_size_ = false;  // by the viewer, or the desktop
  if (event.event != SDL_WINDOWEVENT_SIZE_CHANGED) return;
  redraw_ = true;
  publishMouse();
}

// A mouse at rest tells nothing when the window moves beneath it. SDL does not tell of a move of its own, and the
// desktop may move the window once more.
void WindowDisplay::followPlace() noexcept {
  constexpr Duration kSettles = std::chrono::seconds(1);
  const char* const driver = SDL_GetCurrentVideoDriver();  // on Wayland no window knows its place
  if (clock_.now() > placed_at_ + kSettles || SDL_GetMouseFocus() != window_) return;
  if (driver == nullptr || std::string_view(driver) != "x11") return;
  int x = 0, y = 0, left = 0, top = 0;
  SDL_GetGlobalMouseState(&x, &y);
  SDL_GetWindowPosition(window_, &left, &top);
  if (x - left != mouse_x_ || y - top != mouse_y_) moveMouse(x - left, y - top);
}

void WindowDisplay::hearDrop(const SDL_DropEvent& event) {
  if (event.file == nullptr) return;
  dropped_.emplace_back(event.file);
  SDL_free(event.file);
}

void WindowDisplay::hearKey(const SDL_KeyboardEvent& event) {
  const bool down = event.state == SDL_PRESSED;
  std::uint16_t& held = held_keys_[event.keysym.scancode];  // a release has no sign
  if (down && event.repeat == 0) held = linuxKey(event.keysym, typedNext()).value_or(KEY_RESERVED);
  if (held == KEY_RESERVED) return;
  using Action = KeyEvent::Action;
  const Action action = !down ? Action::Release : event.repeat != 0 ? Action::Repeat : Action::Press;
  static_cast<void>(input_->keys.tryPush({.code = held, .action = action, .time = clock_.now()}));
}

void WindowDisplay::hearButton(const SDL_MouseButtonEvent& event) {
  const bool down = event.state == SDL_PRESSED;
  showPointer();
  if (event.button == SDL_BUTTON_MIDDLE) mouse_.middle = down;
  if (event.button == SDL_BUTTON_RIGHT) mouse_.right = down;
  mouse_x_ = event.x;
  mouse_y_ = event.y;
  if (event.button == SDL_BUTTON_LEFT) {
    const bool taken = tellMouse(down);
    press_taken_ = down && taken;
    mouse_.left = down && !press_taken_;
  }
  if (down) hearOtherButton(event.button);
  publishMouse();
  const bool second = event.clicks % 2 == 0;  // the fourth click in a row is the second of another pair
  if (mouse_.left && event.button == SDL_BUTTON_LEFT && second) setFullScreen(FullScreen::Toggle);
}

// As in other players: the right button pauses, those at the side change the film. In a list there is nothing to pause.
void WindowDisplay::hearOtherButton(std::uint8_t button) {
  const std::uint16_t code = button == SDL_BUTTON_RIGHT ? KEY_PLAYPAUSE
                             : button == SDL_BUTTON_X1  ? KEY_PREVIOUS
                             : button == SDL_BUTTON_X2  ? KEY_NEXT
                                                        : KEY_RESERVED;
  if (code == KEY_RESERVED || (button == SDL_BUTTON_RIGHT && tellMouse(press_taken_))) return;
  for (const auto action : {KeyEvent::Action::Press, KeyEvent::Action::Release}) {
    static_cast<void>(input_->keys.tryPush({.code = code, .action = action, .time = clock_.now()}));
  }
}

void WindowDisplay::showPointer() noexcept {
  hand_seen_ = clock_.now();
  SDL_ShowCursor(SDL_ENABLE);
}

void WindowDisplay::hearWheel(int notches) {
  if (!tellMouse(false, notches)) mouse_.notches += notches;
  publishMouse();
}

bool WindowDisplay::tellMouse(bool pressed, int notches) const {
  int width = 0, height = 0;
  SDL_GetWindowSize(window_, &width, &height);
  return Display::tellMouse({shareOf(mouse_x_, width), shareOf(mouse_y_, height), pressed, notches});
}

void WindowDisplay::moveMouse(int x, int y) noexcept {
  mouse_x_ = x;
  mouse_y_ = y;
  publishMouse();
}

// Where the mouse is over no view of the scene, its last ray is kept.
void WindowDisplay::publishMouse() noexcept {
  int width = 0, height = 0;
  SDL_GetWindowSize(window_, &width, &height);
  if (const auto ray = rayThrough(views_, shareOf(mouse_x_, width), shareOf(mouse_y_, height))) mouse_.ray = ray;
  input_->mouse.back() = mouse_;
  input_->mouse.publish();
}

void WindowDisplay::showViews(const SceneViews& views) {
  if (views == views_) return;
  views_ = views;
  publishMouse();
}

}  // namespace relievo
