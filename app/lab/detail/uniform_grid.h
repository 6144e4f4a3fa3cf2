// SPDX-License-Identifier: Apache-2.0
// The depth picture as a uniform grid of triangles with the colour picture on it, both eyes side by side: what the
// player's irregular network is measured against.
#pragma once

#include "app/render/gl/color_picture.h"
#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/gl/plane_texture.h"
#include "app/render/relief/stereo.h"
#include "app/scene/display_volume.h"
#include "hal/display.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// The GPU displaces the vertices by the codes: each stands on a sample at its place in the volume, and cells are split
// from (c, r) to (c + 1, r + 1). The grid is one piece, as the finger feels it: at a jump of depth a steep wall joins
// both sides. Only for the eye, it is joined to a frame, the picture's rectangle in the screen plane, so that no gap is
// seen beside it. Use on the thread of the display's GL context.
class UniformGrid {
 public:
  // Samples 0, step, 2 step, .. and the last one.
  [[nodiscard]] static int verticesAlong(int samples, int step) noexcept { return (samples - 2 + step) / step + 1; }

  [[nodiscard]] static Result<UniformGrid> create();

  // Uploads a pair. The depth must be 8 bits as DepthCalibration{} reads them, else Unsupported. Holes are not
  // recognised.
  [[nodiscard]] Result<void> setFrame(const Frame& color, const Frame& depth, const DisplayVolume& volume);
  // Draws the pair, and waits until it is drawn, on every `step`-th sample and the last one of each row and column.
  [[nodiscard]] Result<void> draw(const DisplaySurface& surface, const StereoSettings& stereo, int step);
  [[nodiscard]] std::size_t triangles(int step) const noexcept;

 private:
  void setGrid(int step) const;
  void drawView(const EyeView& view, int tiles) const;

  GlProgram program_;
  GlVertexArray tile_;
  GlBuffer tile_indices_;
  ColorPicture picture_;
  PlaneTexture codes_;
  DisplayVolume volume_;
  int cols_ = 0, rows_ = 0;
};

}  // namespace relievo
