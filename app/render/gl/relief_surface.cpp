// SPDX-License-Identifier: Apache-2.0
// Upload and drawing of a mesh that is another one each frame.
#include "app/render/gl/relief_surface.h"

#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

namespace relievo {
namespace {

constexpr const char* kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 place;
uniform mat4 view_projection;
out vec2 picture_at;
void main() {
  picture_at = place;
  gl_Position = view_projection * vec4(position, 1.0);
}
)";

template <class Element>
void replace(GLenum target, const OutputArray<Element>& elements) {
  glBufferData(target, static_cast<GLsizeiptr>(elements.size() * sizeof(Element)), elements.data(), GL_STREAM_DRAW);
}

}  // namespace

Result<ReliefSurface> ReliefSurface::create() {
  ReliefSurface surface;
  auto program = GlProgram::create("", kVertexShader, kPictureFragmentShader);
  if (!program) return std::unexpected(program.error());
  surface.program_ = std::move(*program);
  surface.attributes_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  surface.vertices_ = gl::generate<GlBuffer>(glGenBuffers);
  surface.indices_ = gl::generate<GlBuffer>(glGenBuffers);
  glBindVertexArray(surface.attributes_.get());
  glBindBuffer(GL_ARRAY_BUFFER, surface.vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, surface.indices_.get());
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(TexturedVertex), nullptr);
  // GL takes an offset for a pointer here.
  const auto* places = reinterpret_cast<const void*>(offsetof(TexturedVertex, u));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(TexturedVertex), places);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  return surface;
}

void ReliefSurface::upload(const ReliefTriangles& triangles) {
  glBindVertexArray(attributes_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  replace(GL_ARRAY_BUFFER, triangles.vertices());
  replace(GL_ELEMENT_ARRAY_BUFFER, triangles.indices());
  index_count_ = static_cast<GLsizei>(triangles.indices().size());
}

void ReliefSurface::draw(const PictureView& view) const {
  program_.use();
  glUniformMatrix4fv(program_.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(view.view_projection));
  glUniform1i(program_.uniform("picture"), static_cast<GLint>(view.picture_unit));
  glBindVertexArray(attributes_.get());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace relievo
