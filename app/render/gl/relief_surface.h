// SPDX-License-Identifier: Apache-2.0
// The relief's few triangles on the GPU, with the colour picture on them.
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

// A picture on a surface: colour from `picture` at `picture_at`, which the vertex shader gives.
extern const char* const kPictureFragmentShader;

class ReliefSurface {
 public:
  [[nodiscard]] static Result<ReliefSurface> create();

  void upload(const ReliefTriangles& triangles);
  // Without depth: the picture's rectangle, flat.
  void uploadFlat(const DisplayVolume& volume, double z_mm);
  // What was uploaded last, with the colour texture that is bound to `picture_unit`.
  void draw(const glm::mat4& view_projection, GLuint picture_unit) const;

 private:
  void replace(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices);

  GlProgram program_;
  GlVertexArray attributes_;
  GlBuffer vertices_, indices_;
  GLsizei index_count_ = 0;
};

}  // namespace relievo
