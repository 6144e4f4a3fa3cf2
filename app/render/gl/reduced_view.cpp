// SPDX-License-Identifier: Apache-2.0
// A framebuffer, and a rectangle that shows it with linear filtering.
#include "app/render/gl/reduced_view.h"

#include <utility>

namespace relievo {
namespace {

constexpr GLuint kUnit = 4;  // the mixer's, which binds its own whenever it mixes

constexpr const char* kVertexShader = R"(
out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);
}
)";

// Cheaper where GL draws on the CPU than a blit, which computes a level of detail.
constexpr const char* kFragmentShader = R"(
precision mediump float;
in highp vec2 at;
uniform sampler2D view;
out vec4 color;
void main() { color = textureLod(view, at, 0.0); }
)";

GlTexture attach(GLenum attachment, GLenum format, int width, int height) {
  auto texture = gl::generate<GlTexture>(glGenTextures);
  glActiveTexture(GL_TEXTURE0 + kUnit);
  glBindTexture(GL_TEXTURE_2D, texture.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture.get(), 0);
  return texture;
}

}  // namespace

Result<ReducedView> ReducedView::create() {
  ReducedView view;
  auto program = GlProgram::create("", kVertexShader, kFragmentShader);
  if (!program) return std::unexpected(program.error());
  view.program_ = std::move(*program);
  view.no_vertices_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  return view;
}

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
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(area.x, area.y, area.width, area.height);
  glDisable(GL_DEPTH_TEST);
  glActiveTexture(GL_TEXTURE0 + kUnit);
  glBindTexture(GL_TEXTURE_2D, color_.get());
  program_.use();
  glUniform1i(program_.uniform("view"), static_cast<GLint>(kUnit));
  glBindVertexArray(no_vertices_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace relievo
