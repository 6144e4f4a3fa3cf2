// SPDX-License-Identifier: Apache-2.0
// Draws a colour picture as the relief that its depth picture tells, for every eye, with the finger and a text in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/render/relief/stereo.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/display.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

struct FingerMark {
  glm::dvec3 position_mm{0};  // where the sphere is drawn: the proxy, scene frame
  glm::dvec3 force_n{0};      // drawn as an arrow, 5 mm per N
  bool contact = false;
};

struct RenderStatistics {
  std::uint64_t frames = 0;
  std::size_t triangles = 0;  // of the relief as it is drawn now, silhouettes and all; 0 without depth
  std::size_t cut_cells = 0;  // at silhouettes
  bool imported = false;  // the colour picture's planes are read where the decoder wrote them (dma-buf), not uploaded
  double error_px = 0;    // that now holds
  double mesh_ms = 0;     // making those triangles of one picture, smoothed
  double frame_ms = 0;    // drawing one frame, all views, smoothed; with the triangles
};

// All verbs, and the end of it, on the thread of the display's GL context, between its beginFrame and present: GL
// names die with the display's context, so the renderer goes before the display closes.
class SceneRenderer {
 public:
  static constexpr double kErrorPx = 0.5;  // unless setError says otherwise

  // `frame_budget`: how long drawing one frame may take; the relief gets coarser until it holds, and finer again when
  // there is room.
  [[nodiscard]] static Result<std::unique_ptr<SceneRenderer>> create(Duration frame_budget);
  ~SceneRenderer();

  // A layout that the surface refuses is drawn as mono.
  void setStereo(const StereoSettings& settings) noexcept;
  // By how much the shift between the eyes may be off for the sake of fewer triangles; the frame budget may ask for
  // more. Before the frame that it is for.
  void setError(double pixels) noexcept;
  // Shown at the picture's foot from now on, in the screen plane; no lines: nothing is. In the context.
  void setText(const std::vector<std::string>& lines);

  // Uploads a pair; of the depth a reference is kept until the next one. An empty depth shows the colour as a flat
  // picture in the screen plane, the same for both eyes. Unsupported for a pixel format that cannot be uploaded; the
  // pair before stays then. `calibration` and `volume` as the haptic side uses them.
  [[nodiscard]] Result<void> setFrame(const Frame& color, const Frame& depth, const DepthCalibration& calibration,
                                      const DisplayVolume& volume);
  // Draws the last pair set into `surface`; black when none was set. Blocking: waits until it is drawn, which is how
  // the time is known.
  [[nodiscard]] Result<void> draw(const DisplaySurface& surface, const std::optional<FingerMark>& finger);
  [[nodiscard]] RenderStatistics statistics() const noexcept;

 private:
  struct Impl;
  explicit SceneRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace relievo
