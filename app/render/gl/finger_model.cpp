// SPDX-License-Identifier: Apache-2.0
// The finger's shapes, their lighting, and the two passes that draw them.
#include "app/render/gl/finger_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "app/render/gl/scene_renderer.h"

namespace relievo {
namespace {

constexpr int kSlices = 20;
constexpr int kStacks = 10;
constexpr double kShaftRadiusMm = 0.7;
constexpr double kHeadRadiusMm = 1.7;
constexpr double kHeadLengthMm = 4.0;
constexpr double kSmallestForceN = 0.02;
constexpr float kHiddenOpacity = 0.3f;

constexpr const char* kVertexShader = R"(
precision highp float;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 view_projection;
uniform mat4 model;
uniform mat3 normals;
out mediump float light;
void main() {
  // A lamp from above left, where viewers expect it; the rest is ambient light.
  float lambert = max(dot(normalize(normals * normal), normalize(vec3(-0.4, 0.6, 0.7))), 0.0);
  light = 0.35 + 0.65 * lambert;
  gl_Position = view_projection * (model * vec4(position, 1.0));
}
)";

constexpr const char* kFragmentShader = R"(
precision mediump float;
in mediump float light;
uniform vec4 paint;
out vec4 color;
void main() {
  color = vec4(paint.rgb * light, paint.a);
}
)";

struct Vertex {
  glm::vec3 position;
  glm::vec3 normal;
};

glm::vec3 onCircle(int slice) {
  const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(slice % kSlices) / kSlices;
  return {std::cos(angle), std::sin(angle), 0.0f};
}

// Two triangles, counter-clockwise seen from outside if a -> b runs around the axis and a -> d along it.
void addQuad(std::vector<Vertex>& out, const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
  for (const Vertex& v : {a, b, c, a, c, d}) out.push_back(v);
}

// A unit sphere.
void addSphere(std::vector<Vertex>& out) {
  const auto at = [](int stack, int slice) {
    const float polar = std::numbers::pi_v<float> * (static_cast<float>(stack) / kStacks - 0.5f);
    const glm::vec3 p = std::cos(polar) * onCircle(slice) + glm::vec3(0, 0, std::sin(polar));
    return Vertex{p, p};
  };
  for (int stack = 0; stack < kStacks; ++stack) {
    for (int slice = 0; slice < kSlices; ++slice) {
      addQuad(out, at(stack, slice), at(stack, slice + 1), at(stack + 1, slice + 1), at(stack + 1, slice));
    }
  }
}

// A cone of length 1 along z with the given radii at its ends; the lower end is closed.
void addCone(std::vector<Vertex>& out, float lower_radius, float upper_radius) {
  const auto at = [&](int slice, float z) {
    const glm::vec3 side = onCircle(slice);
    const float radius = z > 0.0f ? upper_radius : lower_radius;
    return Vertex{radius * side + glm::vec3(0, 0, z), side + glm::vec3(0, 0, lower_radius - upper_radius)};
  };
  const glm::vec3 down(0, 0, -1);
  for (int slice = 0; slice < kSlices; ++slice) {
    addQuad(out, at(slice, 0), at(slice + 1, 0), at(slice + 1, 1), at(slice, 1));
    for (const glm::vec3& p : {glm::vec3(0), lower_radius * onCircle(slice + 1), lower_radius * onCircle(slice)}) {
      out.push_back({p, down});
    }
  }
}

// The frame whose z axis is `direction`, a unit vector.
glm::dmat4 frameAlong(const glm::dvec3& direction) {
  const glm::dvec3 other = std::abs(direction.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, direction));
  const glm::dvec3 y = glm::cross(direction, x);
  return {glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(direction, 0), glm::dvec4(0, 0, 0, 1)};
}

}  // namespace

Result<FingerModel> FingerModel::create() {
  FingerModel finger;
  auto program = GlProgram::create("", kVertexShader, kFragmentShader);
  if (!program) return std::unexpected(program.error());
  finger.program_ = std::move(*program);

  std::vector<Vertex> shapes;
  const auto rangeSince = [&shapes](std::size_t first) {
    return Range{static_cast<GLint>(first), static_cast<GLsizei>(shapes.size() - first)};
  };
  addSphere(shapes);
  finger.sphere_ = rangeSince(0);
  const std::size_t shaft = shapes.size();
  addCone(shapes, 1.0f, 1.0f);
  finger.shaft_ = rangeSince(shaft);
  const std::size_t head = shapes.size();
  addCone(shapes, 1.0f, 0.0f);
  finger.head_ = rangeSince(head);

  finger.vertices_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  finger.buffer_ = gl::generate<GlBuffer>(glGenBuffers);
  glBindVertexArray(finger.vertices_.get());
  glBindBuffer(GL_ARRAY_BUFFER, finger.buffer_.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(shapes.size() * sizeof(Vertex)), shapes.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  // GL takes the offset as a pointer.
  const auto* normals = reinterpret_cast<const void*>(offsetof(Vertex, normal));
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), normals);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  return finger;
}

void FingerModel::draw(const glm::dmat4& view_projection, const FingerMark& mark, const FingerPaint& paint) const {
  program_.use();
  glBindVertexArray(vertices_.get());
  const glm::vec3 color = mark.contact ? paint.contact : paint.free;
  const auto paintAt = [&](float opacity) {
    glUniform4f(program_.uniform("paint"), color.r, color.g, color.b, opacity);
  };

  // The hidden part first, while the depth buffer does not hold the finger itself.
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  paintAt(kHiddenOpacity);
  drawParts(view_projection, mark);
  glDisable(GL_BLEND);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  paintAt(1.0f);
  drawParts(view_projection, mark);
}

void FingerModel::drawParts(const glm::dmat4& view_projection, const FingerMark& mark) const {
  const glm::dmat4 here = glm::translate(glm::dmat4(1), mark.position_mm);
  drawPart(sphere_, glm::scale(here, glm::dvec3(kRadiusMm)), view_projection);
  const double force = glm::length(mark.force_n);
  if (!(force > kSmallestForceN)) return;
  const glm::dmat4 along = here * frameAlong(mark.force_n / force);
  const double length = kRadiusMm + kArrowMmPerN * force;
  const double head = std::min(kHeadLengthMm, length - kRadiusMm);
  const glm::dvec3 shaft_size(kShaftRadiusMm, kShaftRadiusMm, length - head);
  const glm::dvec3 head_size(kHeadRadiusMm, kHeadRadiusMm, head);
  drawPart(shaft_, glm::scale(along, shaft_size), view_projection);
  drawPart(head_, glm::scale(glm::translate(along, {0.0, 0.0, length - head}), head_size), view_projection);
}

void FingerModel::drawPart(const Range& part, const glm::dmat4& model, const glm::dmat4& view_projection) const {
  const glm::mat4 placed(model);
  const glm::mat4 camera(view_projection);
  const glm::mat3 normals(glm::transpose(glm::inverse(glm::dmat3(model))));
  glUniformMatrix4fv(program_.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(camera));
  glUniformMatrix4fv(program_.uniform("model"), 1, GL_FALSE, glm::value_ptr(placed));
  glUniformMatrix3fv(program_.uniform("normals"), 1, GL_FALSE, glm::value_ptr(normals));
  glDrawArrays(GL_TRIANGLES, part.first, part.count);
}

}  // namespace relievo
