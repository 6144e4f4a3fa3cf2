// SPDX-License-Identifier: Apache-2.0
// The relief's few triangles on the GPU, with the colour picture on them.
#pragma once

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/gl/relief_mesh.h"
#include "app/render/relief/relief_triangles.h"
#include "platform/error.h"

namespace relievo {

class ReliefSurface {
 public:
  [[nodiscard]] static Result<ReliefSurface> create();

  void upload(const ReliefTriangles& triangles);
  void draw(const PictureView& view) const;

 private:
  GlProgram program_;
  GlVertexArray attributes_;
  GlBuffer vertices_, indices_;
  GLsizei index_count_ = 0;
};

}  // namespace relievo
