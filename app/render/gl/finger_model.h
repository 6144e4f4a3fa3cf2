// SPDX-License-Identifier: Apache-2.0
// The finger in the picture: a sphere at its position and an arrow for the force on it.
#pragma once

#include <glm/mat4x4.hpp>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "platform/error.h"

namespace relievo {

struct FingerMark;

class FingerModel {
 public:
  static constexpr double kRadiusMm = 2.5;
  static constexpr double kArrowMmPerN = 5.0;

  [[nodiscard]] static Result<FingerModel> create();

  // Tested against the relief's depth buffer: opaque in front of it, faint behind it, so that the finger is always
  // visible. The arrow starts on the sphere and is 5 mm long per N.
  void draw(const glm::dmat4& view_projection, const FingerMark& mark) const;

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
