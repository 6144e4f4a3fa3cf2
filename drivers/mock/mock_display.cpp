// SPDX-License-Identifier: Apache-2.0
// A virtual screen with a refresh rate.
#include "drivers/mock/mock.h"

namespace relievo {
namespace {

class MockDisplay final : public Display {
 public:
  MockDisplay(const MockDisplayProfile& profile, Clock& clock, std::shared_ptr<MockDisplayBench> bench)
      : profile_(profile), clock_(clock), bench_(bench ? std::move(bench) : std::make_shared<MockDisplayBench>()) {}

  [[nodiscard]] DisplayCapabilities capabilities() const noexcept override {
    return {.name = "mock", .gles = false, .refresh_period = profile_.refresh_period, .stereo = profile_.stereo};
  }

 private:
  Result<void> openDisplay(const DisplayConfig& config) override {
    if (profile_.fail_open && opens_++ < profile_.failing_opens)
      return fail(*profile_.fail_open, "the mock display was told not to open");
    if (bench_->unplugged) return fail(ErrorCode::NotFound, "the mock screen is unplugged");
    StereoSignal stereo = config.stereo;
    if (!profile_.stereo.has(stereo)) stereo = config.other_stereo ? profile_.stereo.best() : StereoSignal::None;
    surface_ = {.framebuffer = 0, .width = config.width, .height = config.height, .stereo = stereo};
    if (stereo == StereoSignal::FramePacking) pack(surface_);
    first_refresh_ = clock_.now();
    frames_ = 0;
    return {};
  }

  Result<DisplaySurface> startFrame() override {
    if (lost()) return fail(ErrorCode::Lost, "the mock screen has gone");
    return surface_;
  }

  Result<Duration> showFrame() override {
    if (lost()) return fail(ErrorCode::Lost, "the mock screen has gone");
    ++frames_;
    const Duration waited = waitForRefresh();
    if (profile_.shown) profile_.shown();
    return waited;
  }

  Duration waitForRefresh() {
    if (profile_.refresh_period <= Duration(0)) return Duration(0);
    const MonotonicTime now = clock_.now();
    const auto refreshes = (now - first_refresh_) / profile_.refresh_period;
    const MonotonicTime next = first_refresh_ + (refreshes + 1) * profile_.refresh_period;
    clock_.sleepUntil(next);
    return next - now;
  }

  Result<bool> attendScreen() override {
    if (lost()) return fail(ErrorCode::Lost, "the mock screen has gone");
    if (frames_ >= profile_.close_after_frames) return fail(ErrorCode::Cancelled, "the viewer closed the mock screen");
    return false;
  }

  void closeDisplay() noexcept override {}

  // As HDMI packs 720 rows.
  static void pack(DisplaySurface& surface) noexcept {
    surface.width = 1280;
    surface.height = 1470;
    surface.eye_gap_rows = 30;
  }

  std::vector<std::string> droppedOnIt() override {
    return profile_.dropped ? profile_.dropped() : std::vector<std::string>();
  }
  void nameFilm(const AnnouncedFilm& film) override {
    if (profile_.announced) profile_.announced(film);
  }
  void setFullScreen(FullScreen wish) override {
    if (profile_.filled) profile_.filled(wish);
  }

  [[nodiscard]] bool lost() const noexcept { return frames_ >= profile_.lose_after_frames || bench_->unplugged; }

  MockDisplayProfile profile_;
  Clock& clock_;
  std::shared_ptr<MockDisplayBench> bench_;
  DisplaySurface surface_;
  MonotonicTime first_refresh_;
  std::uint64_t frames_ = 0, opens_ = 0;
};

}  // namespace

std::unique_ptr<Display> makeMockDisplay(const MockDisplayProfile& profile, Clock& clock,
                                         std::shared_ptr<MockDisplayBench> bench) {
  return std::make_unique<MockDisplay>(profile, clock, std::move(bench));
}

}  // namespace relievo
