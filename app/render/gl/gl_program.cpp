// SPDX-License-Identifier: Apache-2.0
// Compiling and linking.
#include "app/render/gl/gl_program.h"

#include <array>
#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

Result<GlShader> compile(GLenum stage, const std::string& defines, const char* source) {
  GlShader shader(glCreateShader(stage));
  const std::array<const GLchar*, 3> parts{"#version 300 es\n", defines.c_str(), source};
  glShaderSource(shader.get(), static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
  glCompileShader(shader.get());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<GLchar, 512> text{};
  glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(text.size()), nullptr, text.data());
  log(LogLevel::Error, "render", "shader: %s", text.data());
  return fail(ErrorCode::Unsupported, "the GL driver cannot compile the renderer's shaders; a GLES 3 driver is needed");
}

}  // namespace

Result<GlProgram> GlProgram::create(const std::string& defines, const char* vertex_source,
                                    const char* fragment_source) {
  auto vertex = compile(GL_VERTEX_SHADER, defines, vertex_source);
  if (!vertex) return std::unexpected(vertex.error());
  auto fragment = compile(GL_FRAGMENT_SHADER, defines, fragment_source);
  if (!fragment) return std::unexpected(fragment.error());

  GlProgram program;
  program.name_ = GlProgramName(glCreateProgram());
  glAttachShader(program.name_.get(), vertex->get());
  glAttachShader(program.name_.get(), fragment->get());
  glLinkProgram(program.name_.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.name_.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::array<GLchar, 512> text{};
  glGetProgramInfoLog(program.name_.get(), static_cast<GLsizei>(text.size()), nullptr, text.data());
  log(LogLevel::Error, "render", "shader link: %s", text.data());
  return fail(ErrorCode::Unsupported, "the GL driver cannot link the renderer's shaders; a GLES 3 driver is needed");
}

}  // namespace relievo
