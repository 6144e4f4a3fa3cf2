// SPDX-License-Identifier: Apache-2.0
// Draws a colour picture as the relief of its depth picture, for every eye, with the fingers and text in it.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "app/render/relief/coarse_relief.h"
#include "app/render/relief/stereo.h"
#include "app/render/text/text_picture.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/display.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

struct FingerMark {
  glm::dvec3 position_mm{0};  // position of the sphere: the proxy, scene frame
  glm::dvec3 force_n{0};      // drawn as an arrow, 5 mm per N
  bool contact = false;
};
// The first finger and the second, each in colours of its own.
using FingerMarks = std::array<std::optional<FingerMark>, 2>;

struct RenderStatistics {
  std::uint64_t frames = 0;
  std::size_t triangles = 0;   // of the relief as drawn now, silhouettes included; 0 without depth
  std::size_t cut_cells = 0;   // cells cut at silhouettes
  bool imported = false;       // the colour planes are read from the decoder's memory (dma-buf), not uploaded
  double error_px = 0;         // error bound in effect, pixels
  double size = 1;             // share of a view's width and height in which it is drawn; below 1 the view is stretched
  double mesh_ms = 0;          // making the triangles of one picture; moving average
  double frame_ms = 0;         // drawing one frame with all views, making the triangles included; moving average
  double behind_words_px = 0;  // disparity of the nearest relief under the subtitles; see WordsPlace
};

// All functions, and the destructor, run on the thread of the display's GL context, between its beginFrame and present.
// GL names end with the display's context, so destroy the renderer before the display closes.
class SceneRenderer {
 public:
  static constexpr double kErrorPx = 0.5;  // default of setError

  // `frame_budget`: how long drawing one frame may take. The relief gets coarser, then the views are drawn
  // smaller, until drawing keeps within it; it gets finer again when there is time to spare (DetailLevel).
  [[nodiscard]] static Result<std::unique_ptr<SceneRenderer>> create(Duration frame_budget);
  ~SceneRenderer();

  void setFrameBudget(Duration frame_budget) noexcept;
  // If the surface cannot show the layout, mono is drawn.
  void setStereo(const StereoSettings& settings) noexcept;
  // Allowed error of the shift between the eyes, traded for fewer triangles; the frame budget may enlarge it. Call
  // before the frame it applies to.
  void setError(double pixels) noexcept;
  // Shown over the picture from now on, in the screen plane, at the same place in each view. Needs the GL context.
  void setText(const TextFrame& frame, const std::vector<TextPicture>& pictures);
  // Shown just in front of the relief behind them (WordsPlace). Needs the GL context.
  void setSubtitles(const TextFrame& frame, const std::vector<TextPicture>& pictures);
  // The next picture does not continue the last one: the subtitles need not move smoothly.
  void cut() noexcept;
  // The reliefs of the following pictures, for the subtitles; they must live until the next call.
  void setAhead(const ReliefAhead& ahead) noexcept;

  // Uploads a pair; keeps a reference to the depth until the next one. Empty depth shows the colour as a flat picture
  // in the screen plane. Unsupported if the pixel format cannot be uploaded; the previous pair then stays.
  // `calibration` and `volume` must be those of the haptic side. `right`, for a stereo film: what the right eye sees
  // instead of `color`.
  [[nodiscard]] Result<void> setFrame(const Frame& color, const Frame& depth, const DepthCalibration& calibration,
                                      const DisplayVolume& volume, const Frame& right = {});
  // Draws the last pair into `surface`, or, without a pair, the text on black. Blocks until the GPU has finished, so
  // that the time can be measured. `late`: how long after its time the pair is drawn (DetailLevel::drew).
  [[nodiscard]] Result<void> draw(const DisplaySurface& surface, const FingerMarks& fingers,
                                  std::optional<Duration> late = {});
  // Draws the last pair with a finger and text until all programs are compiled and the relief is as coarse and small as
  // the frame budget needs, so that nothing of that happens while the film plays. Ends soon after `stop` is set. Then
  // call `setText` and `draw`.
  [[nodiscard]] Result<void> rehearse(const DisplaySurface& surface, const std::atomic<bool>& stop);
  // Reads back what `draw` has drawn into `surface`, before it is presented: rows from the top, three bytes a pixel.
  [[nodiscard]] static std::vector<std::uint8_t> read(const DisplaySurface& surface);
  [[nodiscard]] RenderStatistics statistics() const noexcept;

 private:
  struct Impl;
  explicit SceneRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace relievo
