// SPDX-License-Identifier: Apache-2.0
// A lattice of places, looked at from the middle outward.
#include "app/haptics/touch_place.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace relievo {
namespace {

constexpr int kAcross = 40, kDown = 30;
constexpr double kFingertipMm = 4.0;  // radius
constexpr int kDirections = 12;

bool isSurface(const HeightField& field, const glm::dvec2& at_mm) {
  const long c = std::lround(field.grid().u(at_mm.x)), r = std::lround(field.grid().v(at_mm.y));
  if (c < 0 || r < 0 || c >= field.cols() || r >= field.rows()) return false;
  return !std::isnan(field.heightMm(static_cast<int>(c), static_cast<int>(r)));
}

bool fitsFingertip(const HeightField& field, const glm::dvec2& at_mm) {
  if (!isSurface(field, at_mm)) return false;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const glm::dvec2 way(std::cos(angle), std::sin(angle));
    if (!isSurface(field, at_mm + kFingertipMm * way) || !isSurface(field, at_mm + 0.5 * kFingertipMm * way)) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<glm::dvec2> placeToTouch(const HeightField& field) {
  std::vector<glm::dvec2> places{{0, 0}};
  for (int r = 0; r < kDown; ++r) {
    for (int c = 0; c < kAcross; ++c) {
      places.emplace_back(field.grid().x((c + 0.5) / kAcross * field.cols() - 0.5),
                          field.grid().y((r + 0.5) / kDown * field.rows() - 0.5));
    }
  }
  std::sort(places.begin(), places.end(),
            [](const glm::dvec2& a, const glm::dvec2& b) { return glm::dot(a, a) < glm::dot(b, b); });
  const auto found = std::find_if(places.begin(), places.end(), [&](const auto& p) { return fitsFingertip(field, p); });
  return found == places.end() ? std::nullopt : std::optional(*found);
}

}  // namespace relievo
