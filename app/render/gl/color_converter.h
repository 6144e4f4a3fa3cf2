// SPDX-License-Identifier: Apache-2.0
// Draws the planes of a colour picture into one RGBA texture, on the GPU.
#pragma once

#include <array>
#include <glm/mat4x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/gl/plane_texture.h"
#include "platform/error.h"

namespace relievo {

// Colour conversion in the shader: rgb = to_rgb x sample + bias, for the four numbers that it samples.
struct ColorUniforms {
  glm::mat4x3 to_rgb{0};
  glm::vec3 bias{0};
  glm::vec2 chroma_scale{1};  // chroma coordinates relative to luma's
};

class ColorConverter {
 public:
  // Compiles the program for planes of this layout, unless it is compiled already. `defines` has the SAMPLE of
  // color_shader.h.
  [[nodiscard]] Result<void> prepare(const std::string& defines);
  // Needs a prepared program. `as_it_is`: one pixel for each luma sample. Changes the framebuffer, the viewport and the
  // bindings of the first texture units.
  void convert(const std::array<PlaneTexture, 3>& planes, const ColorUniforms& colors, glm::ivec2 size, bool as_it_is);
  // The size of the converted picture; 0 before the first.
  [[nodiscard]] glm::ivec2 size() const noexcept { return size_; }
  // Binds the converted picture to the active texture unit, row 0 at the top.
  void bind() const noexcept { glBindTexture(GL_TEXTURE_2D, target_.get()); }

 private:
  void allocate(glm::ivec2 size);

  std::string defines_;  // of the program
  GlProgram program_;
  GlVertexArray no_vertices_;
  GlTexture target_;
  GlFramebuffer framebuffer_;
  glm::ivec2 size_{0};
};

}  // namespace relievo
