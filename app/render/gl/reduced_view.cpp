// SPDX-License-Identifier: Apache-2.0
// A framebuffer, and a blit with linear filtering.
#include "app/render/gl/reduced_view.h"

namespace relievo {
namespace {

constexpr GLuint kUnit = 4;  // the mixer's, which binds its own whenever it mixes

GlTexture attach(GLenum attachment, GLenum format, int width, int height) {
  auto texture = gl::generate<GlTexture>(glGenTextures);
  glActiveTexture(GL_TEXTURE0 + kUnit);
  glBindTexture(GL_TEXTURE_2D, texture.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.get(), 0);
  return texture;
}

}  // namespace

Result<void> ReducedView::bind(int width, int height) {
  if (width != width_ || height != height_) allocate(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    width_ = 0;
    return fail(ErrorCode::Exhausted,
                "the GL driver has no memory for a smaller picture; choose a smaller screen mode");
  }
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  return {};
}

void ReducedView::allocate(int width, int height) {
  framebuffer_ = gl::generate<GlFramebuffer>(glGenFramebuffers);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  color_ = attach(GL_COLOR_ATTACHMENT0, GL_RGBA8, width, height);
  depth_ = attach(GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, width, height);
  width_ = width;
  height_ = height;
}

void ReducedView::showOn(GLuint framebuffer, const PixelArea& area) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.get());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBlitFramebuffer(0, 0, width_, height_, area.x, area.y, area.x + area.width, area.y + area.height,
                    GL_COLOR_BUFFER_BIT, GL_LINEAR);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

}  // namespace relievo
