// SPDX-License-Identifier: Apache-2.0
#include "app/render/gl/color_converter.h"

#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "app/render/gl/color_shader.h"

namespace relievo {

Result<void> ColorConverter::prepare(const std::string& defines) {
  if (defines_ == defines) return {};
  auto program = GlProgram::create(defines, kColorVertexShader, kColorFragmentShader);
  if (!program) return std::unexpected(program.error());
  program_ = std::move(*program);
  defines_ = defines;
  return {};
}

void ColorConverter::allocate(glm::ivec2 size) {
  size_ = size;
  target_ = gl::generate<GlTexture>(glGenTextures);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, target_.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, size.x, size.y);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  if (framebuffer_.get() == 0) {
    framebuffer_ = gl::generate<GlFramebuffer>(glGenFramebuffers);
    no_vertices_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target_.get(), 0);
}

void ColorConverter::convert(const std::array<PlaneTexture, 3>& planes, const ColorUniforms& colors, glm::ivec2 size,
                             bool as_it_is) {
  if (size != size_) allocate(size);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glViewport(0, 0, size.x, size.y);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  program_.use();
  glUniform2fv(program_.uniform("chroma_scale"), 1, glm::value_ptr(colors.chroma_scale));
  glUniformMatrix4x3fv(program_.uniform("to_rgb"), 1, GL_FALSE, glm::value_ptr(colors.to_rgb));
  glUniform3fv(program_.uniform("bias"), 1, glm::value_ptr(colors.bias));
  constexpr std::array<const char*, 3> kPlanes{"plane0", "plane1", "plane2"};
  for (GLuint unit = 0; unit < kPlanes.size(); ++unit) {
    planes[unit].bind(unit);
    const GLint filter = unit == 0 && as_it_is ? GL_NEAREST : GL_LINEAR;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glUniform1i(program_.uniform(kPlanes[unit]), static_cast<GLint>(unit));
  }
  glBindVertexArray(no_vertices_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glFlush();  // starts the conversion while the CPU computes the relief
}

}  // namespace relievo
