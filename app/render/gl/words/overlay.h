// SPDX-License-Identifier: Apache-2.0
// Pictures of text blended over a view.
#pragma once

#include <vector>

#include "app/render/gl/gl_objects.h"
#include "app/render/gl/gl_program.h"
#include "app/render/text/text_picture.h"
#include "platform/error.h"

namespace relievo {

class Overlay {
 public:
  [[nodiscard]] static Result<Overlay> create();

  // Shown from now on; `frame`: the view that they were drawn for. Those larger than a texture are left out.
  void set(const TextFrame& frame, const std::vector<TextPicture>& pictures);
  // Instead: a clear spot, so that drawing it makes the driver compile what it needs for words.
  void setUnseen(const TextFrame& frame);
  // Into the viewport that is set, `shift_px` of the frame to the right.
  void draw(double shift_px) const;
  [[nodiscard]] const TextFrame& frame() const noexcept { return frame_; }

 private:
  struct Part {
    GlTexture texture;
    int x = 0, y = 0, width = 0, height = 0;
  };
  GlProgram program_;
  GlVertexArray no_vertices_;
  TextFrame frame_;
  std::vector<Part> parts_;
};

}  // namespace relievo
