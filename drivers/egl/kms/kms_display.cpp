// SPDX-License-Identifier: Apache-2.0
// The display on a whole screen by the kernel's mode setting; no desktop may run on the same card.
#include <GLES3/gl3.h>

#include <optional>
#include <utility>

#include "drivers/egl/egl.h"
#include "drivers/egl/egl_context.h"
#include "drivers/egl/kms/kms_buffers.h"
#include "drivers/egl/kms/kms_mode.h"
#include "drivers/egl/kms/kms_screen.h"

namespace relievo {
namespace {

constexpr Duration kBetweenLooks = std::chrono::seconds(1);       // between checks whether the screen is connected
constexpr Duration kFlipMargin = std::chrono::milliseconds(100);  // beyond the two refreshes that a flip may take
constexpr const char* kNoScreen = "no screen is connected, or it is off; checking again every second";

// A card and one of its connected screens.
struct Found {
  UniqueFd card;
  kms::Connector connector;
};

Result<Found> findScreen(const std::string& wanted_path) {
  const auto paths = wanted_path.empty() ? kms::cardPaths() : std::vector{wanted_path};
  Error why{ErrorCode::Unsupported, 0, "this machine has no display card (/dev/dri/card*); use another --display"};
  for (const std::string& path : paths) {
    auto card = kms::openCard(path);
    if (!card) {
      if (why.code != ErrorCode::NotFound) why = card.error();
      continue;
    }
    for (kms::Connector& connector : kms::readConnectors(card->get(), true)) {
      if (connector.connected) return Found{std::move(*card), std::move(connector)};
    }
    why = {ErrorCode::NotFound, 0, kNoScreen};
  }
  return std::unexpected(why);
}

class KmsDisplay final : public Display {
 public:
  explicit KmsDisplay(std::string path) : path_(std::move(path)) {}
  ~KmsDisplay() override { close(); }

  [[nodiscard]] DisplayCapabilities capabilities() const noexcept override {
    return {.name = "kms", .gles = true, .refresh_period = refresh_period_, .stereo = stereo_signals_};
  }
  [[nodiscard]] std::string description() const override { return description_; }

 private:
  Result<void> openDisplay(const DisplayConfig& config) override;
  Result<DisplaySurface> startFrame() override;
  Result<Duration> showFrame() override;
  Result<bool> attendScreen() override;
  void closeDisplay() noexcept override;

  Result<kms::Connector> findConnector();
  Result<void> chooseMode(const kms::Connector& connector, DisplayConfig config);
  [[nodiscard]] Duration untilRefresh() const noexcept;

  const std::string path_;  // empty: the first card that has a screen
  // The card and its GL stay open when screens come and go.
  UniqueFd card_;
  std::unique_ptr<kms::CardGl> gl_;
  kms::Packing packing_ = kms::Packing::Tall;

  MonotonicClock clock_;  // the clock of the kernel's flip events
  std::unique_ptr<kms::Screen> screen_;
  std::unique_ptr<kms::Buffers> buffers_;
  std::optional<EglContext> context_;
  drmModeModeInfo mode_{};
  bool mode_is_set_ = false;
  DisplaySurface surface_;
  Duration refresh_period_{0};
  StereoSignals stereo_signals_;
  std::string description_;
  MonotonicTime next_look_;
};

Result<void> KmsDisplay::openDisplay(const DisplayConfig& config) {
  const auto connector = findConnector();
  if (!connector) return std::unexpected(connector.error());
  if (auto chosen = chooseMode(*connector, config); !chosen) return chosen;
  auto screen = kms::Screen::take(card_.get(), connector->id);
  if (!screen) return std::unexpected(screen.error());
  screen_ = std::move(*screen);

  auto context = EglContext::createForWindows(gl_->display(), static_cast<EGLint>(kms::kPixelFormat));
  if (!context) return std::unexpected(context.error());
  context_.emplace(std::move(*context));
  auto buffers = kms::Buffers::make(*gl_, context_->config(), surface_.width, surface_.height);
  if (!buffers) return std::unexpected(buffers.error());
  buffers_ = std::move(*buffers);
  next_look_ = clock_.now() + kBetweenLooks;
  return context_->makeCurrent(buffers_->surface());
}

// Finds a connected screen on the open card, else on another card.
Result<kms::Connector> KmsDisplay::findConnector() {
  if (card_.valid()) {
    for (kms::Connector& connector : kms::readConnectors(card_.get(), true)) {
      if (connector.connected) return std::move(connector);
    }
  }
  auto found = findScreen(path_);
  if (!found) return std::unexpected(found.error());
  auto gl = kms::CardGl::start(found->card.get());
  if (!gl) return std::unexpected(gl.error());
  gl_ = std::move(*gl);  // the old one ends before its card closes
  card_ = std::move(found->card);
  packing_ = kms::packingOf(kms::driverOf(card_.get()));
  return std::move(found->connector);
}

Result<void> KmsDisplay::chooseMode(const kms::Connector& connector, DisplayConfig config) {
  stereo_signals_ = kms::stereoSignals(connector.modes);
  if (!stereo_signals_.has(config.stereo)) {
    if (config.stereo == StereoSignal::FramePacking && !config.other_stereo) {
      return fail(ErrorCode::Unsupported,
                  "the screen does not support frame packing; use --stereo sbs, or see relievo devices");
    }
    config.stereo = config.other_stereo ? stereo_signals_.best() : StereoSignal::None;
  }
  const drmModeModeInfo* mode = kms::chooseMode(connector.modes, config);
  if (mode == nullptr) return fail(ErrorCode::Unsupported, "the screen has only interlaced modes; use another screen");
  mode_ = *mode;
  refresh_period_ = kms::refreshPeriod(mode_);
  description_ = connector.name + ", " + kms::wordsOf(mode_, packing_);
  const kms::ScanOut size = kms::scanOut(mode_, packing_);
  surface_ = {.framebuffer = 0,
              .width = size.width,
              .height = size.height,
              .stereo = kms::stereoOf(mode_),
              .eye_gap_rows = size.eye_gap_rows};
  return {};
}

Result<DisplaySurface> KmsDisplay::startFrame() {
  if (auto current = context_->makeCurrent(buffers_->surface()); !current) return std::unexpected(current.error());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return surface_;
}

// glFinish comes before the flip, since the kernel cannot wait for a software GL driver. It costs nothing: the renderer
// has waited for GL already.
Result<Duration> KmsDisplay::showFrame() {
  if (auto current = context_->makeCurrent(buffers_->surface()); !current) return std::unexpected(current.error());
  if (mode_is_set_) {
    if (auto done = screen_->finishFlip(2 * refresh_period_ + kFlipMargin); !done) return std::unexpected(done.error());
    buffers_->shown();
  }
  glFinish();
  const auto framebuffer = buffers_->swap();
  if (!framebuffer) return std::unexpected(framebuffer.error());
  if (mode_is_set_) {
    if (auto flipped = screen_->flip(*framebuffer); !flipped) return std::unexpected(flipped.error());
    return untilRefresh();
  }
  if (auto set = screen_->setMode(mode_, packing_, *framebuffer); !set) return std::unexpected(set.error());
  mode_is_set_ = true;
  return Duration(0);
}

Duration KmsDisplay::untilRefresh() const noexcept {
  if (refresh_period_ <= Duration(0)) return Duration(0);
  const Duration since = clock_.now() - screen_->lastFlip();
  return refresh_period_ - since % refresh_period_;
}

// The kernel tracks whether the screen is connected; reading that is cheap.
Result<bool> KmsDisplay::attendScreen() {
  const MonotonicTime now = clock_.now();
  if (now < next_look_) return false;
  next_look_ = now + kBetweenLooks;
  if (screen_->connected()) return false;
  return fail(ErrorCode::Lost, kNoScreen);
}

// The screen must be destroyed before the buffers that it shows.
void KmsDisplay::closeDisplay() noexcept {
  screen_.reset();
  context_.reset();
  buffers_.reset();
  mode_is_set_ = false;
}

}  // namespace

std::unique_ptr<Display> makeKmsDisplay(std::string path) {
  return std::make_unique<KmsDisplay>(std::move(path));
}

}  // namespace relievo
