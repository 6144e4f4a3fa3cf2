// SPDX-License-Identifier: Apache-2.0
// One rectangle per picture, in the view's own pixels.
#include "app/render/gl/words/overlay.h"

#include <utility>

namespace relievo {
namespace {

constexpr GLint kTextUnit = 6;  // after the units of the relief, its picture and the mixer

constexpr const char* kVertexShader = R"(
uniform vec4 place;  // left, bottom, width and height, in the view's coordinates from -1 to 1
out vec2 at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  at = vec2(corner.x, 1.0 - corner.y);
  gl_Position = vec4(place.xy + corner * place.zw, 0.0, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(
precision mediump float;
in highp vec2 at;
uniform sampler2D words;
out vec4 color;
void main() { color = texture(words, at); }
)";

}  // namespace

Result<Overlay> Overlay::create() {
  Overlay overlay;
  auto program = GlProgram::create("", kVertexShader, kFragmentShader);
  if (!program) return std::unexpected(program.error());
  overlay.program_ = std::move(*program);
  overlay.no_vertices_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  return overlay;
}

void Overlay::set(const TextFrame& frame, const std::vector<TextPicture>& pictures) {
  frame_ = frame;
  parts_.clear();
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  glActiveTexture(GL_TEXTURE0 + kTextUnit);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  for (const TextPicture& picture : pictures) {
    if (picture.cols > most || picture.rows > most) continue;
    Part part{gl::generate<GlTexture>(glGenTextures), picture.x, picture.y, picture.width, picture.height};
    glBindTexture(GL_TEXTURE_2D, part.texture.get());
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.cols, picture.rows, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 picture.rgba.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    parts_.push_back(std::move(part));
  }
}

void Overlay::setUnseen(const TextFrame& frame) {
  constexpr int kPixels = 3;  // drivers may compile another program for textures of powers of two
  const std::vector<std::uint8_t> clear(std::size_t{4} * kPixels * kPixels);
  set(frame, {{.width = kPixels, .height = kPixels, .cols = kPixels, .rows = kPixels, .rgba = clear}});
}

void Overlay::draw(double shift_px) const {
  if (parts_.empty()) return;
  const double x_unit = 2.0 / frame_.width, y_unit = 2.0 / frame_.height;
  program_.use();
  glUniform1i(program_.uniform("words"), kTextUnit);
  const GLint place = program_.uniform("place");
  glActiveTexture(GL_TEXTURE0 + kTextUnit);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(no_vertices_.get());
  for (const Part& part : parts_) {
    glBindTexture(GL_TEXTURE_2D, part.texture.get());
    glUniform4f(place, static_cast<float>((part.x + shift_px) * x_unit - 1),
                static_cast<float>(1 - (part.y + part.height) * y_unit), static_cast<float>(part.width * x_unit),
                static_cast<float>(part.height * y_unit));
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  glDisable(GL_BLEND);
}

}  // namespace relievo
