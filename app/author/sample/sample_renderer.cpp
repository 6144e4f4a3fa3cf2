// SPDX-License-Identifier: Apache-2.0
// Casts one ray per pixel for depth, shades the hits, and casts four rays per pixel at edges to smooth them.
#include "app/author/sample/sample_renderer.h"

#include <atomic>
#include <thread>

#include "app/author/sample/sample_light.h"
#include "app/author/sample/sample_scene.h"
#include "app/author/sample/sample_stage.h"

namespace relievo {
namespace {

using namespace sample;
using lanes::FloatLanes;
using lanes::FloatVector;
using lanes::Vec3;

struct Raster {
  int cols, rows;
  [[nodiscard]] double x(double c) const { return ((c + 0.5) / cols - 0.5) * SampleFilm::kWidthMm; }
  [[nodiscard]] double y(double r) const { return (0.5 - (r + 0.5) / rows) * SampleFilm::kHeightMm; }
  [[nodiscard]] std::size_t at(int c, int r) const {
    return static_cast<std::size_t>(std::clamp(r, 0, rows - 1)) * static_cast<std::size_t>(cols) +
           static_cast<std::size_t>(std::clamp(c, 0, cols - 1));
  }
};

constexpr int kTile = 16;
constexpr int kHalf = kTile / 2;
constexpr double kMiddle = 0.5 * kHalf;  // half the size of a quarter tile

// Five passes over the picture's tiles, each on all threads: cast, gather light on every second pixel, shade, find
// edges, smooth them.
template <class Scene>
class Painter {
 public:
  Painter(const Scene& scene, SamplePicture& picture)
      : scene_(scene),
        picture_(picture),
        raster_{picture.cols, picture.rows},
        light_cols_((picture.cols + 1) / 2 + 1),
        heights_(picture.depth.size()),
        edges_(picture.depth.size()),
        light_(static_cast<std::size_t>(light_cols_) * static_cast<std::size_t>((picture.rows + 1) / 2 + 1)) {}

  void cast(int c0, int r0) {
    const Parts parts = scene_.partsNear(box(c0, r0));
    // One ray for each quarter of the tile, stopped before it can hit anything in that quarter.
    const double reach = 1.25 * kMiddle * std::hypot(raster_.x(1) - raster_.x(0), raster_.y(1) - raster_.y(0)) + 0.1;
    const double cl = c0 + kMiddle - 0.5, cr = cl + kHalf, rt = r0 + kMiddle - 0.5, rb = rt + kHalf;
    const FloatLanes qx = four(raster_.x(cl), raster_.x(cr), raster_.x(cl), raster_.x(cr));
    const FloatLanes qy = four(raster_.y(rt), raster_.y(rt), raster_.y(rb), raster_.y(rb));
    const FloatLanes start =
        parts ? march<FloatLanes>(scene_, qx, qy, scene_.front(), 0.0, reach, parts) : FloatLanes(0.0);
    forTile(c0, r0, [&](int c, int r, int count) {
      const FloatLanes z0 = static_cast<double>(start[(r >= r0 + kHalf ? 2 : 0) + (c >= c0 + kHalf ? 1 : 0)]);
      const Hit hit = castQuad(lanes::ramp(raster_.x(c), raster_.x(1) - raster_.x(0)), raster_.y(r), z0, parts);
      for (int i = 0; i < count; ++i) {
        const std::size_t at = raster_.at(c + i, r);
        heights_[at] = {hit.p.z[i], hit.normal.x[i], hit.normal.y[i], hit.normal.z[i]};
        picture_.depth[at] =
            static_cast<std::uint8_t>(std::lround(hit.p.z[i] * static_cast<float>(255 / kStageDepthMm)));
      }
    });
  }

  // The light lattice has a point on every second pixel of every second row, and one line more at the far edges.
  void gather(int c0, int r0) {
    const Parts parts = scene_.partsNear(box(c0, r0).grown(kLightReachMm));
    const bool last_col = c0 + kTile >= picture_.cols, last_row = r0 + kTile >= picture_.rows;
    const int j1 = last_row ? (picture_.rows + 1) / 2 + 1 : (r0 + kTile) / 2;
    const int i1 = last_col ? light_cols_ : (c0 + kTile) / 2;
    for (int j = r0 / 2; j < j1; ++j) {
      for (int i = c0 / 2; i < i1; i += lanes::kLanes) {
        const Surface s = surfaceAt(2 * i, 2 * j, 2);
        const Light light =
            lightAt(scene_, {lanes::ramp(raster_.x(2 * i), raster_.x(2) - raster_.x(0)), raster_.y(2 * j), s.z},
                    s.normal, parts);
        for (int k = 0; k < lanes::kLanes && i + k < i1; ++k) {
          light_[static_cast<std::size_t>(j) * static_cast<std::size_t>(light_cols_) +
                 static_cast<std::size_t>(i + k)] = {light.key[k], light.sky[k], s.z[k]};
        }
      }
    }
  }

  void shade(int c0, int r0) {
    const Parts parts = scene_.partsNear(box(c0, r0));
    forTile(c0, r0, [&](int c, int r, int count) {
      const Surface s = surfaceAt(c, r, 1);
      const Vec3<FloatLanes> p = {lanes::ramp(raster_.x(c), raster_.x(1) - raster_.x(0)), raster_.y(r), s.z};
      const Vec3<FloatLanes> color = colorAt(scene_, p, s.normal, lightOver(lanes::ramp(c, 1), r, s.z), parts);
      for (int i = 0; i < count; ++i) put(c + i, r, color.x[i], color.y[i], color.z[i]);
    });
  }

  void findEdges(int c0, int r0) {
    forPixels(c0, r0, [&](int c, int r) { edges_[raster_.at(c, r)] = isEdge(c, r) ? 1 : 0; });
  }

  void smooth(int c0, int r0) {
    const Parts parts = scene_.partsNear(box(c0, r0));
    forPixels(c0, r0, [&](int c, int r) {
      if (edges_[raster_.at(c, r)] != 0) shadeEdge(c, r, parts);
    });
  }

 private:
  struct Sample {
    float z, nx, ny, nz;
  };
  struct LightSample {
    float key, sky, z;
  };
  struct Surface {
    FloatLanes z;
    Vec3<FloatLanes> normal;
  };
  struct Hit {
    Vec3<FloatLanes> p, normal;
  };

  static FloatLanes four(double a, double b, double c, double d) {
    return FloatVector{static_cast<float>(a), static_cast<float>(b), static_cast<float>(c), static_cast<float>(d)};
  }
  template <class Quad>
  void forTile(int c0, int r0, Quad quad) const {
    const int c1 = std::min(c0 + kTile, picture_.cols), r1 = std::min(r0 + kTile, picture_.rows);
    for (int r = r0; r < r1; ++r) {
      for (int c = c0; c < c1; c += lanes::kLanes) quad(c, r, std::min(lanes::kLanes, c1 - c));
    }
  }
  [[nodiscard]] Box2 box(int c0, int r0) const {
    return {raster_.x(c0 - 1), raster_.x(c0 + kTile + 1), raster_.y(r0 + kTile + 1), raster_.y(r0 - 1)};
  }

  // Four evaluations give both the last step to the surface and its normal.
  [[nodiscard]] Hit castQuad(FloatLanes x, FloatLanes y, FloatLanes start, Parts parts) const {
    const FloatLanes ground = scene_.ground(x, y);
    constexpr double e = 0.02;
    Hit hit = {{x, y, ground}, {}};
    lanes::MaskLanes on_ground = {FloatVector{} == FloatVector{}};
    if (parts) {
      const FloatLanes z = descend<FloatLanes>(scene_, x, y, lanes::max(start, ground), ground - 0.1, parts);
      const FloatLanes here = scene_.solids({x, y, z}, parts);
      const Vec3<FloatLanes> slope = {scene_.solids({x + e, y, z}, parts) - here,
                                      scene_.solids({x, y + e, z}, parts) - here,
                                      scene_.solids({x, y, z + e}, parts) - here};
      const FloatLanes top = polished<FloatLanes>(z, here, slope.z * (1 / e));
      on_ground = !(top > ground);
      hit.p.z = lanes::select(on_ground, ground, top);
      hit.normal = slope;
    }
    if (lanes::any(on_ground)) {
      const Vec3<FloatLanes> up = {ground - scene_.ground(x + e, y), ground - scene_.ground(x, y + e), e};
      hit.normal = lanes::select(on_ground, up, hit.normal);
    }
    hit.normal = unit(hit.normal);
    return hit;
  }

  [[nodiscard]] Surface surfaceAt(int c, int r, int step) const {
    const Sample s[4] = {heights_[raster_.at(c, r)], heights_[raster_.at(c + step, r)],
                         heights_[raster_.at(c + 2 * step, r)], heights_[raster_.at(c + 3 * step, r)]};
    return {FloatVector{s[0].z, s[1].z, s[2].z, s[3].z},
            {FloatVector{s[0].nx, s[1].nx, s[2].nx, s[3].nx}, FloatVector{s[0].ny, s[1].ny, s[2].ny, s[3].ny},
             FloatVector{s[0].nz, s[1].nz, s[2].nz, s[3].nz}}};
  }

  // Interpolates light from the lattice points on the same surface.
  [[nodiscard]] Light lightOver(FloatLanes cols, FloatLanes rows, FloatLanes z) const {
    Light light = {0.0, 0.0};
    for (int lane = 0; lane < lanes::kLanes; ++lane) {
      const float u = std::clamp(cols[lane] * 0.5F, 0.0F, static_cast<float>(light_cols_) - 1.001F);
      const int last_row = (picture_.rows + 1) / 2;
      const float v = std::clamp(rows[lane] * 0.5F, 0.0F, static_cast<float>(last_row) - 0.001F);
      const int i = static_cast<int>(u), j = static_cast<int>(v);
      const float fu = u - static_cast<float>(i), fv = v - static_cast<float>(j);
      const LightSample* row =
          &light_[static_cast<std::size_t>(j) * static_cast<std::size_t>(light_cols_) + static_cast<std::size_t>(i)];
      float weights = 0, key = 0, sky = 0;
      const auto add = [&](const LightSample& s, float share) {
        const float gap = s.z - z[lane];
        const float w = (share + 1e-4F) / (0.02F + gap * gap);
        weights += w;
        key += w * s.key;
        sky += w * s.sky;
      };
      add(row[0], (1 - fu) * (1 - fv));
      add(row[1], fu * (1 - fv));
      add(row[light_cols_], (1 - fu) * fv);
      add(row[light_cols_ + 1], fu * fv);
      light.key.v[lane] = key / weights;
      light.sky.v[lane] = sky / weights;
    }
    return light;
  }

  template <class Pixel>
  void forPixels(int c0, int r0, Pixel pixel) const {
    for (int r = r0; r < std::min(r0 + kTile, picture_.rows); ++r) {
      for (int c = c0; c < std::min(c0 + kTile, picture_.cols); ++c) pixel(c, r);
    }
  }

  // Where height or colour jumps, as between hair and skin.
  [[nodiscard]] bool isEdge(int c, int r) const {
    constexpr float kJumpMm = 0.8F;
    constexpr int kContrast = 40;
    const std::size_t here = raster_.at(c, r);
    const auto jumps = [&](int cc, int rr) {
      const std::size_t there = raster_.at(cc, rr);
      return std::abs(heights_[there].z - heights_[here].z) > kJumpMm ||
             std::abs(picture_.rgb[3 * there + 1] - picture_.rgb[3 * here + 1]) > kContrast;
    };
    return jumps(c - 1, r) || jumps(c + 1, r) || jumps(c, r - 1) || jumps(c, r + 1);
  }

  // Four rays in a rotated square: no two share a row or a column.
  void shadeEdge(int c, int r, Parts parts) {
    const FloatLanes cols = four(c - 0.375, c - 0.125, c + 0.125, c + 0.375);
    const FloatLanes rows = four(r + 0.125, r - 0.375, r + 0.375, r - 0.125);
    const FloatLanes x = four(raster_.x(c - 0.375), raster_.x(c - 0.125), raster_.x(c + 0.125), raster_.x(c + 0.375));
    const FloatLanes y = four(raster_.y(r + 0.125), raster_.y(r - 0.375), raster_.y(r + 0.375), raster_.y(r - 0.125));
    float top = 0;
    for (int rr = r - 1; rr <= r + 1; ++rr) {
      for (int cc = c - 1; cc <= c + 1; ++cc) top = std::max(top, heights_[raster_.at(cc, rr)].z);
    }
    const Hit hit = castQuad(x, y, static_cast<double>(top) + 0.5, parts);
    const Vec3<FloatLanes> color = colorAt(scene_, hit.p, hit.normal, lightOver(cols, rows, hit.p.z), parts);
    put(c, r, mean(color.x), mean(color.y), mean(color.z));
  }

  static float mean(FloatLanes v) { return 0.25F * (v[0] + v[1] + v[2] + v[3]); }
  void put(int c, int r, float red, float green, float blue) {
    std::uint8_t* pixel = &picture_.rgb[3 * raster_.at(c, r)];
    pixel[0] = curve_(red);
    pixel[1] = curve_(green);
    pixel[2] = curve_(blue);
  }

  static inline const FilmCurve curve_;
  const Scene& scene_;
  SamplePicture& picture_;
  Raster raster_;
  int light_cols_;
  std::vector<Sample> heights_;
  std::vector<std::uint8_t> edges_;
  std::vector<LightSample> light_;
};

template <class Work>
void overTiles(const SamplePicture& picture, int threads, Work work) {
  const int across = (picture.cols + kTile - 1) / kTile, down = (picture.rows + kTile - 1) / kTile;
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int i = next.fetch_add(1); i < across * down; i = next.fetch_add(1))
      work(i % across * kTile, i / across * kTile);
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(run);
  run();
}

template <class Scene>
void paint(const Scene& scene, int threads, SamplePicture& picture) {
  Painter<Scene> painter(scene, picture);
  overTiles(picture, threads, [&](int c, int r) { painter.cast(c, r); });
  overTiles(picture, threads, [&](int c, int r) { painter.gather(c, r); });
  overTiles(picture, threads, [&](int c, int r) { painter.shade(c, r); });
  overTiles(picture, threads, [&](int c, int r) { painter.findEdges(c, r); });
  overTiles(picture, threads, [&](int c, int r) { painter.smooth(c, r); });
}

}  // namespace

void renderSample(double t_s, int threads, SamplePicture& picture) {
  const auto pixels = static_cast<std::size_t>(picture.cols) * static_cast<std::size_t>(picture.rows);
  picture.rgb.resize(3 * pixels);
  picture.depth.resize(pixels);
  const double t = std::clamp(t_s, 0.0, SampleFilm::kSeconds);
  if (t < SampleFilm::kCutSeconds) {
    paint(Portrait<FloatLanes>(t), threads, picture);
  } else {
    paint(StillLife<FloatLanes>(t), threads, picture);
  }
}

}  // namespace relievo
