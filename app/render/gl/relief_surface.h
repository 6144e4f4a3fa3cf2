// SPDX-License-Identifier: Apache-2.0
// The relief's triangles on the GPU, textured with the colour picture.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <span>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/relief/relief_triangles.h"
#include "app/scene/display_volume.h"
#include "platform/error.h"

namespace relievo {

// Fragment shader of a textured surface: colour from `picture` at `picture_at`, a varying of the vertex shader.
extern const char* const kPictureFragmentShader;

class ReliefSurface {
 public:
  [[nodiscard]] static Result<ReliefSurface> create();

  void upload(const ReliefTriangles& triangles);
  // Without depth: the picture's flat rectangle.
  void uploadFlat(const DisplayVolume& volume, double z_mm);
  // True if the last upload was flat.
  [[nodiscard]] bool isFlat() const noexcept { return flat_; }
  // Draws the last upload with the colour texture bound to `picture_unit`.
  void draw(const glm::mat4& view_projection, GLuint picture_unit) const;

 private:
  void replace(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices);

  GlProgram program_;
  GlVertexArray attributes_;
  GlBuffer vertices_, indices_;
  GLsizei index_count_ = 0;
  bool flat_ = false;
};

}  // namespace relievo
