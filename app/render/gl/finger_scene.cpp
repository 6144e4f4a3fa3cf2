// SPDX-License-Identifier: Apache-2.0
// A shadow to the lower right, farther away and fainter the higher the finger is above the surface, and a glow at the
// contact, brighter the larger the force.
#include "app/render/gl/finger_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>

#include "app/render/gl/scene_renderer.h"

namespace relievo {
namespace {

constexpr double kShadowSlant = 0.35, kShadowRadiusMm = 4.5, kShadowGrowth = 0.15;
constexpr double kShadowOpacity = 0.65, kShadowHalfMm = 15;
constexpr double kGlowRadiusMm = 7.0, kGlowOpacity = 0.35, kGlowPerN = 0.1;

}  // namespace

Result<FingerScene> FingerScene::create() {
  FingerScene scene;
  auto on_surface = SurfaceMark::create();
  if (!on_surface) return std::unexpected(on_surface.error());
  auto finger = FingerModel::create();
  if (!finger) return std::unexpected(finger.error());
  scene.on_surface_ = std::move(*on_surface);
  scene.finger_ = std::move(*finger);
  return scene;
}

void FingerScene::draw(const glm::dmat4& view_projection, const HeightField* field, const FingerMark& mark,
                       const FingerPaint& paint) {
  if (field != nullptr) {
    const glm::dvec2 under(mark.position_mm);
    const double gap = std::max(0.0, mark.position_mm.z - SurfaceMark::heightUnder(*field, under.x, under.y));
    on_surface_.draw(view_projection, *field,
                     {.center_mm = under + glm::dvec2(kShadowSlant, -kShadowSlant) * gap,
                      .radius_mm = kShadowRadiusMm + kShadowGrowth * gap,
                      .color = glm::vec3(0),
                      .opacity = static_cast<float>(kShadowOpacity / (1 + gap / kShadowHalfMm))});
    const double force = glm::length(mark.force_n);
    if (mark.contact) {
      on_surface_.draw(view_projection, *field,
                       {.center_mm = under,
                        .radius_mm = kGlowRadiusMm,
                        .color = paint.glow,
                        .opacity = static_cast<float>(std::min(1.0, kGlowOpacity + kGlowPerN * force))});
    }
  }
  finger_.draw(view_projection, mark, paint);
}

}  // namespace relievo
