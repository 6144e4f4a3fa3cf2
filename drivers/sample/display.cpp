// SPDX-License-Identifier: Apache-2.0
// Display: a surface that nobody sees. With GL, `openDisplay` makes a GLES 3 context current on its thread, and
// capabilities say so; without it the player draws nothing, but everything else runs.
#include "drivers/sample/sample.h"

namespace relievo {
namespace {

class SampleDisplay final : public Display {
 public:
  // 0: no refresh that `present` would wait for. A screen tells its own, from `open` on.
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept override {
    return {.name = "sample", .gles = false, .refresh_period = Duration(0), .stereo = {}};
  }

 private:
  // The size is a wish: a screen takes the nearest that it can, and the surface tells.
  Result<void> openDisplay(const DisplayConfig& config) override {
    if (config.stereo == StereoSignal::FramePacking) {
      return fail(ErrorCode::Unsupported, "the sample's screen is flat; take another --stereo");
    }
    surface_ = {.framebuffer = 0, .width = config.width, .height = config.height};
    return {};
  }

  // Lost from here on when the screen has gone.
  Result<DisplaySurface> startFrame() override { return surface_; }
  // How long after the call the picture is on the screen: at most one refresh.
  Result<Duration> showFrame() override { return Duration(0); }
  // A window has its events here: true to have the last frame drawn anew, Cancelled when the viewer has closed it.
  Result<bool> attendScreen() override { return false; }
  void closeDisplay() noexcept override {}

  DisplaySurface surface_;
};

}  // namespace

std::unique_ptr<Display> makeSampleDisplay() {
  return std::make_unique<SampleDisplay>();
}

}  // namespace relievo
