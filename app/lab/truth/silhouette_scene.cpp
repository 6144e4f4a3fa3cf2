// SPDX-License-Identifier: Apache-2.0
// Four sheets, each a formula and a rim.
#include "app/lab/truth/silhouette_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/lab/truth/true_shapes.h"

namespace relievo {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMaskHalfWidthMm = 42, kMaskHalfHeightMm = 40;
constexpr double kBallRadiusMm = 12, kBallRimMm = 0.96 * kBallRadiusMm;  // up to where it slopes 3.4 in 1
constexpr double kRodHalfLengthMm = 38, kRodHalfWidthMm = 2.5, kRodRadiusMm = 3;

// Along the rod and aside of it.
glm::dvec2 onRod(double x, double y) {
  constexpr double kX = 0.28, kY = 0.96;  // a unit vector
  return {kX * x + kY * y, kY * x - kX * y};
}

double ofWall(double x, double y, double t_s) {
  constexpr double kPleatMm = 9;
  const double place = x - 8 - 1.5 * std::sin(0.05 * y + 0.8 * t_s);
  const double deep_mm = 4 * std::clamp(place / 50, 0.0, 1.0);
  return 2 + 0.02 * (x + 80) + deep_mm * std::abs(std::sin(std::numbers::pi * place / kPleatMm));
}
double ofMask(double x, double y) {
  constexpr double kFlatter = 0.75;
  return kFlatter * (shapes::Face{}(x, y) - shapes::Face::kFloorMm);
}
double ofBall(double x, double y) {
  constexpr double kCentreZMm = 24;
  const double from_middle = std::min(x * x + y * y, kBallRimMm * kBallRimMm);
  return kCentreZMm + std::sqrt(kBallRadiusMm * kBallRadiusMm - from_middle);
}
double ofRod(double x, double y) {
  const glm::dvec2 at = onRod(x, y);
  const double aside = std::clamp(at.y, -kRodHalfWidthMm, kRodHalfWidthMm);
  return 26 + 0.15 * at.x + std::sqrt(kRodRadiusMm * kRodRadiusMm - aside * aside);
}

double pattern(const glm::dvec2& at) {
  struct Wave {
    double x_per_mm, y_per_mm, share;
  };
  constexpr Wave kWaves[] = {{0.35, 0.16, 0.20}, {-0.10, 0.23, 0.16}, {0.11, -0.09, 0.12}, {0.04, 0.06, 0.10}};
  double sum = 1;
  for (const Wave& wave : kWaves) sum += wave.share * std::sin(kTurn * (wave.x_per_mm * at.x + wave.y_per_mm * at.y));
  return sum;
}

}  // namespace

SilhouetteScene::SilhouetteScene(double t_s)
    : t_s_(t_s),
      origins_{glm::dvec2(0),
               {-4 + 4 * std::sin(kTurn * 0.53 * t_s), 2},
               {-52 + 60 * t_s, -26 + 8 * std::sin(kTurn * 0.5 * t_s)},
               {44 - 6 * t_s, 10}},
      mask_z_mm_(7 + 2 * std::sin(kTurn * 0.71 * t_s)) {}

double SilhouetteScene::heightOf(Part part, double x, double y) const {
  x -= origins_[part].x;
  y -= origins_[part].y;
  switch (part) {
    case Mask:
      return mask_z_mm_ + ofMask(x, y);
    case Ball:
      return ofBall(x, y);
    case Rod:
      return ofRod(x, y);
    default:
      return ofWall(x, y, t_s_);
  }
}

bool SilhouetteScene::covers(Part part, double x, double y) const {
  x -= origins_[part].x;
  y -= origins_[part].y;
  switch (part) {
    case Mask: {
      const double across = x / kMaskHalfWidthMm, down = y / kMaskHalfHeightMm;
      return across * across + down * down <= 1;
    }
    case Ball:
      return x * x + y * y <= kBallRimMm * kBallRimMm;
    case Rod: {
      const glm::dvec2 at = onRod(x, y);
      return std::abs(at.x) <= kRodHalfLengthMm && std::abs(at.y) <= kRodHalfWidthMm;
    }
    default:
      return true;
  }
}

SilhouetteScene::Part SilhouetteScene::nearest(double x, double y) const {
  Part found = Wall;
  for (const Part part : {Mask, Ball, Rod}) {
    if (covers(part, x, y) && heightOf(part, x, y) > heightOf(found, x, y)) found = part;
  }
  return found;
}

double SilhouetteScene::height(double x_mm, double y_mm) const {
  return heightOf(nearest(x_mm, y_mm), x_mm, y_mm);
}

glm::dvec3 SilhouetteScene::color(double x_mm, double y_mm) const {
  return colorOf(nearest(x_mm, y_mm), x_mm, y_mm);
}

glm::dvec3 SilhouetteScene::colorOf(Part part, double x, double y) const {
  static const glm::dvec3 kColors[kParts] = {{108, 122, 140}, {150, 116, 96}, {168, 60, 52}, {146, 140, 70}};
  static const glm::dvec3 kToLight = glm::normalize(glm::dvec3(-0.45, 0.5, 0.75));
  constexpr double kAmbient = 0.35, kStepMm = 0.05;
  const double z = heightOf(part, x, y);
  const double slope_x = (heightOf(part, x + kStepMm, y) - z) / kStepMm;
  const double slope_y = (heightOf(part, x, y + kStepMm) - z) / kStepMm;
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-slope_x, -slope_y, 1));
  const double lit = kAmbient + (1 - kAmbient) * std::max(0.0, glm::dot(normal, kToLight));
  return kColors[part] * (lit * pattern(glm::dvec2(x, y) - origins_[part]));
}

// For each sheet, iterates: from a height to the line's position there, and on to the sheet's height at that position.
// Lines are a fifth as slanted as sheets are steep, so the iteration converges.
glm::dvec3 SilhouetteScene::colorAlong(const glm::dvec3& front, const glm::dvec3& back) const {
  constexpr int kMostSteps = 40;
  constexpr double kCloseMm = 1e-4;
  const glm::dvec3 way = (back - front) / (back.z - front.z);  // for a millimetre of height
  const auto at = [&](double z) { return front + way * (z - front.z); };
  Part found = Wall;
  glm::dvec3 where(0, 0, -1);
  for (const Part part : {Wall, Mask, Ball, Rod}) {
    double z = 20, before = -1;
    for (int i = 0; i < kMostSteps && std::abs(z - before) > kCloseMm; ++i) {
      before = z;
      z = heightOf(part, at(z).x, at(z).y);
    }
    if (z <= where.z || !covers(part, at(z).x, at(z).y)) continue;
    where = at(z);
    found = part;
  }
  return colorOf(found, where.x, where.y);
}

}  // namespace relievo
