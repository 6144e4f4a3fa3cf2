// SPDX-License-Identifier: Apache-2.0
// A finger in the picture: a sphere at its position and an arrow for the force on it.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "platform/error.h"

namespace relievo {

struct FingerMark;

// The colours of the sphere and the arrow, away from the surface and on it, and of the glow on the surface.
struct FingerPaint {
  glm::vec3 free, contact, glow;
};
// Amber for the first finger, blue for the second.
inline constexpr std::array<FingerPaint, 2> kFingerPaints{
    {{{0.62F, 0.70F, 0.78F}, {1.0F, 0.72F, 0.15F}, {1.0F, 0.78F, 0.35F}},
     {{0.40F, 0.72F, 0.76F}, {0.20F, 0.70F, 1.0F}, {0.35F, 0.78F, 1.0F}}}};

class FingerModel {
 public:
  static constexpr double kRadiusMm = 2.5;
  static constexpr double kArrowMmPerN = 5.0;

  [[nodiscard]] static Result<FingerModel> create();

  // Tested against the relief's depth buffer: opaque in front of it, faint behind it, so that the finger is always
  // visible. The arrow starts on the sphere and is 5 mm long per N.
  void draw(const glm::dmat4& view_projection, const FingerMark& mark, const FingerPaint& paint) const;

 private:
  struct Range {
    GLint first;
    GLsizei count;
  };
  void drawParts(const glm::dmat4& view_projection, const FingerMark& mark) const;
  void drawPart(const Range& part, const glm::dmat4& model, const glm::dmat4& view_projection) const;

  GlProgram program_;
  GlVertexArray vertices_;
  GlBuffer buffer_;
  Range sphere_{}, shaft_{}, head_{};
};

}  // namespace relievo
