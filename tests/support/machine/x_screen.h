// SPDX-License-Identifier: Apache-2.0
// An X server of the test's own, without a screen or a desktop: what it shows is read back, keys and a mouse are real
// to it.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

struct _XDisplay;

namespace relievo::test {

inline constexpr const char* kNoXServer = "Xvfb does not start here (Debian: xvfb)";

// 640 x 480, black. While it lives, programs and libraries of this process find it by DISPLAY.
class XScreen {
 public:
  static constexpr int kWidth = 640, kHeight = 480;

  // Null where there is no Xvfb.
  [[nodiscard]] static std::unique_ptr<XScreen> start();
  ~XScreen();
  XScreen(const XScreen&) = delete;
  XScreen& operator=(const XScreen&) = delete;

  // Red, green, blue of the whole screen's pixel, from the top left.
  [[nodiscard]] std::array<int, 3> pixel(int x, int y) const;

  // A window of that title, once it is mapped; 0 when none came within some seconds.
  [[nodiscard]] unsigned long find(const std::string& title) const;
  struct Place {
    int x = 0, y = 0, width = 0, height = 0;
  };
  [[nodiscard]] std::optional<Place> place(unsigned long window) const;
  void resize(unsigned long window, int width, int height) const;
  // As a window manager asks when its close button is pressed.
  void askToClose(unsigned long window) const;
  void focus(unsigned long window) const;
  // Whether a window has asked, since this was called last, to fill the screen (1) or to do so no more (0); there is no
  // window manager to do it.
  [[nodiscard]] std::optional<int> takeFullScreenWish() const;

  // Key symbols as in X11/keysymdef.h by name: "space", "Right", "F11".
  void key(const char* name, bool down) const;
  void tap(const char* name) const {
    key(name, true);
    key(name, false);
  }
  void moveMouse(int x, int y) const;
  // 1 left, 2 middle, 3 right; 4 and 5 are a notch of the wheel, forward and back.
  void button(unsigned number, bool down) const;

  // The server dies, as when a session ends.
  void kill();

 private:
  XScreen(pid_t server, _XDisplay* connection) : server_(server), connection_(connection) {}
  pid_t server_;
  _XDisplay* connection_;
};

}  // namespace relievo::test
