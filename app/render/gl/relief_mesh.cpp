// SPDX-License-Identifier: Apache-2.0
// From depth codes to displaced triangles: the shaders, and the tile of cells that covers the grid.
#include "app/render/gl/relief_mesh.h"

#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/scene/height_field.h"

namespace relievo {
namespace {

// One instance draws a tile of cells: few indices for a grid of any size and step. A tile of this size is about what a
// software pipeline or a small GPU takes at once, so that a vertex is shaded once; larger ones measured slower.
constexpr int kTileCells = 13;
constexpr int kTileVertices = kTileCells + 1;
constexpr GLsizei kTileIndices = kTileCells * kTileCells * 6;

constexpr GLint kCodesUnit = 0;

// As HeightField reads hues: a pixel whose three bytes sum to no more is a hole.
constexpr int kDarkestReadable = 76;

constexpr const char* kVertexShader = R"(
precision highp float;
precision highp int;
uniform mat4 view_projection;
uniform vec3 frame_mm;  // right, top, z
out vec2 picture_at;

#ifdef FLAT
void main() {
  picture_at = vec2(gl_VertexID >> 1, gl_VertexID & 1);
  vec2 corner = vec2(2.0 * picture_at.x - 1.0, 1.0 - 2.0 * picture_at.y) * frame_mm.xy;
  gl_Position = view_projection * vec4(corner, frame_mm.z, 1.0);
}
#else

uniform highp usampler2D codes;
uniform ivec2 samples;
uniform ivec2 last;  // column and row of vertices, counted from 0
uniform int grid_step;
uniform int tiles_across;
uniform vec4 place_mm;  // x = place.x + place.y c, y = place.z + place.w r
uniform vec2 normalise;  // s = x + y code
uniform bool inverse;
uniform vec4 inverse_law;  // 1/far, 1/near - 1/far, far, depth/(far - near)
uniform float depth_mm;

#ifdef HUE
uniform ivec3 channels;
// The number of HeightField, for the same bytes: hue over 360 degrees, -1 where there is none.
float code(uvec4 texel) {
  ivec3 rgb = ivec3(texel[channels.r], texel[channels.g], texel[channels.b]);
  int high = max(max(rgb.r, rgb.g), rgb.b);
  int spread = high - min(min(rgb.r, rgb.g), rgb.b);
  if (rgb.r + rgb.g + rgb.b <= DARKEST_READABLE || spread == 0) return -1.0;
  if (high == rgb.r) {
    float sixth = float(rgb.g - rgb.b) / float(spread);
    return (sixth < 0.0 ? sixth + 6.0 : sixth) / 6.0;
  }
  if (high == rgb.g) return (2.0 + float(rgb.b - rgb.r) / float(spread)) / 6.0;
  return (4.0 + float(rgb.r - rgb.g) / float(spread)) / 6.0;
}
#else
uniform int channel;
uniform int shift;
uniform uint mask;
uniform uint invalid;
float code(uvec4 texel) {
  uint value = (texel[channel] >> shift) & mask;
  return value == invalid ? -1.0 : float(value);
}
#endif

void main() {
  ivec2 tile = ivec2(gl_InstanceID % tiles_across, gl_InstanceID / tiles_across);
  ivec2 inside = ivec2(gl_VertexID % TILE_VERTICES, gl_VertexID / TILE_VERTICES);
  // The vertices of the samples run from 0 to last. One more on every side is the frame; past it the cells shrink to
  // nothing.
  ivec2 vertex = clamp(tile * TILE_CELLS + inside - 1, ivec2(-1), last + 1);
  ivec2 at = clamp(vertex * grid_step, ivec2(0), samples - 1);
  float value = code(texelFetch(codes, at, 0));
  if (value < 0.0) {
    // A hole: so far behind the far plane that of a triangle with one such corner nothing is left but a line.
    gl_Position = vec4(0.0, 0.0, 1.0e9, 1.0);
    return;
  }
  float s = clamp(normalise.x + normalise.y * value, 0.0, 1.0);
  float z = inverse ? (inverse_law.z - 1.0 / (inverse_law.x + s * inverse_law.y)) * inverse_law.w : depth_mm * s;
  vec3 position = vec3(place_mm.xz + place_mm.yw * vec2(at), z);
  picture_at = (vec2(at) + 0.5) / vec2(samples);
  bvec2 low = lessThan(vertex, ivec2(0));
  bvec2 high = greaterThan(vertex, last);
  if (any(low) || any(high)) {
    vec2 side = vec2(high) - vec2(low);  // -1, 0 or 1: left, inside, right; top, inside, bottom
    picture_at = mix(picture_at, 0.5 + 0.5 * side, abs(side));
    position = vec3(mix(position.xy, vec2(side.x, -side.y) * frame_mm.xy, abs(side)), frame_mm.z);
  }
  gl_Position = view_projection * vec4(position, 1.0);
}
#endif
)";

std::vector<GLushort> tileIndices() {
  std::vector<GLushort> indices;
  indices.reserve(kTileIndices);
  for (int r = 0; r < kTileCells; ++r) {
    for (int c = 0; c < kTileCells; ++c) {
      const int top = r * kTileVertices + c;
      const int below = top + kTileVertices;
      for (const int vertex : {top, below, below + 1, top, below + 1, top + 1}) {
        indices.push_back(static_cast<GLushort>(vertex));
      }
    }
  }
  return indices;
}

// One cell less than vertices, and one at each end out to the frame.
int tilesAlong(int samples, int step) noexcept {
  const int cells = ReliefMesh::verticesAlong(samples, step) - 1 + 2;
  return (cells + kTileCells - 1) / kTileCells;
}

void usePicture(const GlProgram& program, const PictureView& view, const DisplayVolume& volume) {
  program.use();
  glUniformMatrix4fv(program.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(view.view_projection));
  glUniform1i(program.uniform("picture"), static_cast<GLint>(view.picture_unit));
  glUniform3f(program.uniform("frame_mm"), static_cast<float>(0.5 * volume.width_mm),
              static_cast<float>(0.5 * volume.height_mm), static_cast<float>(view.screen_z_mm));
}

}  // namespace

// Nearly all of a frame's time in software rendering goes by this line: small triangles shade many pixels in vain.
const char* const kPictureFragmentShader = R"(
precision mediump float;
in highp vec2 picture_at;
uniform sampler2D picture;
out vec4 color;
void main() {
  color = textureLod(picture, picture_at, 0.0);
}
)";

Result<ReliefMesh> ReliefMesh::create() {
  const std::string tile = "#define TILE_CELLS " + std::to_string(kTileCells) + "\n#define TILE_VERTICES " +
                           std::to_string(kTileVertices) + "\n";
  const std::string hue = "#define HUE\n#define DARKEST_READABLE " + std::to_string(kDarkestReadable) + "\n";
  ReliefMesh mesh;
  const auto link = [](GlProgram& program, const std::string& defines) -> Result<void> {
    auto made = GlProgram::create(defines, kVertexShader, kPictureFragmentShader);
    if (!made) return std::unexpected(made.error());
    program = std::move(*made);
    return {};
  };
  if (auto made = link(mesh.luma_program_, tile); !made) return std::unexpected(made.error());
  if (auto made = link(mesh.hue_program_, tile + hue); !made) return std::unexpected(made.error());
  if (auto made = link(mesh.flat_program_, "#define FLAT\n"); !made) return std::unexpected(made.error());

  mesh.tile_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  mesh.tile_indices_ = gl::generate<GlBuffer>(glGenBuffers);
  const std::vector<GLushort> indices = tileIndices();
  glBindVertexArray(mesh.tile_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.tile_indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLushort)), indices.data(),
               GL_STATIC_DRAW);
  return mesh;
}

ReliefMesh::Decoding ReliefMesh::decodingOf(const Frame& depth, const DepthCalibration& calibration,
                                            const DisplayVolume& volume) {
  Decoding d;
  const Component& first = depth.components[0];
  const double low = calibration.lowCode();
  double scale = 1.0;
  double offset = 0.0;
  if (calibration.code == DepthCode::Hue) {
    for (std::size_t i = 0; i < 3; ++i) d.hue_channels[i] = depth.components[i].offset_bytes;
  } else {
    d.channel = first.offset_bytes / (first.bits > 8 ? 2 : 1);
    d.shift = first.shift;
    d.mask = (1u << first.bits) - 1;
    d.invalid = calibration.invalid.empty() ? ~0u : calibration.invalid.highest();
    scale = 1.0 / (calibration.highCode() - low);
    offset = -low * scale;
  }
  if (calibration.polarity == DepthPolarity::NearIsLow) {
    scale = -scale;
    offset = 1.0 - offset;
  }
  d.s_scale = static_cast<float>(scale);
  d.s_offset = static_cast<float>(offset);
  d.depth_mm = static_cast<float>(volume.depth_mm);
  d.inverse = calibration.law == DepthLaw::Inverse;
  d.near_inverse = static_cast<float>(1.0 / calibration.near_mm);
  d.far_inverse = static_cast<float>(1.0 / calibration.far_mm);
  d.far_mm = static_cast<float>(calibration.far_mm);
  d.depth_per_mm = static_cast<float>(volume.depth_mm / (calibration.far_mm - calibration.near_mm));
  return d;
}

Result<void> ReliefMesh::setDepth(const Frame& depth, const DepthCalibration& calibration,
                                  const DisplayVolume& volume) {
  const auto readable = HeightField::make(depth, calibration, volume);
  if (!readable) return std::unexpected(readable.error());
  const Component& first = depth.components[0];
  const int bytes = first.bits > 8 ? 2 : 1;
  const int channels = first.step_bytes / bytes;
  if (first.step_bytes % bytes != 0 || channels < 1 || channels > 4) {
    return fail(ErrorCode::Unsupported, "this depth format cannot be drawn; decode to a plane of luma or packed RGB");
  }
  glActiveTexture(GL_TEXTURE0 + kCodesUnit);
  const TexelLayout texel{
      .channels = static_cast<std::uint8_t>(channels), .bytes = static_cast<std::uint8_t>(bytes), .whole = true};
  codes_.upload(texel, depth.planes[first.plane], depth.width, depth.height);
  hue_ = calibration.code == DepthCode::Hue;
  decoding_ = decodingOf(depth, calibration, volume);
  volume_ = volume;
  grid_ = readable->grid();
  cols_ = depth.width;
  rows_ = depth.height;
  return {};
}

void ReliefMesh::setDecoding(const GlProgram& program) const {
  const Decoding& d = decoding_;
  glUniform2f(program.uniform("normalise"), d.s_offset, d.s_scale);
  glUniform1i(program.uniform("inverse"), d.inverse ? 1 : 0);
  glUniform4f(program.uniform("inverse_law"), d.far_inverse, d.near_inverse - d.far_inverse, d.far_mm, d.depth_per_mm);
  glUniform1f(program.uniform("depth_mm"), d.depth_mm);
  if (hue_) {
    glUniform3iv(program.uniform("channels"), 1, d.hue_channels.data());
    return;
  }
  glUniform1i(program.uniform("channel"), d.channel);
  glUniform1i(program.uniform("shift"), d.shift);
  glUniform1ui(program.uniform("mask"), d.mask);
  glUniform1ui(program.uniform("invalid"), d.invalid);
}

void ReliefMesh::draw(const PictureView& view, int step) const {
  const int across = tilesAlong(cols_, step);
  const int down = tilesAlong(rows_, step);
  const GlProgram& program = hue_ ? hue_program_ : luma_program_;
  usePicture(program, view, volume_);
  setDecoding(program);
  codes_.bind(kCodesUnit);
  glUniform1i(program.uniform("codes"), kCodesUnit);
  glUniform2i(program.uniform("samples"), cols_, rows_);
  glUniform2i(program.uniform("last"), verticesAlong(cols_, step) - 1, verticesAlong(rows_, step) - 1);
  glUniform1i(program.uniform("grid_step"), step);
  glUniform1i(program.uniform("tiles_across"), across);
  glUniform4f(program.uniform("place_mm"), static_cast<float>(grid_.x(0)), static_cast<float>(grid_.x(1) - grid_.x(0)),
              static_cast<float>(grid_.y(0)), static_cast<float>(grid_.y(1) - grid_.y(0)));
  glBindVertexArray(tile_.get());
  glDrawElementsInstanced(GL_TRIANGLES, kTileIndices, GL_UNSIGNED_SHORT, nullptr, across * down);
}

void ReliefMesh::drawFlat(const PictureView& view, const DisplayVolume& volume) const {
  usePicture(flat_program_, view, volume);
  glBindVertexArray(tile_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

}  // namespace relievo
