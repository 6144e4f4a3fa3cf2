// SPDX-License-Identifier: Apache-2.0
// Lighting of the sample film: a warm lamp with soft shadows, sky light, a cool rim light, and the tone curve.
#pragma once

#include <algorithm>
#include <array>

#include "app/author/sample/sample_look.h"
#include "app/author/sample/sample_stage.h"

namespace relievo::sample {

using lanes::FloatLanes;
using V = Vec3<FloatLanes>;

inline V vec(double x, double y, double z) {
  return {x, y, z};
}
inline V unit(const V& v) {
  return v * (FloatLanes(1.0) / lanes::length(v));
}

inline constexpr Vec3<double> kKey = {-0.479, 0.585, 0.654};  // towards the lamp, length 1
inline constexpr Vec3<double> kRim = {0.72, 0.42, -0.55};     // towards a window behind
inline constexpr double kLightReachMm = 6;                    // the range of ambient occlusion

struct Light {
  FloatLanes key;  // 0 in the lamp's umbra .. 1 fully lit
  FloatLanes sky;  // share of the sky visible from the point
};

// The penumbra follows from the narrowest gap that the ray to the lamp passes, as an angle from the ray's start.
template <class Scene>
[[nodiscard]] FloatLanes keyLight(const Scene& scene, const V& foot) {
  FloatLanes open = 1.0, s = 0.8;
  for (int i = 0; i < 20; ++i) {
    const V p = foot + vec(kKey.x, kKey.y, kKey.z) * s;
    const FloatLanes d = scene.shade(p);
    open = lanes::min(open, d * 6.0 / s);
    if (!lanes::any((open > 0.0) & (p.z < scene.front()))) break;
    s = s + lanes::clamp<FloatLanes>(d, 0.8 + s * 0.06, 9.0);
  }
  return lanes::smoothStep(open, 0.0, 1.0);
}

template <class Scene>
[[nodiscard]] Light lightAt(const Scene& scene, const V& p, const V& n, Parts parts) {
  FloatLanes hidden = 0.0;
  double weight = 0.55;
  for (const double s : {0.8, 2.2, 4.6}) {
    const V q = p + n * FloatLanes(s);
    const FloatLanes room = lanes::min(scene.solids(q, parts), (q.z - scene.ground(q.x, q.y)) * 0.8);
    hidden = hidden + lanes::max(FloatLanes(s) - room, 0.0) * (weight / s);
    weight *= 0.75;
  }
  return {keyLight(scene, p + n * FloatLanes(0.5)), lanes::clamp<FloatLanes>(1.0 - hidden, 0.25, 1.0)};
}

template <class Scene>
[[nodiscard]] V colorAt(const Scene& scene, const V& p, const V& n, const Light& light, Parts parts) {
  using namespace lanes;
  const MaskLanes on_ground = !(p.z > scene.ground(p.x, p.y) + 1e-4);
  Look<FloatLanes> look{};
  if (any(on_ground)) look = scene.groundLook(p.x, p.y);
  if (parts && any(!on_ground)) {
    const Look<FloatLanes> solid = scene.solidLook(p, parts);
    look = {select(on_ground, look.albedo, solid.albedo), select(on_ground, look.gloss, solid.gloss),
            select(on_ground, look.warmth, solid.warmth)};
  }
  // Skin scatters light around its terminator, red most.
  const FloatLanes facing = dot(n, vec(kKey.x, kKey.y, kKey.z));
  const FloatLanes wrap = look.warmth * 0.25;
  const FloatLanes direct = max((facing + wrap) / (1.0 + wrap), 0.0) * light.key;
  const FloatLanes red = max((facing + wrap * 2.0) / (1.0 + wrap * 2.0), 0.0) * (light.key * 0.85 + 0.15 * look.warmth);
  const V key = vec(1.62, 1.50, 1.30) * V{max(red, direct), direct, direct};
  const V ambient =
      mix(vec(0.23, 0.17, 0.14), vec(0.36, 0.42, 0.52), n.y * 0.5 + 0.5) * (light.sky * (0.55 + 0.45 * n.z));
  const FloatLanes away = 1.0 - clamp<FloatLanes>(n.z, 0.0, 1.0);
  const FloatLanes edge = max(dot(n, vec(kRim.x, kRim.y, kRim.z)) + 0.25, 0.0) * away * away * light.sky;
  const V diffuse = look.albedo * (key + ambient + vec(0.9, 1.0, 1.25) * edge);
  // The lamp's highlight, half way between lamp and eye.
  const FloatLanes h = max(dot(n, unit(vec(kKey.x, kKey.y, kKey.z + 1.0))), 0.0);
  const FloatLanes h2 = h * h, h4 = h2 * h2, h8 = h4 * h4, h16 = h8 * h8;
  return diffuse + vec(1.0, 0.96, 0.9) * (look.gloss * light.key * (h16 * 0.10 + h16 * h16 * h16 * 0.28));
}

// The sRGB curve after a shoulder that keeps highlights from clipping, as a lookup table.
class FilmCurve {
 public:
  FilmCurve() noexcept;
  [[nodiscard]] std::uint8_t operator()(float light) const {
    const float step = std::clamp(light * kScale + 0.5F, 0.0F, static_cast<float>(kSteps));
    return table_[static_cast<std::size_t>(step)];
  }

 private:
  static constexpr int kSteps = 8192;
  static constexpr float kWhite = 4.0F, kScale = kSteps / kWhite;
  std::array<std::uint8_t, kSteps + 1> table_{};
};

}  // namespace relievo::sample
