// SPDX-License-Identifier: Apache-2.0
// Text on a dark panel at the foot of the picture, in the screen plane, so that both eyes see it at the same place.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/gl/glyphs.h"
#include "app/scene/display_volume.h"
#include "platform/error.h"

namespace relievo {

// If there is no font it stays empty and logs that once.
class TextPanel {
 public:
  [[nodiscard]] static Result<TextPanel> create();

  void setLines(const std::vector<std::string>& lines);
  void draw(const glm::dmat4& view_projection, const DisplayVolume& volume, double screen_z_mm) const;

 private:
  GlProgram program_;
  GlVertexArray no_vertices_;
  GlTexture ink_;
  std::optional<Glyphs> glyphs_;
  std::vector<std::string> lines_;
  int width_ = 0, height_ = 0;  // pixels
};

}  // namespace relievo
