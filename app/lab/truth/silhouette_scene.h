// SPDX-License-Identifier: Apache-2.0
// A scene of overlapping objects. It is known everywhere, also where the front view hides a surface that one eye sees.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace relievo {

// A mask nods in front of a wall that is level at the left and a pleated curtain at the right; a ball flies past it,
// and a rod leans over both. Each object is a sheet with a free rim: there is nothing between two of them. In the
// default volume of a picture of 720x486, at most 60 mm/s. Colours have patterns of 2.6 mm and more, which a picture of
// 720 columns can show.
class SilhouetteScene {
 public:
  explicit SilhouetteScene(double t_s);

  // The height of the nearest object, seen straight from the front.
  [[nodiscard]] double height(double x_mm, double y_mm) const;
  [[nodiscard]] glm::dvec3 color(double x_mm, double y_mm) const;  // 0 to 255
  // The colour that a line of sight from `front`, in front of everything, to `back` behind it meets first.
  [[nodiscard]] glm::dvec3 colorAlong(const glm::dvec3& front, const glm::dvec3& back) const;

 private:
  enum Part : std::uint8_t { Wall, Mask, Ball, Rod, kParts };

  // The sheets are defined beyond their rims, too.
  [[nodiscard]] double heightOf(Part part, double x, double y) const;
  [[nodiscard]] bool covers(Part part, double x, double y) const;
  [[nodiscard]] Part nearest(double x, double y) const;
  [[nodiscard]] glm::dvec3 colorOf(Part part, double x, double y) const;

  double t_s_;
  glm::dvec2 origins_[kParts];
  double mask_z_mm_;
};

}  // namespace relievo
