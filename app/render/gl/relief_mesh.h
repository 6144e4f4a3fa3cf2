// SPDX-License-Identifier: Apache-2.0
// The depth grid as a mesh that the GPU displaces from the raw depth codes, with the colour picture on it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/gl/plane_texture.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

struct PictureView {
  glm::mat4 view_projection{1};
  double screen_z_mm = 0;
  GLuint picture_unit = 0;  // where the colour texture is bound
};

// A picture on a surface: colour from `picture` at `picture_at`, which the vertex shader gives.
extern const char* const kPictureFragmentShader;

// The uniform grid, every sample or every `step`-th: what the irregular network is measured against, and the flat
// picture of a film without depth. The same surface that HeightField tells: vertices on true samples at their place in
// the volume, cells split from (c, r) to (c + 1, r + 1), holes left open. It is one piece, as it is to the finger: at a
// jump of depth a steep wall joins both sides. For the eye alone it is joined to a frame, the picture's rectangle in
// the screen plane, so that no gap is seen beside it.
class ReliefMesh {
 public:
  // Samples 0, step, 2 step, .. and the last one.
  [[nodiscard]] static int verticesAlong(int samples, int step) noexcept { return (samples - 2 + step) / step + 1; }

  [[nodiscard]] static Result<ReliefMesh> create();

  // Uploads the codes as they are. Unsupported where HeightField says so, and nothing has changed then.
  [[nodiscard]] Result<void> setDepth(const Frame& depth, const DepthCalibration& calibration,
                                      const DisplayVolume& volume);

  [[nodiscard]] int cols() const noexcept { return cols_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }

  // Draws every `step`-th sample and the last one of each row and column.
  void draw(const PictureView& view, int step) const;
  // Without depth: the picture in its frame, flat.
  void drawFlat(const PictureView& view, const DisplayVolume& volume) const;

 private:
  // The numbers of HeightField, for the shader.
  struct Decoding {
    GLint channel = 0, shift = 0;
    GLuint mask = 0xff, invalid = ~0u;
    std::array<GLint, 3> hue_channels{0, 1, 2};
    float s_scale = 1, s_offset = 0;
    bool inverse = false;
    float near_inverse = 0, far_inverse = 0, far_mm = 0, depth_per_mm = 0, depth_mm = 0;
  };
  static Decoding decodingOf(const Frame& depth, const DepthCalibration& calibration, const DisplayVolume& volume);
  void setDecoding(const GlProgram& program) const;

  GlProgram luma_program_, hue_program_, flat_program_;
  GlVertexArray tile_;
  GlBuffer tile_indices_;
  PlaneTexture codes_;
  bool hue_ = false;
  Decoding decoding_;
  DisplayVolume volume_;
  GridMapping grid_;
  int cols_ = 0;
  int rows_ = 0;
};

}  // namespace relievo
