// SPDX-License-Identifier: Apache-2.0
// Interface of a display: provides a surface to draw a frame on, and shows it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// The stereo layout that is signalled to the screen (HDMI 1.4a, vendor specific infoframe).
enum class StereoSignal : std::uint8_t { None, SideBySideHalf, TopAndBottom, FramePacking };

struct StereoSignals {
  bool side_by_side_half = false, top_and_bottom = false, frame_packing = false;

  [[nodiscard]] bool has(StereoSignal signal) const noexcept {
    return signal == StereoSignal::None || (signal == StereoSignal::SideBySideHalf && side_by_side_half) ||
           (signal == StereoSignal::TopAndBottom && top_and_bottom) ||
           (signal == StereoSignal::FramePacking && frame_packing);
  }
  // Frame packing has both eyes in full; top and bottom keeps the columns, in which the eyes differ.
  [[nodiscard]] StereoSignal best() const noexcept {
    if (frame_packing) return StereoSignal::FramePacking;
    if (top_and_bottom) return StereoSignal::TopAndBottom;
    return side_by_side_half ? StereoSignal::SideBySideHalf : StereoSignal::None;
  }
};

struct DisplayCapabilities {
  const char* name = "";
  bool gles = false;           // a GLES 3 context is current on the opener's thread while open; else nothing is drawn
  Duration refresh_period{0};  // of the screen, known from `open` on; 0: shows each frame at once
  StereoSignals stereo;        // supported by the screen, known from `open` on
};

struct DisplayConfig {
  int width = 1280;  // requested; DisplaySurface has the actual size
  int height = 720;
  StereoSignal stereo = StereoSignal::None;  // requested; DisplaySurface has the signal that is sent
  bool other_stereo = false;                 // if the screen does not support `stereo`: the best signal that it does
  bool film_size = false;                    // instead: a window's is each film's (see `announce`), a screen's its own
  bool fits_desktop = false;                 // a window is made smaller, in its shape, where the desktop has less room
};

// The film that a window is for.
struct AnnouncedFilm {
  std::string title;
  int width = 0, height = 0;  // of one picture, in square pixels
  bool operator==(const AnnouncedFilm&) const = default;
};

// A part of the surface in which one eye sees the scene: what a mouse over a window points at.
struct SceneView {
  double left = 0, top = 0, right = 1, bottom = 1;  // shares of the surface's width and height, from its top left
  double eye_x_mm = 0;                              // x of the eye, scene frame
  double half_width_mm = 0, half_height_mm = 0;     // of the part, in the screen plane
  bool operator==(const SceneView&) const = default;
};
struct SceneViews {
  std::vector<SceneView> views;
  double screen_z_mm = 0;          // of the screen plane, scene frame
  double viewing_distance_mm = 1;  // from the eyes to the screen plane
  double depth_mm = 0;             // of the display volume
  bool operator==(const SceneViews&) const = default;
};

// A mouse over a window; `across` and `down` in shares of its surface, from the top left.
struct SurfaceMouse {
  double across = 0, down = 0;
  bool pressed = false;  // the left button
  int notches = 0;       // that the wheel has been turned by just now, forward positive
};
// Returns true if the on-screen display takes the press: until the button is released, the press then does not reach
// the finger. The same holds for the wheel.
using MouseListener = std::function<bool(const SurfaceMouse&)>;

enum class FullScreen : std::uint8_t { Off, On, Toggle };

// The surface to draw on between beginFrame and present. `framebuffer` is a GL name (0 is a valid one) if the
// capabilities say gles, else 0. The origin is GL's: bottom left.
struct DisplaySurface {
  std::uint32_t framebuffer = 0;
  int width = 0;
  int height = 0;
  StereoSignal stereo = StereoSignal::None;  // sent with the picture
  // For frame packing only. Above 0: one tall picture, the left eye's rows on top, then this many black rows, then the
  // right eye's rows. 0: the left eye's picture to the left of the right eye's, each in full.
  int eye_gap_rows = 0;
};

// States: Closed -open-> Open -beginFrame-> Drawing -present-> Open; any -close-> Closed; `attend` only when Open. A
// call in a state that does not allow it returns InvalidState and changes nothing.
//
// Thread: the one that opened it, since a GL context belongs to a thread. Blocking: `present` may wait for the next
// refresh; if that does not come, it soon returns Lost. Lost: the screen has gone; `close`, then `open` again when it
// is back.
class Display {
 public:
  enum class State : std::uint8_t { Closed, Open, Drawing };
  virtual ~Display() = default;

  // Unsupported, with the reason, without such a display or GLES 3, and for frame packing on a screen that does not
  // support it, since no other layout has its size, unless `other_stereo` is set. NotFound if the display exists but no
  // screen is connected: try again later.
  [[nodiscard]] Result<void> open(const DisplayConfig& config);
  // Makes the GL context current and binds the framebuffer.
  [[nodiscard]] Result<DisplaySurface> beginFrame();
  // Shows what was drawn. Returns the time from the call until it is on the screen (0 for an offscreen one).
  [[nodiscard]] Result<Duration> present();
  // Handles the window system's or screen's events; call it often between frames, also while the film is paused. True
  // if the last frame should be drawn again, because its size changed or it was covered. Cancelled if the viewer closed
  // the window: end the film. Never waits.
  [[nodiscard]] Result<bool> attend();
  void close() noexcept;

  // The rest concerns windows; other displays ignore it, and so does a closed one.
  // A film begins: the window's title, and its size if the configuration said `film_size`.
  void announce(const AnnouncedFilm& film);
  // How the surface shows the scene from now on.
  void setViews(const SceneViews& views);
  void fillScreen(FullScreen wish);
  [[nodiscard]] bool isFullScreen() const noexcept { return state_ != State::Closed && fillsScreen(); }
  // `attend` calls it for every press and release of the left button, every move of the mouse and every turn of its
  // wheel. Empty: nobody listens.
  void hearMouse(MouseListener listener) { mouse_listener_ = std::move(listener); }
  // The files and addresses that the viewer has dropped on the window since the last call.
  [[nodiscard]] std::vector<std::string> takeDropped() { return droppedOnIt(); }

  [[nodiscard]] State state() const noexcept { return state_; }
  // The same in every state, except for the values known only from `open` on.
  [[nodiscard]] virtual DisplayCapabilities capabilities() const noexcept = 0;
  // For people, known from `open` on: the screen and the mode that the first frame sets. Empty: there is nothing to
  // say.
  [[nodiscard]] virtual std::string description() const { return {}; }

 protected:
  [[nodiscard]] bool tellMouse(const SurfaceMouse& mouse) const { return mouse_listener_ && mouse_listener_(mouse); }

 private:
  virtual Result<void> openDisplay(const DisplayConfig& config) = 0;
  virtual Result<DisplaySurface> startFrame() = 0;
  virtual Result<Duration> showFrame() = 0;
  virtual Result<bool> attendScreen() { return false; }
  virtual void nameFilm(const AnnouncedFilm& /*film*/) {}
  virtual void showViews(const SceneViews& /*views*/) {}
  virtual void setFullScreen(FullScreen /*wish*/) {}
  [[nodiscard]] virtual bool fillsScreen() const noexcept { return false; }
  virtual std::vector<std::string> droppedOnIt() { return {}; }
  virtual void closeDisplay() noexcept = 0;

  State state_ = State::Closed;
  MouseListener mouse_listener_;
};

}  // namespace relievo
