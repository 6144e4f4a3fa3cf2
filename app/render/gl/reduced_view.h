// SPDX-License-Identifier: Apache-2.0
// Draws a view smaller than it is shown, and stretches it: for machines that cannot draw all pixels in time.
#pragma once

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/relief/stereo.h"
#include "platform/error.h"

namespace relievo {

// For the GL context's thread. Allocates a picture when a size is first drawn, another one when it changes.
class ReducedView {
 public:
  ReducedView() noexcept = default;  // unusable until assigned
  [[nodiscard]] static Result<ReducedView> create();

  // Binds an empty framebuffer of this size for the following drawing.
  [[nodiscard]] Result<void> bind(int width, int height);
  // Stretches the drawn picture over `area` of `framebuffer`, and binds that.
  void showOn(GLuint framebuffer, const PixelArea& area) const;

 private:
  void allocate(int width, int height);

  GlProgram program_;
  GlVertexArray no_vertices_;
  GlTexture color_, depth_;
  GlFramebuffer framebuffer_;
  int width_ = 0, height_ = 0;
};

}  // namespace relievo
