// SPDX-License-Identifier: Apache-2.0
// Display: an invisible surface without GL. With GL, `openDisplay` makes a GLES 3 context current on its thread and the
// capabilities say gles; without GL the player draws nothing, but everything else runs.
#include "drivers/sample/sample.h"

namespace relievo {
namespace {

class SampleDisplay final : public Display {
 public:
  // refresh_period 0: `present` does not wait for a refresh. A screen states its own, from `open` on.
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept override {
    return {.name = "sample", .gles = false, .refresh_period = Duration(0), .stereo = {}};
  }

 private:
  // The size is a request: a screen uses the nearest it has, and the surface has the actual one.
  Result<void> openDisplay(const DisplayConfig& config) override {
    if (config.stereo == StereoSignal::FramePacking && !config.other_stereo) {
      return fail(ErrorCode::Unsupported, "the sample screen has no 3D; choose another --stereo");
    }
    surface_ = {.framebuffer = 0, .width = config.width, .height = config.height};
    return {};
  }

  // A real screen returns Lost from here on if it has gone.
  Result<DisplaySurface> startFrame() override { return surface_; }
  // Returns the time from the call until the picture is on the screen: at most one refresh.
  Result<Duration> showFrame() override { return Duration(0); }
  // A window handles its events here: true to have the last frame drawn again, Cancelled if the viewer closed it.
  Result<bool> attendScreen() override { return false; }
  void closeDisplay() noexcept override {}

  DisplaySurface surface_;
};

}  // namespace

std::unique_ptr<Display> makeSampleDisplay() {
  return std::make_unique<SampleDisplay>();
}

}  // namespace relievo
