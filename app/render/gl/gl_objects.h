// SPDX-License-Identifier: Apache-2.0
// Owners of GL names, which delete them on destruction; and the one function that reads GL's errors.
#pragma once

#include <GLES3/gl3.h>

#include <utility>

#include "platform/error.h"

namespace relievo {

// Created and destroyed on the thread of the GL context. 0 means none.
template <void (*kDelete)(GLuint)>
class GlName {
 public:
  GlName() noexcept = default;
  explicit GlName(GLuint name) noexcept : name_(name) {}
  GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
  GlName& operator=(GlName&& other) noexcept {
    if (this != &other) {
      if (name_ != 0) kDelete(name_);
      name_ = std::exchange(other.name_, 0);
    }
    return *this;
  }
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  ~GlName() {
    if (name_ != 0) kDelete(name_);
  }
  [[nodiscard]] GLuint get() const noexcept { return name_; }

 private:
  GLuint name_ = 0;
};

namespace gl {
inline void deleteTexture(GLuint name) {
  glDeleteTextures(1, &name);
}
inline void deleteBuffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
inline void deleteVertexArray(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
inline void deleteFramebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}
inline void deleteShader(GLuint name) {
  glDeleteShader(name);
}
inline void deleteProgram(GLuint name) {
  glDeleteProgram(name);
}

template <class Name>
[[nodiscard]] Name generate(void (*make)(GLsizei, GLuint*)) {
  GLuint name = 0;
  make(1, &name);
  return Name(name);
}
}  // namespace gl

using GlTexture = GlName<gl::deleteTexture>;
using GlBuffer = GlName<gl::deleteBuffer>;
using GlVertexArray = GlName<gl::deleteVertexArray>;
using GlFramebuffer = GlName<gl::deleteFramebuffer>;
using GlShader = GlName<gl::deleteShader>;
using GlProgramName = GlName<gl::deleteProgram>;

// Reads and clears all GL errors since the last call.
[[nodiscard]] inline Result<void> glOutcome() noexcept {
  const GLenum first = glGetError();
  if (first == GL_NO_ERROR) return {};
  while (glGetError() != GL_NO_ERROR) {
  }
  if (first == GL_OUT_OF_MEMORY) return fail(ErrorCode::Exhausted, "the GL driver has no memory left for the picture");
  return fail(ErrorCode::Io, "the GL driver refused to draw; is its context still current?", static_cast<int>(first));
}

}  // namespace relievo
