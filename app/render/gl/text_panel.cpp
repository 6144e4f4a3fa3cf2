// SPDX-License-Identifier: Apache-2.0
// Uploads the text when it changes and blends one rectangle over the picture.
#include "app/render/gl/text_panel.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "platform/log.h"

namespace relievo {
namespace {

constexpr int kLinePixels = 40;
constexpr double kLinesOfPicture = 24;     // text lines per picture height
constexpr double kMarginOfLine = 0.5;      // margin around the text, in line heights
constexpr double kWidestOfPicture = 0.94;  // share of the picture's width; a longer line reduces the text size
constexpr GLint kInkUnit = 6;

constexpr const char* kVertexShader = R"(
uniform mat4 view_projection;
uniform vec4 place;  // left, bottom, width and height of the panel, mm
uniform float z;
uniform vec4 text;  // left, bottom, width and height of the text, as shares of the panel
out vec2 ink_at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  ink_at = (corner - text.xy) / text.zw;
  ink_at.y = 1.0 - ink_at.y;
  gl_Position = view_projection * vec4(place.xy + corner * place.zw, z, 1.0);
}
)";

constexpr const char* kFragmentShader = R"(
precision mediump float;
in highp vec2 ink_at;
uniform sampler2D ink;
out vec4 color;
void main() {
  bool inside = all(greaterThanEqual(ink_at, vec2(0.0))) && all(lessThanEqual(ink_at, vec2(1.0)));
  float light = inside ? texture(ink, ink_at).r : 0.0;
  color = vec4(vec3(light), mix(0.55, 1.0, light));
}
)";

}  // namespace

Result<TextPanel> TextPanel::create() {
  TextPanel panel;
  auto program = GlProgram::create("", kVertexShader, kFragmentShader);
  if (!program) return std::unexpected(program.error());
  panel.program_ = std::move(*program);
  panel.no_vertices_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  return panel;
}

void TextPanel::setLines(const std::vector<std::string>& lines) {
  if (lines == lines_) return;
  const bool first = lines_.empty() && ink_.get() == 0;
  lines_ = lines;
  width_ = 0;
  if (lines.empty()) return;
  if (first) {
    auto glyphs = Glyphs::create(kLinePixels);
    if (glyphs) {
      glyphs_ = std::move(*glyphs);
    } else {
      log(LogLevel::Warning, "render", "%s; on-screen text is off", glyphs.error().message);
    }
    ink_ = gl::generate<GlTexture>(glGenTextures);
  }
  if (!glyphs_) return;
  const InkPicture picture = glyphs_->draw(lines);
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (picture.width > most || picture.height > most) return;
  glActiveTexture(GL_TEXTURE0 + kInkUnit);
  glBindTexture(GL_TEXTURE_2D, ink_.get());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, picture.width, picture.height, 0, GL_RED, GL_UNSIGNED_BYTE, picture.ink.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  width_ = picture.width;
  height_ = picture.height;
}

void TextPanel::draw(const glm::dmat4& view_projection, const DisplayVolume& volume, double screen_z_mm) const {
  if (width_ == 0) return;
  const double pixel_mm = std::min(volume.height_mm / (kLinesOfPicture * kLinePixels),
                                   kWidestOfPicture * volume.width_mm / (width_ + 2 * kMarginOfLine * kLinePixels));
  const double margin = kMarginOfLine * kLinePixels * pixel_mm;
  const double text_width = width_ * pixel_mm, text_height = height_ * pixel_mm;
  const double width = text_width + 2 * margin, height = text_height + 2 * margin;
  const double left = -0.5 * kWidestOfPicture * volume.width_mm;
  const double bottom = -0.5 * volume.height_mm + volume.height_mm * kMarginOfLine / kLinesOfPicture;
  const glm::mat4 camera(view_projection);
  program_.use();
  glUniformMatrix4fv(program_.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(camera));
  glUniform4f(program_.uniform("place"), static_cast<float>(left), static_cast<float>(bottom),
              static_cast<float>(width), static_cast<float>(height));
  glUniform1f(program_.uniform("z"), static_cast<float>(screen_z_mm));
  glUniform4f(program_.uniform("text"), static_cast<float>(margin / width), static_cast<float>(margin / height),
              static_cast<float>(text_width / width), static_cast<float>(text_height / height));
  glActiveTexture(GL_TEXTURE0 + kInkUnit);
  glBindTexture(GL_TEXTURE_2D, ink_.get());
  glUniform1i(program_.uniform("ink"), kInkUnit);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glBindVertexArray(no_vertices_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glDisable(GL_BLEND);
}

}  // namespace relievo
