// SPDX-License-Identifier: Apache-2.0
// Interface of a display: gives a surface to draw a frame on, and shows it.
#pragma once

#include <cstdint>

#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// How a screen is told that a picture is of two eyes (HDMI 1.4a, vendor specific infoframe).
enum class StereoSignal : std::uint8_t { None, SideBySideHalf, TopAndBottom, FramePacking };

struct StereoSignals {
  bool side_by_side_half = false, top_and_bottom = false, frame_packing = false;

  [[nodiscard]] bool has(StereoSignal signal) const noexcept {
    return signal == StereoSignal::None || (signal == StereoSignal::SideBySideHalf && side_by_side_half) ||
           (signal == StereoSignal::TopAndBottom && top_and_bottom) ||
           (signal == StereoSignal::FramePacking && frame_packing);
  }
};

struct DisplayCapabilities {
  const char* name = "";
  bool gles = false;           // a GLES 3 context is current on the opener's thread while open
  Duration refresh_period{0};  // of the screen, known from `open` on; 0: shows a frame at once, whenever it comes
  StereoSignals stereo;        // that the screen takes, known from `open` on
};

struct DisplayConfig {
  int width = 1280;  // wished for; the surface tells what was given
  int height = 720;
  StereoSignal stereo = StereoSignal::None;  // to be sent where the screen takes it; the surface tells
};

// What to draw on between beginFrame and present. `framebuffer` is a GL name (0 is a valid one) when capabilities say
// gles, and 0 otherwise. The origin is GL's: bottom left.
struct DisplaySurface {
  std::uint32_t framebuffer = 0;
  int width = 0;
  int height = 0;
  StereoSignal stereo = StereoSignal::None;  // that is sent with it
  // Of frame packing alone, which comes as one tall picture: the left eye's rows on top, these in black, the right
  // eye's.
  int eye_gap_rows = 0;
};

// States: Closed -open-> Open -beginFrame-> Drawing -present-> Open; any -close-> Closed; `attend` when Open. A verb in
// a state that does not allow it returns InvalidState and changes nothing.
//
// Thread: the one that opened it, since a GL context belongs to a thread. Blocking: `present` may wait for the next
// refresh; a screen that does not come to it is Lost soon after. Lost: the screen has gone; `close`, then `open` again
// when it is back.
class Display {
 public:
  enum class State : std::uint8_t { Closed, Open, Drawing };
  virtual ~Display() = default;

  // Unsupported, with the reason, where there is no such display or no GLES 3, and for frame packing that the screen
  // does not take: no other layout would fit. NotFound where the display is there and no screen is connected to it: try
  // again.
  [[nodiscard]] Result<void> open(const DisplayConfig& config);
  // Makes the GL context current and binds the framebuffer.
  [[nodiscard]] Result<DisplaySurface> beginFrame();
  // Shows what was drawn. Returns how long after the call it is on the screen (0 for an offscreen one).
  [[nodiscard]] Result<Duration> present();
  // Between frames, often, also while a picture stands: does what the system wants of a screen meanwhile. True when the
  // last frame should be drawn anew, since its size has changed or it was covered. Cancelled when the viewer has closed
  // the window: the film is to end. Never waits.
  [[nodiscard]] Result<bool> attend();
  void close() noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  // But for what is known from `open` on the same in every state.
  [[nodiscard]] virtual DisplayCapabilities capabilities() const noexcept = 0;

 private:
  virtual Result<void> openDisplay(const DisplayConfig& config) = 0;
  virtual Result<DisplaySurface> startFrame() = 0;
  virtual Result<Duration> showFrame() = 0;
  virtual Result<bool> attendScreen() { return false; }
  virtual void closeDisplay() noexcept = 0;

  State state_ = State::Closed;
};

}  // namespace relievo
