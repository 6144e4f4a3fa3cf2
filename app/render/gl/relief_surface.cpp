// SPDX-License-Identifier: Apache-2.0
// Uploads and draws a mesh that changes every frame.
#include "app/render/gl/relief_surface.h"

#include <array>
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
void send(GLenum target, std::span<const Element> elements) {
  glBufferData(target, static_cast<GLsizeiptr>(elements.size_bytes()), elements.data(), GL_STREAM_DRAW);
}

}  // namespace

// Most of the frame time in software rendering is spent on this line, since small triangles shade many invisible
// pixels.
const char* const kPictureFragmentShader = R"(
precision mediump float;
in highp vec2 picture_at;
uniform sampler2D picture;
out vec4 color;
void main() {
  color = textureLod(picture, picture_at, 0.0);
}
)";

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
  // GL takes the offset as a pointer.
  const auto* places = reinterpret_cast<const void*>(offsetof(TexturedVertex, u));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(TexturedVertex), places);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  return surface;
}

void ReliefSurface::replace(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices) {
  glBindVertexArray(attributes_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  send(GL_ARRAY_BUFFER, vertices);
  send(GL_ELEMENT_ARRAY_BUFFER, indices);
  index_count_ = static_cast<GLsizei>(indices.size());
}

void ReliefSurface::upload(const ReliefTriangles& triangles) {
  replace(triangles.vertices(), triangles.indices());
  flat_ = false;
}

void ReliefSurface::uploadFlat(const DisplayVolume& volume, double z_mm) {
  const auto right = static_cast<float>(0.5 * volume.width_mm), top = static_cast<float>(0.5 * volume.height_mm);
  const auto z = static_cast<float>(z_mm);
  const std::array<TexturedVertex, 4> corners{
      {{-right, top, z, 0, 0}, {-right, -top, z, 0, 1}, {right, top, z, 1, 0}, {right, -top, z, 1, 1}}};
  constexpr std::array<std::uint32_t, 6> kTwoTriangles{0, 1, 2, 2, 1, 3};
  replace(corners, kTwoTriangles);
  flat_ = true;
}

void ReliefSurface::draw(const glm::mat4& view_projection, GLuint picture_unit) const {
  program_.use();
  glUniformMatrix4fv(program_.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(view_projection));
  glUniform1i(program_.uniform("picture"), static_cast<GLint>(picture_unit));
  glBindVertexArray(attributes_.get());
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace relievo
