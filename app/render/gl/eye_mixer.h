// SPDX-License-Identifier: Apache-2.0
// Two eyes' pictures mixed into one: line by line, column by column, or in the colours of red-cyan glasses.
#pragma once

#include <array>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/relief/stereo.h"
#include "platform/error.h"

namespace relievo {

// GL context's thread. Holds two pictures of the surface's size, once a mixed layout is drawn.
class EyeMixer {
 public:
  static constexpr int kEyes = 2;

  [[nodiscard]] static Result<EyeMixer> create();

  // Binds the framebuffer of an eye, 0 or 1, of this size; what is drawn next is its picture.
  [[nodiscard]] Result<void> bindEye(std::size_t eye, int width, int height);
  // Both, into the framebuffer that is bound. A mixed layout.
  void mix(const StereoSettings& settings) const;

 private:
  void allocate(int width, int height);

  struct Target {
    GlTexture color;
    GlTexture depth;
    GlFramebuffer framebuffer;
  };
  GlProgram program_;
  GlVertexArray no_vertices_;
  std::array<Target, kEyes> eyes_;
  int width_ = 0, height_ = 0;
};

}  // namespace relievo
