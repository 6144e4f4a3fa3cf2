// SPDX-License-Identifier: Apache-2.0
// The display in a window: SDL opens it and makes the GLES context through EGL; this class handles its events.
#include <EGL/egl.h>
#include <SDL.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/egl/egl.h"
#include "drivers/egl/window_keys.h"

namespace relievo {
namespace {

constexpr const char* kTitle = "relievo";
constexpr const char* kOwner = "relievo display";  // key of a window's pointer to its display
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
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  SDL_SetHint(SDL_HINT_APP_NAME, kTitle);
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) return false;
  SDL_StopTextInput();  // keep input methods from consuming keys
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

// Where the centre of a pixel lies, from 0 to 1 across all pixels. A pixel outside counts as the nearest one inside.
double shareOf(int pixel, int pixels) noexcept {
  return (std::clamp(pixel, 0, std::max(pixels - 1, 0)) + 0.5) / std::max(pixels, 1);
}

// Of the current surface. SDL believes that a window fills the screen as soon as it has asked for that.
int trueSize(EGLint side) noexcept {
  EGLint pixels = 0;
  eglQuerySurface(eglGetCurrentDisplay(), eglGetCurrentSurface(EGL_DRAW), side, &pixels);
  return pixels;
}

class WindowDisplay final : public Display {
 public:
  WindowDisplay(std::shared_ptr<WindowInput> input, const Clock& clock) : input_(std::move(input)), clock_(clock) {}
  ~WindowDisplay() override { close(); }

  [[nodiscard]] DisplayCapabilities capabilities() const noexcept override {
    return {.name = "window", .gles = true, .refresh_period = refresh_period_};
  }

 private:
  Result<void> openDisplay(const DisplayConfig& config) override;
  Result<DisplaySurface> startFrame() override;
  Result<Duration> showFrame() override;
  Result<bool> attendScreen() override;
  void closeDisplay() noexcept override;
  void nameFilm(const AnnouncedFilm& film) override;
  void showViews(const SceneViews& views) override;
  void setFullScreen(FullScreen wish) override;
  std::vector<std::string> droppedOnIt() override { return std::exchange(dropped_, {}); }

  Result<void> makeCurrent() noexcept;
  void readRefresh() noexcept;
  void takeSize(int width, int height) noexcept;
  [[nodiscard]] bool fillsScreen() const noexcept override {
    return by_hand_ || (SDL_GetWindowFlags(window_) & SDL_WINDOW_FULLSCREEN) != 0;
  }
  void followFullScreen();
  void fillByHand() noexcept;
  void leaveByHand() noexcept;

  void hear(const SDL_Event& event);
  void hearWindow(const SDL_WindowEvent& event);
  void hearKey(const SDL_KeyboardEvent& event);
  void hearButton(const SDL_MouseButtonEvent& event);
  void hearWheel(int notches);
  void moveMouse(int x, int y) noexcept;
  [[nodiscard]] bool tellMouse(bool pressed, int notches = 0) const;
  void publishMouse() noexcept;
  void hearDrop(const SDL_DropEvent& event);

  std::shared_ptr<WindowInput> input_;
  const Clock& clock_;
  SDL_Window* window_ = nullptr;
  SDL_GLContext context_ = nullptr;
  Duration refresh_period_{0};
  bool paced_ = false;      // swapping waits for the refresh
  bool film_size_ = false;  // the window takes each film's size
  SceneViews views_;
  WindowMouse mouse_;
  int mouse_x_ = 0, mouse_y_ = 0;
  bool press_taken_ = false;  // by what is drawn over the picture
  std::vector<std::string> dropped_;
  bool redraw_ = false;
  bool closed_by_viewer_ = false;
  std::optional<MonotonicTime> fill_asked_;  // SDL was asked to fill the screen; nullopt once that is done
  bool by_hand_ = false;                     // the window fills the screen without a window manager
  SDL_Rect before_{};                        // the window's place before it was to fill the screen
};

Result<void> WindowDisplay::openDisplay(const DisplayConfig& config) {
  if (!startSdl()) {
    return fail(ErrorCode::Unsupported,
                "there is no desktop to open a window on; start relievo from one (X11 or Wayland)");
  }
  film_size_ = config.film_size;
  window_ = SDL_CreateWindow(kTitle, SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, config.width, config.height,
                             SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI |
                                 (film_size_ ? SDL_WINDOW_HIDDEN : SDL_WINDOW_SHOWN));
  if (window_ == nullptr) return fail(ErrorCode::Unsupported, kNoGles);
  SDL_SetWindowData(window_, kOwner, this);
  context_ = SDL_GL_CreateContext(window_);
  if (context_ == nullptr) return fail(ErrorCode::Unsupported, kNoGles);
  paced_ = SDL_GL_SetSwapInterval(1) == 0;
  readRefresh();

  redraw_ = closed_by_viewer_ = by_hand_ = false;
  fill_asked_.reset();
  mouse_ = {};
  views_ = {};
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
  if (fill_asked_) surface.width = trueSize(EGL_WIDTH), surface.height = trueSize(EGL_HEIGHT);
  else SDL_GL_GetDrawableSize(window_, &surface.width, &surface.height);
  return surface;
}

// SDL_GL_SwapWindow reports failures only by SDL_GetError. A frame is on the screen at the next refresh.
Result<Duration> WindowDisplay::showFrame() {
  if (auto current = makeCurrent(); !current) return std::unexpected(current.error());
  SDL_ShowWindow(window_);  // the first frame of a film's own size
  SDL_ClearError();
  SDL_GL_SwapWindow(window_);
  if (*SDL_GetError() != '\0') return fail(ErrorCode::Lost, "the window cannot be drawn on any more; opening it again");
  return paced_ ? refresh_period_ : Duration(0);
}

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
    if (void* owner = SDL_GetWindowData(window, kOwner)) static_cast<WindowDisplay*>(owner)->hear(event);
  }
  followFullScreen();
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
  if (event.event == SDL_WINDOWEVENT_RESIZED && !fillsScreen()) film_size_ = false;  // by the viewer, or the desktop
  if (event.event != SDL_WINDOWEVENT_SIZE_CHANGED) return;
  redraw_ = true;
  publishMouse();
}

void WindowDisplay::hearDrop(const SDL_DropEvent& event) {
  if (event.file == nullptr) return;
  dropped_.emplace_back(event.file);
  SDL_free(event.file);
}

void WindowDisplay::hearKey(const SDL_KeyboardEvent& event) {
  const bool down = event.state == SDL_PRESSED;
  const auto code = linuxKey(event.keysym);
  if (!code) return;
  using Action = KeyEvent::Action;
  const Action action = !down ? Action::Release : event.repeat != 0 ? Action::Repeat : Action::Press;
  static_cast<void>(input_->keys.tryPush({.code = *code, .action = action, .time = clock_.now()}));
}

void WindowDisplay::hearButton(const SDL_MouseButtonEvent& event) {
  const bool down = event.state == SDL_PRESSED;
  if (event.button == SDL_BUTTON_MIDDLE) mouse_.middle = down;
  if (event.button == SDL_BUTTON_RIGHT) mouse_.right = down;
  if (event.button == SDL_BUTTON_LEFT) {
    mouse_x_ = event.x;
    mouse_y_ = event.y;
    const bool taken = tellMouse(down);
    press_taken_ = down && taken;
    mouse_.left = down && !press_taken_;
  }
  moveMouse(event.x, event.y);
  if (mouse_.left && event.button == SDL_BUTTON_LEFT && event.clicks == 2) setFullScreen(FullScreen::Toggle);
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

// Where no eye sees the scene, the mouse points where it pointed last.
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

void WindowDisplay::setFullScreen(FullScreen wish) {
  const bool fill = wish == FullScreen::Toggle ? !fillsScreen() : wish == FullScreen::On;
  if (fill == fillsScreen()) return;
  SDL_ShowCursor(fill ? SDL_DISABLE : SDL_ENABLE);
  if (by_hand_) return leaveByHand();
  if (fill) {
    SDL_GetWindowPosition(window_, &before_.x, &before_.y);
    SDL_GetWindowSize(window_, &before_.w, &before_.h);
  }
  SDL_SetWindowFullscreen(window_, fill ? Uint32{SDL_WINDOW_FULLSCREEN_DESKTOP} : 0U);
  fill_asked_ = fill ? std::optional(clock_.now()) : std::nullopt;
}

// A window manager fills the screen with the window on SDL's request. Without one nobody does.
void WindowDisplay::followFullScreen() {
  constexpr Duration kPatience = std::chrono::milliseconds(500);
  if (!fill_asked_ || clock_.now() < *fill_asked_ + kPatience || !makeCurrent()) return;
  fill_asked_.reset();
  int width = 0, height = 0;
  SDL_GL_GetDrawableSize(window_, &width, &height);
  if (trueSize(EGL_WIDTH) != width || trueSize(EGL_HEIGHT) != height) fillByHand();
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

void WindowDisplay::nameFilm(const AnnouncedFilm& film) {
  SDL_SetWindowTitle(window_, film.title.empty() ? kTitle : (film.title + " - " + kTitle).c_str());
  if (film_size_ && film.width > 0 && film.height > 0) takeSize(film.width, film.height);
}

// Smaller in its own shape where the desktop has not so much room; a frame around the window takes some of it.
void WindowDisplay::takeSize(int width, int height) noexcept {
  constexpr double kRoom = 0.95;
  SDL_Rect room{};
  if (SDL_GetDisplayUsableBounds(SDL_GetWindowDisplayIndex(window_), &room) == 0) {
    const double scale = std::min({1.0, kRoom * room.w / width, kRoom * room.h / height});
    width = std::max(1, static_cast<int>(std::lround(scale * width)));
    height = std::max(1, static_cast<int>(std::lround(scale * height)));
  }
  SDL_SetWindowSize(window_, width, height);
  SDL_SetWindowPosition(window_, SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED);
}

void WindowDisplay::closeDisplay() noexcept {
  if (window_ != nullptr) input_->open = false;
  if (context_ != nullptr) SDL_GL_DeleteContext(std::exchange(context_, nullptr));
  if (window_ != nullptr) SDL_DestroyWindow(std::exchange(window_, nullptr));
}

}  // namespace

bool desktopIsThere() {
  const bool named = std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  return named && startSdl();
}

std::unique_ptr<Display> makeWindowDisplay(std::shared_ptr<WindowInput> input, const Clock& clock) {
  return std::make_unique<WindowDisplay>(std::move(input), clock);
}

}  // namespace relievo
