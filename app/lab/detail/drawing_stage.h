// SPDX-License-Identifier: Apache-2.0
// The player's renderer and the uniform grid on a display of the measurement's own, and the pictures that they draw.
#pragma once

#include <memory>
#include <optional>

#include "app/lab/detail/drawn_level.h"
#include "app/lab/detail/picture_quality.h"
#include "app/lab/detail/uniform_grid.h"
#include "app/render/gl/scene_renderer.h"
#include "hal/display.h"
#include "platform/failure.h"

namespace relievo {

// Side by side, as on a 3D screen, on the default volume. Use from one thread, one stage at a time on a display.
class DrawingStage {
 public:
  // Opens `display`, which must outlive the stage and is closed with it.
  [[nodiscard]] static Outcome<std::unique_ptr<DrawingStage>> open(Display& display, int width, int height);
  ~DrawingStage();

  // Uploads a new picture and draws it at a level of detail. Returns how long both took.
  [[nodiscard]] Outcome<Duration> show(const Frame& color, const Frame& depth, const DrawnLevel& level);
  // Draws the same picture again.
  [[nodiscard]] Outcome<Duration> again();
  [[nodiscard]] DrawnPicture picture() const;
  // The number of triangles of the relief that was drawn last, including those at silhouettes (edges of things, and the
  // background that continues behind them).
  [[nodiscard]] std::size_t triangles() const {
    return level_.grid_step > 0 ? grid_->triangles(level_.grid_step) : renderer_->statistics().triangles;
  }

 private:
  explicit DrawingStage(Display& display) : display_(display) {}
  [[nodiscard]] Result<void> take(const Frame& color, const Frame& depth);
  [[nodiscard]] Result<void> draw();

  Display& display_;
  DisplaySurface surface_;
  std::unique_ptr<SceneRenderer> renderer_;
  std::optional<UniformGrid> grid_;
  DrawnLevel level_;
  MonotonicClock clock_;
};

}  // namespace relievo
