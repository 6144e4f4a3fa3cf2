// SPDX-License-Identifier: Apache-2.0
// Shadow and glow that the finger casts on the relief: a soft disc that follows the surface.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/scene/height_field.h"
#include "platform/error.h"

namespace relievo {

class SurfaceMark {
 public:
  [[nodiscard]] static Result<SurfaceMark> create();

  struct Disc {
    glm::dvec2 center_mm{0};  // x, y in the scene
    double radius_mm = 0;
    glm::vec3 color{0};
    float opacity = 1;  // at the centre
  };
  // `field` must be the relief that is in the depth buffer.
  void draw(const glm::dmat4& view_projection, const HeightField& field, const Disc& disc);

  // The height of the surface below a point; 0 outside the picture and in a hole.
  [[nodiscard]] static double heightUnder(const HeightField& field, double x_mm, double y_mm) noexcept;

 private:
  GlProgram program_;
  GlVertexArray attributes_;
  GlBuffer vertices_, indices_;
};

}  // namespace relievo
