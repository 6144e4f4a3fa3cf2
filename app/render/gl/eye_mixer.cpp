// SPDX-License-Identifier: Apache-2.0
// One pass over the surface that takes each pixel from one eye or both, depending on the layout.
#include "app/render/gl/eye_mixer.h"

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

namespace relievo {
namespace {

constexpr GLint kLeftUnit = 4, kRightUnit = 5;  // after the units of the relief and its picture

constexpr const char* kVertexShader = R"(
void main() {
  // One triangle that covers the surface.
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(
precision highp float;
uniform sampler2D left, right;
uniform int height;
uniform ivec2 alternate;  // (1, 0): columns, (0, 1): rows, (0, 0): anaglyph
uniform mat3 left_colors, right_colors;
out vec4 color;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec3 left_rgb = texelFetch(left, at, 0).rgb;
  vec3 right_rgb = texelFetch(right, at, 0).rgb;
  ivec2 from_top_left = ivec2(at.x, height - 1 - at.y) * alternate;
  vec3 mixed = clamp(left_colors * left_rgb + right_colors * right_rgb, 0.0, 1.0);
  vec3 taken = ((from_top_left.x + from_top_left.y) & 1) == 0 ? left_rgb : right_rgb;
  color = vec4(alternate == ivec2(0) ? mixed : taken, 1.0);
}
)";

struct Matrices {
  glm::mat3 left, right;
};

// Row k: the weights of an eye's red, green and blue in component k of the mixture.
constexpr glm::mat3 rows(const glm::vec3& red, const glm::vec3& green, const glm::vec3& blue) {
  return {red.x, green.x, blue.x, red.y, green.y, blue.y, red.z, green.z, blue.z};
}

Matrices matricesOf(AnaglyphColors colors) {
  constexpr glm::vec3 kNothing(0);
  constexpr glm::vec3 kBrightness(0.299F, 0.587F, 0.114F);  // BT.601
  switch (colors) {
    case AnaglyphColors::Gray:
      return {rows(kBrightness, kNothing, kNothing), rows(kNothing, kBrightness, kBrightness)};
    case AnaglyphColors::Color:
      return {rows({1, 0, 0}, kNothing, kNothing), rows(kNothing, {0, 1, 0}, {0, 0, 1})};
    case AnaglyphColors::Dubois:
      break;
  }
  // E. Dubois, "A projection method to generate anaglyph stereo images", ICASSP 2001: least squares, red-cyan glasses,
  // applied to gamma-encoded values, as FFmpeg's stereo3d filter does.
  return {rows({0.456F, 0.500F, 0.176F}, {-0.040F, -0.038F, -0.016F}, {-0.015F, -0.021F, -0.005F}),
          rows({-0.043F, -0.088F, -0.002F}, {0.378F, 0.734F, -0.018F}, {-0.072F, -0.113F, 1.226F})};
}

GlTexture makeTexture(GLenum format, int width, int height) {
  auto texture = gl::generate<GlTexture>(glGenTextures);
  glBindTexture(GL_TEXTURE_2D, texture.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

}  // namespace

Result<EyeMixer> EyeMixer::create() {
  EyeMixer mixer;
  auto program = GlProgram::create("", kVertexShader, kFragmentShader);
  if (!program) return std::unexpected(program.error());
  mixer.program_ = std::move(*program);
  mixer.no_vertices_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  return mixer;
}

Result<void> EyeMixer::bindEye(std::size_t eye, int width, int height) {
  if (width != width_ || height != height_) allocate(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, eyes_[eye].framebuffer.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return {};
  width_ = 0;
  return fail(ErrorCode::Exhausted,
              "out of memory for separate pictures of the two eyes; choose another stereo layout");
}

void EyeMixer::allocate(int width, int height) {
  glActiveTexture(GL_TEXTURE0 + kLeftUnit);
  for (Target& eye : eyes_) {
    eye.color = makeTexture(GL_RGBA8, width, height);
    eye.depth = makeTexture(GL_DEPTH_COMPONENT24, width, height);
    eye.framebuffer = gl::generate<GlFramebuffer>(glGenFramebuffers);
    glBindFramebuffer(GL_FRAMEBUFFER, eye.framebuffer.get());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, eye.color.get(), 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, eye.depth.get(), 0);
  }
  width_ = width;
  height_ = height;
}

void EyeMixer::mix(const StereoSettings& settings) const {
  const Matrices colors = matricesOf(settings.anaglyph);
  program_.use();
  for (std::size_t i = 0; i < kEyes; ++i) {
    glActiveTexture(GL_TEXTURE0 + kLeftUnit + static_cast<GLuint>(i));
    glBindTexture(GL_TEXTURE_2D, eyes_[i].color.get());
  }
  glUniform1i(program_.uniform("left"), kLeftUnit);
  glUniform1i(program_.uniform("right"), kRightUnit);
  glUniform1i(program_.uniform("height"), height_);
  glUniform2i(program_.uniform("alternate"), settings.layout == StereoLayout::Columns ? 1 : 0,
              settings.layout == StereoLayout::Rows ? 1 : 0);
  glUniformMatrix3fv(program_.uniform("left_colors"), 1, GL_FALSE, glm::value_ptr(colors.left));
  glUniformMatrix3fv(program_.uniform("right_colors"), 1, GL_FALSE, glm::value_ptr(colors.right));
  glViewport(0, 0, width_, height_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(no_vertices_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace relievo
