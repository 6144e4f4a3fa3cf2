// SPDX-License-Identifier: Apache-2.0
// A private X server (Xvfb) without a desktop: a test reads back its picture and sends it keys and mouse events.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct _XDisplay;

namespace relievo::test {

inline constexpr const char* kNoXServer = "Xvfb cannot be started; install it (Debian: xvfb)";

// 640 x 480, black. While it lives, programs and libraries of this process find it by DISPLAY.
class XScreen {
 public:
  static constexpr int kWidth = 640, kHeight = 480;

  // Null without Xvfb.
  [[nodiscard]] static std::unique_ptr<XScreen> start();
  ~XScreen();
  XScreen(const XScreen&) = delete;
  XScreen& operator=(const XScreen&) = delete;

  // Red, green and blue of a pixel of the screen; the origin is at the top left.
  [[nodiscard]] std::array<int, 3> pixel(int x, int y) const { return pixels(x, y, 1, 1)[0]; }
  // Of an area, row by row.
  [[nodiscard]] std::vector<std::array<int, 3>> pixels(int x, int y, int width, int height) const;

  // A mapped window with that title; 0 if none appears within some seconds.
  [[nodiscard]] unsigned long find(const std::string& title) const;
  struct Place {
    int x = 0, y = 0, width = 0, height = 0;
  };
  [[nodiscard]] std::optional<Place> place(unsigned long window) const;
  // What a desktop's settings say to all programs, as "Xft.dpi:\t192\n".
  void setResources(const std::string& text) const;
  // As a window manager does that minimises it.
  void hide(unsigned long window) const;
  [[nodiscard]] bool isShown(unsigned long window) const;
  void resize(unsigned long window, int width, int height) const;
  // As a window manager does.
  void move(unsigned long window, const Place& to) const;
  // Where the mouse is, x and y.
  [[nodiscard]] std::array<int, 2> mouse() const;
  // Sends the request of a window manager's close button.
  void askToClose(unsigned long window) const;
  void focus(unsigned long window) const;
  // The last request of a window since the previous call, to enter (1) or leave (0) full screen; nullopt without one.
  // There is no window manager to execute it.
  [[nodiscard]] std::optional<int> takeFullScreenWish() const;

  // Key symbols as in X11/keysymdef.h by name: "space", "Right", "F11".
  void key(const char* name, bool down) const;
  void tap(const char* name) const {
    key(name, true);
    key(name, false);
  }
  // While another one is held: "Shift_L", "Control_L".
  void tapWith(const char* held, const char* name) const {
    key(held, true);
    tap(name);
    key(held, false);
  }
  // The keyboard's layout, "de"; keys are found by their symbols in it. False without setxkbmap.
  [[nodiscard]] bool setLayout(const std::string& name) const;
  void moveMouse(int x, int y) const;
  // 1 left, 2 middle, 3 right; 4 and 5 are a notch of the wheel, forward and back.
  void button(unsigned number, bool down) const;

  // Drops a file on the window, as a file manager does (XDND 5). False if the window does not take it within seconds.
  [[nodiscard]] bool drop(unsigned long window, const std::string& path) const;

  // Kills the server, as at the end of a session. `answered` false: it stops answering before, so that a client is
  // killed off in the middle of drawing.
  void kill(bool answered = true);

 private:
  XScreen(pid_t server, _XDisplay* connection) : server_(server), connection_(connection) {}
  pid_t server_;
  _XDisplay* connection_;
};

}  // namespace relievo::test
