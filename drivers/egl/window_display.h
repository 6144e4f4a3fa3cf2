// SPDX-License-Identifier: Apache-2.0
// The display in a window, as its parts see it.
#pragma once

#include <SDL.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/egl/egl.h"

namespace relievo {

inline constexpr const char* kWindowTitle = "relievo";
inline constexpr const char* kWindowOwner = "relievo display";  // key of a window's pointer to its display

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
  // The width of the current EGL surface. SDL cannot be asked: it reports full screen as soon as it has requested it.
  [[nodiscard]] static int trueWidth() noexcept;
  [[nodiscard]] static int trueHeight() noexcept;
  void followFullScreen();
  void followPlace() noexcept;
  void fillByHand() noexcept;
  void leaveByHand() noexcept;

  void hear(const SDL_Event& event);
  void hearWindow(const SDL_WindowEvent& event);
  void hearKey(const SDL_KeyboardEvent& event);
  void hearButton(const SDL_MouseButtonEvent& event);
  void hearOtherButton(std::uint8_t button);
  void hearWheel(int notches);
  void showPointer() noexcept;
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
  bool hidden_ = false;     // until the first frame of a film's own size
  SceneViews views_;
  WindowMouse mouse_;
  int mouse_x_ = 0, mouse_y_ = 0;
  MonotonicTime shown_at_;                                    // the last frame
  MonotonicTime placed_at_;                                   // the last event of the window's place, size or focus
  MonotonicTime hand_seen_;                                   // when the mouse was used
  std::array<std::uint16_t, SDL_NUM_SCANCODES> held_keys_{};  // the code of each, by scancode
  bool press_taken_ = false;                                  // by what is drawn over the picture
  std::vector<std::string> dropped_;
  bool redraw_ = false;
  bool closed_by_viewer_ = false;
  std::optional<MonotonicTime> fill_asked_;  // SDL was asked to fill the screen; nullopt once that is done
  bool by_hand_ = false;                     // the window fills the screen without a window manager
  SDL_Rect before_{};                        // the window's place before it was to fill the screen
};

}  // namespace relievo
