// SPDX-License-Identifier: Apache-2.0
// Descent of the distance from face to face.
#include "app/haptics/baseline/face_walk.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace relievo {
namespace {

constexpr int kMaxSteps = 256;
constexpr double kLeastGain = 1e-12;  // mm^2 of the squared distance: a smaller gain is rounding

// Which part of a triangle the closest point lies on: bit per corner that has a share in it.
struct Closest {
  glm::dvec3 point{0};
  double squared = std::numeric_limits<double>::infinity();
  std::uint8_t corners = 0;
};

// The closest point of a triangle by its Voronoi regions (Ericson, Real-Time Collision Detection, 5.1.5).
Closest closestOnTriangle(const std::array<glm::dvec3, 3>& t, const glm::dvec3& p) RELIEVO_RT {
  const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const auto found = [&p](const glm::dvec3& point, unsigned corners) RELIEVO_RT {
    const glm::dvec3 away = point - p;
    return Closest{point, glm::dot(away, away), static_cast<std::uint8_t>(corners)};
  };
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return found(t[0], 1);
  const glm::dvec3 bp = p - t[1];
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return found(t[1], 2);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return found(t[0] + ab * (d1 / (d1 - d3)), 1 | 2);
  const glm::dvec3 cp = p - t[2];
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return found(t[2], 4);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return found(t[0] + ac * (d2 / (d2 - d6)), 1 | 4);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    return found(t[1] + (t[2] - t[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 2 | 4);
  }
  const double scale = 1 / (va + vb + vc);
  return found(t[0] + ab * (vb * scale) + ac * (vc * scale), 7);
}

struct Node {
  int c, r;
};

// Corner 0 is (c, r), corner 1 the one that only this triangle of the cell has, corner 2 (c+1, r+1).
std::array<Node, 3> corners(const GridTriangle& t) RELIEVO_RT {
  return {{{t.c, t.r}, t.right ? Node{t.c + 1, t.r} : Node{t.c, t.r + 1}, {t.c + 1, t.r + 1}}};
}

// The triangle on the other side of the edge that does not touch the corner.
GridTriangle beyond(const GridTriangle& t, unsigned opposite) RELIEVO_RT {
  if (opposite == 1) return {t.c, t.r, !t.right};  // over the diagonal
  // Opposite of corner 0 lies the edge 1-2: right of the right triangle, below the left one; of corner 2 the edge 0-1.
  if (opposite == 0) return t.right ? GridTriangle{t.c + 1, t.r, false} : GridTriangle{t.c, t.r + 1, true};
  return t.right ? GridTriangle{t.c, t.r - 1, false} : GridTriangle{t.c - 1, t.r, true};
}

}  // namespace

glm::dvec3 walkFacesToClosest(const SurfaceInTime& surface, const Crossing& crossing,
                              const glm::dvec3& hip_mm) RELIEVO_RT {
  GridTriangle here = crossing.triangle;
  Closest best{.point = crossing.point_mm};
  const auto tryFace = [&](const GridTriangle& t) RELIEVO_RT {
    const std::array<Node, 3> n = corners(t);
    const std::array<glm::dvec3, 3> points{surface.vertex(n[0].c, n[0].r), surface.vertex(n[1].c, n[1].r),
                                           surface.vertex(n[2].c, n[2].r)};
    if (std::isnan(points[0].z + points[1].z + points[2].z)) return;
    const Closest found = closestOnTriangle(points, hip_mm);
    if (!(found.squared < best.squared - kLeastGain)) return;
    best = found;
    here = t;
  };
  tryFace(crossing.triangle);
  for (int step = 0; step < kMaxSteps; ++step) {
    const double before = best.squared;
    const GridTriangle from = here;
    switch (best.corners) {
      case 1 | 2:
        tryFace(beyond(from, 2));
        break;
      case 1 | 4:
        tryFace(beyond(from, 1));
        break;
      case 2 | 4:
        tryFace(beyond(from, 0));
        break;
      case 1:
      case 2:
      case 4: {
        const Node n = corners(from)[best.corners >> 1U];
        for (const GridTriangle& t : {GridTriangle{n.c, n.r, true}, GridTriangle{n.c, n.r, false},
                                      GridTriangle{n.c - 1, n.r, true}, GridTriangle{n.c - 1, n.r - 1, true},
                                      GridTriangle{n.c - 1, n.r - 1, false}, GridTriangle{n.c, n.r - 1, false}}) {
          tryFace(t);
        }
        break;
      }
      default:
        return best.point;
    }
    if (!(best.squared < before)) break;
  }
  return best.point;
}

}  // namespace relievo
