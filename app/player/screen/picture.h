// SPDX-License-Identifier: Apache-2.0
// Puts pairs on the screen: the display, its renderer, and the loss and return of the screen.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/player/screen/screen_words.h"
#include "app/player/screen/subtitle_words.h"
#include "app/render/gl/scene_renderer.h"
#include "app/render/relief/stereo.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/display.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

// A display without GLES draws nothing, at its own pace. A lost display is reopened once a second, while film and touch
// continue. Use on the owner's thread only, that of the GL context.
class Picture {
 public:
  enum class Shown : std::uint8_t {
    OnScreen,
    NoScreen,  // the screen is unavailable
    Lost,      // the screen has just become unavailable
    Back,      // the screen has just returned, and shows the picture
  };

  Picture(Display& display, const DisplayConfig& config, const StereoSettings& stereo) noexcept
      : display_(display), config_(config), stereo_(stereo), lenticular_(stereo.layout == StereoLayout::Quilt) {}
  ~Picture() { close(); }
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  // `stop`, which must outlive this, asks for the end: the preparations for a first picture are cut short.
  [[nodiscard]] Result<void> open(const std::atomic<bool>& stop) {
    rehearsal_.stop = &stop;
    return display_.open(config_);
  }
  void close() noexcept;

  // Call when the film is open, before its first picture. `frame_budget`: how long drawing may take.
  void setScene(const DepthCalibration& calibration, const DisplayVolume& volume, Duration frame_budget) noexcept;
  // A film begins: sets the window's title and size.
  void announce(const AnnouncedFilm& film);
  void fillScreen(FullScreen wish) { display_.fillScreen(wish); }
  [[nodiscard]] bool isFullScreen() const noexcept { return display_.isFullScreen(); }
  [[nodiscard]] std::vector<std::string> takeDropped() { return display_.takeDropped(); }
  // The pair that `show` shows from now on; a reference is kept for a screen that returns. `place`: the film's
  // position, if it is later than the picture's time. `late`: how long after its time it is shown first.
  void setPair(const FramePair& pair, MediaTime place = {}, std::optional<Duration> late = {});
  // From the next `show` on: black, with the text if there is any.
  void clear() noexcept;
  // The text over the picture from the next `show` on.
  void setText(ScreenContent content) { text_ = std::move(content); }
  [[nodiscard]] ScreenWords& words() noexcept { return words_; }
  [[nodiscard]] SubtitleWords& subtitles() noexcept { return subtitles_; }
  [[nodiscard]] const SubtitleWords& subtitles() const noexcept { return subtitles_; }
  // While the picture stands and the film goes on to `place`: true if a subtitle has begun or ended, so that the
  // picture should be drawn again.
  [[nodiscard]] bool subtitlesChange(MediaTime place);
  // The next picture does not continue this one.
  void cut() noexcept { cut_ = true; }
  // The reliefs after the present picture, for the subtitles; they must live until the next call.
  void setAhead(const ReliefAhead& ahead) noexcept { ahead_ = ahead; }
  // The next `show` keeps its picture, without the text over it, for `takeCapture`.
  struct Capture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
  };
  void capture() noexcept { capture_due_ = true; }
  [[nodiscard]] std::optional<Capture> takeCapture() noexcept { return std::exchange(captured_, std::nullopt); }
  // Fails only if no retry helps: no renderer, or a pixel format that cannot be drawn.
  [[nodiscard]] Result<Shown> show(const FingerMarks& fingers, MonotonicTime now);
  // Call often between pictures. True if the last picture should be drawn again; Lost if the screen has just become
  // unavailable (`show` then retries); Cancelled if the viewer has closed the window.
  [[nodiscard]] Result<bool> attend(MonotonicTime now);
  // Switches to the next layout that the surface supports; does nothing while a 3D signal is sent, which fixes the
  // layout.
  void nextLayout() noexcept;
  void setLayout(std::string_view word) noexcept;  // see app/player/screen/stereo_word.h
  void swapEyes() noexcept;
  void changeStrength(double by) noexcept;  // of the depth, 0 to 2
  // Moves the height in the volume that lies in the screen plane; the rest appears in front of it or behind it.
  void changeScreenPlane(double by_mm) noexcept;
  // Changes the size of the picture in its view, within 1 to 4.
  void changeZoom(double by) noexcept;
  // The width over the height that the picture is shown with; 0: its own.
  void setAspect(double aspect) noexcept;
  // After the surface has refused a layout, once: the reason. The picture is then shown in another layout.
  [[nodiscard]] const char* takeRefusal() noexcept { return std::exchange(refusal_, nullptr); }

  [[nodiscard]] bool away() const noexcept { return display_.state() == Display::State::Closed; }
  [[nodiscard]] DisplayCapabilities capabilities() const noexcept { return display_.capabilities(); }
  [[nodiscard]] std::string description() const { return display_.description(); }
  [[nodiscard]] const StereoSettings& stereo() const noexcept { return stereo_; }
  [[nodiscard]] const DisplayVolume& volume() const noexcept { return volume_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }
  // Where a point of the surface (in shares, from its top left) lies in the view that it is over, in shares of the
  // view; nullopt beside all views.
  struct ViewPoint {
    double across = 0, down = 0;
    double aspect = 1;  // of the view
  };
  [[nodiscard]] std::optional<ViewPoint> viewPoint(double across, double down) const;
  // A view, for what is written over it; without sizes as long as there was no surface.
  [[nodiscard]] TextFrame textFrame() const;
  [[nodiscard]] const RenderStatistics& statistics() const noexcept { return statistics_; }

 private:
  void lose(MonotonicTime now) noexcept;
  [[nodiscard]] Result<void> drawAndPresent(const FingerMarks& fingers);
  [[nodiscard]] Result<void> draw(const DisplaySurface& surface, const FingerMarks& fingers);
  void layOutSubtitles();
  [[nodiscard]] Result<void> captureFrom(const DisplaySurface& surface, const FingerMarks& fingers);
  [[nodiscard]] bool isBound() noexcept;
  void followSignal(const DisplaySurface& surface) noexcept;
  void fallBack(const DisplaySurface& surface) noexcept;
  void stereoChanged() noexcept;

  Display& display_;
  DisplayConfig config_;
  AnnouncedFilm film_;
  StereoSettings stereo_;
  bool lenticular_;                           // a quilt was asked for: the screen is one for it
  StereoSignal signal_ = StereoSignal::None;  // sent with the picture
  bool signal_told_ = false;                  // it was reported that this signal is not the requested one
  const char* refusal_ = nullptr;
  DepthCalibration calibration_;
  DisplayVolume volume_;
  Duration frame_budget_{0};
  std::unique_ptr<SceneRenderer> renderer_;
  struct Due {
    FramePair pair;
    MediaTime place;  // in the film: of its subtitles
    std::optional<Duration> late;
    bool uploaded = false;  // to the renderer
  };
  Due due_;  // what `show` shows
  ScreenContent text_;
  ScreenWords words_;
  SubtitleWords subtitles_;
  ReliefAhead ahead_;
  bool subtitles_changed_ = false;  // since the renderer was given them
  bool cut_ = false, capture_due_ = false;
  struct Rehearsal {
    bool due = false;  // before the first picture of a film
    const std::atomic<bool>* stop = nullptr;
  };
  Rehearsal rehearsal_;
  std::optional<Capture> captured_;
  MonotonicTime next_retry_;
  int width_ = 0, height_ = 0;
  RenderStatistics statistics_;
};

}  // namespace relievo
