// SPDX-License-Identifier: Apache-2.0
// A small mesh that follows the heights, blended over the picture.
#include "app/render/gl/surface_mark.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/type_ptr.hpp>
#include <utility>
#include <vector>

namespace relievo {
namespace {

constexpr int kSide = 12;            // cells per side
constexpr float kAboveMm = 0.4F;     // above the drawn surface, whose error is about as large
constexpr double kOtherThing = 2.0;  // times the radius: larger steps are not followed
constexpr int kIndices = kSide * kSide * 6;

struct Vertex {
  float x, y, z;
  float right, up;  // position relative to the middle, in radii
};

constexpr const char* kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 from_middle;
uniform mat4 view_projection;
out vec2 at;
void main() {
  at = from_middle;
  gl_Position = view_projection * vec4(position, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(
precision mediump float;
in vec2 at;
uniform vec4 paint;
out vec4 color;
void main() {
  float left = max(1.0 - dot(at, at), 0.0);
  color = vec4(paint.rgb, paint.a * left * left);
}
)";

}  // namespace

Result<SurfaceMark> SurfaceMark::create() {
  SurfaceMark mark;
  auto program = GlProgram::create("", kVertexShader, kFragmentShader);
  if (!program) return std::unexpected(program.error());
  mark.program_ = std::move(*program);
  mark.attributes_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  mark.vertices_ = gl::generate<GlBuffer>(glGenBuffers);
  mark.indices_ = gl::generate<GlBuffer>(glGenBuffers);
  std::array<std::uint16_t, kIndices> indices;
  auto* next = indices.begin();
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      const int low = r * (kSide + 1) + c, high = low + kSide + 1;
      for (const int k : {low, low + 1, high + 1, low, high + 1, high}) *next++ = static_cast<std::uint16_t>(k);
    }
  }
  glBindVertexArray(mark.attributes_.get());
  glBindBuffer(GL_ARRAY_BUFFER, mark.vertices_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mark.indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices.data(), GL_STATIC_DRAW);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  // GL takes the offset as a pointer.
  const auto* middles = reinterpret_cast<const void*>(offsetof(Vertex, right));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex), middles);
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  return mark;
}

double SurfaceMark::heightUnder(const HeightField& field, double x_mm, double y_mm) noexcept {
  const double u = field.grid().u(x_mm), v = field.grid().v(y_mm);
  if (!(u > -1 && v > -1 && u < field.cols() && v < field.rows())) return 0;
  const int c = std::clamp(static_cast<int>(std::lround(u)), 0, field.cols() - 1);
  const int r = std::clamp(static_cast<int>(std::lround(v)), 0, field.rows() - 1);
  const double z = field.heightMm(c, r);
  return std::isnan(z) ? 0 : z;
}

void SurfaceMark::draw(const glm::dmat4& view_projection, const HeightField& field, const Disc& disc) {
  std::array<Vertex, static_cast<std::size_t>(kSide + 1) * (kSide + 1)> vertices;
  auto* next = vertices.begin();
  const double middle = heightUnder(field, disc.center_mm.x, disc.center_mm.y);
  for (int r = 0; r <= kSide; ++r) {
    for (int c = 0; c <= kSide; ++c) {
      double right = 2.0 * c / kSide - 1, up = 2.0 * r / kSide - 1;
      const double x = disc.center_mm.x + right * disc.radius_mm, y = disc.center_mm.y + up * disc.radius_mm;
      const double height = heightUnder(field, x, y);
      // on another object: moved outside the disc, where it is transparent
      if (std::abs(height - middle) > kOtherThing * disc.radius_mm) right = up = 2;
      const auto z = static_cast<float>(height) + kAboveMm;
      *next++ = {static_cast<float>(x), static_cast<float>(y), z, static_cast<float>(right), static_cast<float>(up)};
    }
  }
  const glm::mat4 camera(view_projection);
  program_.use();
  glUniformMatrix4fv(program_.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(camera));
  glUniform4f(program_.uniform("paint"), disc.color.r, disc.color.g, disc.color.b, disc.opacity);
  glBindVertexArray(attributes_.get());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.get());
  glBufferData(GL_ARRAY_BUFFER, sizeof vertices, vertices.data(), GL_STREAM_DRAW);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glDrawElements(GL_TRIANGLES, kIndices, GL_UNSIGNED_SHORT, nullptr);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace relievo
