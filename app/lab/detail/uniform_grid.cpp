// SPDX-License-Identifier: Apache-2.0
// One draw call an eye: an instance of a small indexed tile for every tile of cells.
#include "app/lab/detail/uniform_grid.h"

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/render/gl/relief_surface.h"

namespace relievo {
namespace {

// An instance draws a tile of cells: few indices for a grid of any size and step. A tile of this size is about what a
// software pipeline or a small GPU takes at once, so that a vertex is shaded once; larger ones measured slower.
constexpr int kTileCells = 13;
constexpr int kTileVertices = kTileCells + 1;
constexpr GLsizei kTileIndices = kTileCells * kTileCells * 6;

constexpr GLuint kCodesUnit = 0, kPictureUnit = 3;  // between them the colour planes'

constexpr const char* kVertexShader = R"(
precision highp float;
precision highp int;
uniform mat4 view_projection;
uniform vec3 frame_mm;  // right, top, z
uniform highp sampler2D codes;
uniform ivec2 samples;
uniform ivec2 last;  // column and row of vertices, counted from 0
uniform int grid_step;
uniform int tiles_across;
uniform vec4 place_mm;  // x = place.x + place.y c, y = place.z + place.w r
uniform float depth_mm;
out vec2 picture_at;

void main() {
  ivec2 tile = ivec2(gl_InstanceID % tiles_across, gl_InstanceID / tiles_across);
  ivec2 inside = ivec2(gl_VertexID % TILE_VERTICES, gl_VertexID / TILE_VERTICES);
  // The vertices of the samples run from 0 to last. One more on every side is the frame; past it the cells shrink to
  // nothing.
  ivec2 vertex = clamp(tile * TILE_CELLS + inside - 1, ivec2(-1), last + 1);
  ivec2 at = clamp(vertex * grid_step, ivec2(0), samples - 1);
  vec3 position = vec3(place_mm.xz + place_mm.yw * vec2(at), depth_mm * texelFetch(codes, at, 0).r);
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
  const int cells = UniformGrid::verticesAlong(samples, step) - 1 + 2;
  return (cells + kTileCells - 1) / kTileCells;
}

}  // namespace

Result<UniformGrid> UniformGrid::create() {
  UniformGrid grid;
  const std::string tile = "#define TILE_CELLS " + std::to_string(kTileCells) + "\n#define TILE_VERTICES " +
                           std::to_string(kTileVertices) + "\n";
  auto program = GlProgram::create(tile, kVertexShader, kPictureFragmentShader);
  if (!program) return std::unexpected(program.error());
  grid.program_ = std::move(*program);
  grid.tile_ = gl::generate<GlVertexArray>(glGenVertexArrays);
  grid.tile_indices_ = gl::generate<GlBuffer>(glGenBuffers);
  const std::vector<GLushort> indices = tileIndices();
  glBindVertexArray(grid.tile_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, grid.tile_indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(GLushort)), indices.data(),
               GL_STATIC_DRAW);
  return grid;
}

Result<void> UniformGrid::setFrame(const Frame& color, const Frame& depth, const DisplayVolume& volume) {
  const Component& code = depth.components[0];
  if (code.bits != 8 || code.step_bytes != 1) {
    return fail(ErrorCode::Unsupported, "the uniform grid draws only depth of 8 bits in a plane of its own");
  }
  if (auto drawable = ColorPicture::check(color); !drawable) return drawable;
  if (auto set = picture_.setFrame(color); !set) return set;
  glActiveTexture(GL_TEXTURE0 + kCodesUnit);
  codes_.upload(1, depth.planes[code.plane], depth.width, depth.height);
  volume_ = volume;
  cols_ = depth.width;
  rows_ = depth.height;
  return glOutcome();
}

Result<void> UniformGrid::draw(const DisplaySurface& surface, const StereoSettings& stereo, int step) {
  const EyeViews eyes = eyeViews(stereo, volume_, surface.width, surface.height);
  picture_.bind(kPictureUnit, eyes.views[0].area, volume_);
  glBindFramebuffer(GL_FRAMEBUFFER, surface.framebuffer);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_CULL_FACE);  // the back, as nobody sees the relief from below
  program_.use();
  setGrid(step);
  glUniform3f(program_.uniform("frame_mm"), static_cast<float>(0.5 * volume_.width_mm),
              static_cast<float>(0.5 * volume_.height_mm), static_cast<float>(stereo.screen_z_mm));
  codes_.bind(kCodesUnit);
  glBindVertexArray(tile_.get());
  for (const EyeView& view : eyes.views) drawView(view, tilesAlong(cols_, step) * tilesAlong(rows_, step));
  glFinish();
  return glOutcome();
}

void UniformGrid::setGrid(int step) const {
  const GridMapping grid(volume_, cols_, rows_);
  glUniform1i(program_.uniform("codes"), kCodesUnit);
  glUniform1i(program_.uniform("picture"), kPictureUnit);
  glUniform2i(program_.uniform("samples"), cols_, rows_);
  glUniform2i(program_.uniform("last"), verticesAlong(cols_, step) - 1, verticesAlong(rows_, step) - 1);
  glUniform1i(program_.uniform("grid_step"), step);
  glUniform1i(program_.uniform("tiles_across"), tilesAlong(cols_, step));
  glUniform4f(program_.uniform("place_mm"), static_cast<float>(grid.x(0)), static_cast<float>(grid.x(1) - grid.x(0)),
              static_cast<float>(grid.y(0)), static_cast<float>(grid.y(1) - grid.y(0)));
  glUniform1f(program_.uniform("depth_mm"), static_cast<float>(volume_.depth_mm));
}

void UniformGrid::drawView(const EyeView& view, int tiles) const {
  glViewport(view.area.x, view.area.y, view.area.width, view.area.height);
  glUniformMatrix4fv(program_.uniform("view_projection"), 1, GL_FALSE, glm::value_ptr(glm::mat4(view.view_projection)));
  glDrawElementsInstanced(GL_TRIANGLES, kTileIndices, GL_UNSIGNED_SHORT, nullptr, tiles);
}

std::size_t UniformGrid::triangles(int step) const noexcept {
  const auto cells = [step](int samples) { return static_cast<std::size_t>(verticesAlong(samples, step) - 1); };
  return 2 * cells(cols_) * cells(rows_);
}

}  // namespace relievo
