// SPDX-License-Identifier: Apache-2.0
// Mixes two eyes' pictures into one: row by row, column by column, or in the colours of red-cyan glasses.
#pragma once

#include <array>
#include <cstddef>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/relief/stereo.h"
#include "platform/error.h"

namespace relievo {

// For the GL context's thread. Allocates two pictures of the surface's size when a mixed layout is first drawn.
class EyeMixer {
 public:
  static constexpr int kEyes = 2;

  [[nodiscard]] static Result<EyeMixer> create();

  // Binds the framebuffer of this size for eye 0 or 1; subsequent drawing goes into its picture.
  [[nodiscard]] Result<void> bindEye(std::size_t eye, int width, int height);
  [[nodiscard]] GLuint framebuffer(std::size_t eye) const noexcept { return eyes_[eye].framebuffer.get(); }
  // Mixes both pictures into the framebuffer that is bound. `settings` must have a mixed layout.
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
