// SPDX-License-Identifier: Apache-2.0
// The depth grid as a mesh that the GPU displaces from the raw depth codes, with the colour picture on it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "app/render/gl_objects.h"
#include "app/render/gl_program.h"
#include "app/render/plane_texture.h"
#include "app/scene/depth_calibration.h"
#include "app/scene/display_volume.h"
#include "hal/frame.h"
#include "platform/error.h"

namespace relievo {

// The same surface that HeightField tells: vertices on true samples at their place in the volume, cells split from
// (c, r) to (c + 1, r + 1), holes left open. It is one piece, as it is to the finger: at a jump of depth a steep wall
// joins both sides.
class ReliefMesh {
 public:
  [[nodiscard]] static Result<ReliefMesh> create();

  // Uploads the codes as they are. Unsupported where HeightField says so, and nothing has changed then.
  [[nodiscard]] Result<void> setDepth(const Frame& depth, const DepthCalibration& calibration,
                                      const DisplayVolume& volume);

  [[nodiscard]] int cols() const noexcept { return cols_; }
  [[nodiscard]] int rows() const noexcept { return rows_; }

  // Draws with every `step`-th sample, colour from `picture_unit`. `red_from`: the weights of the colour's red, green
  // and blue in the red that is drawn.
  void draw(const glm::mat4& view_projection, int step, GLuint picture_unit, const glm::vec3& red_from) const;
  // Without depth: the picture as one rectangle at this height.
  void drawFlat(const glm::mat4& view_projection, const DisplayVolume& volume, double z_mm, GLuint picture_unit,
                const glm::vec3& red_from) const;

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
  GridMapping grid_;
  int cols_ = 0;
  int rows_ = 0;
};

}  // namespace relievo
