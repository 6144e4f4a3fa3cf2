// SPDX-License-Identifier: Apache-2.0
// Steepest descent of the distance on the graph of edges.
#include "app/haptics/baseline/graph_walk.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace relievo {
namespace {

// 5 m/s over the finest picture (3840 columns on 160 mm) is 120 edges a tick.
constexpr int kMaxSteps = 256;
// A step must gain this much of the squared distance, mm^2: less is rounding.
constexpr double kLeastGain = 1e-12;

struct Node {
  int c = 0, r = 0;
  friend bool operator==(const Node&, const Node&) = default;
};

// The six neighbours of a vertex, around it; each with the next one closes a triangle.
constexpr std::array<Node, 6> kRing{{{1, 0}, {1, 1}, {0, 1}, {-1, 0}, {-1, -1}, {0, -1}}};

// A place on the graph: on the edge a-b, or on the vertex a when a == b.
struct Place {
  Node a, b;
  glm::dvec3 point{0};
  double squared = 0;  // distance to the finger
};

class Walk {
 public:
  Walk(const SurfaceInTime& surface, const glm::dvec3& hip) RELIEVO_RT : surface_(surface), hip_(hip) {}

  [[nodiscard]] glm::dvec3 from(const GridTriangle& triangle, const glm::dvec3& fallback) RELIEVO_RT {
    const Node a{triangle.c, triangle.r}, across{triangle.c + 1, triangle.r + 1};
    const Node corner = triangle.right ? Node{triangle.c + 1, triangle.r} : Node{triangle.c, triangle.r + 1};
    best_ = {a, a, fallback, std::numeric_limits<double>::infinity()};
    tryEdge(a, across);
    tryEdge(a, corner);
    tryEdge(corner, across);
    for (int step = 0; step < kMaxSteps && advance(); ++step) {
    }
    return best_.point;
  }

 private:
  [[nodiscard]] glm::dvec3 at(const Node& n) const RELIEVO_RT { return surface_.vertex(n.c, n.r); }

  // Takes the closest point of the edge a-b if it is closer than the best so far. Where an end is no number (a hole, or
  // outside) no comparison holds, and the edge is passed over.
  void tryEdge(const Node& a, const Node& b) RELIEVO_RT { tryEdge(a, at(a), b, at(b)); }
  void tryEdge(const Node& a, const glm::dvec3& pa, const Node& b, const glm::dvec3& pb) RELIEVO_RT {
    const glm::dvec3 along = pb - pa;
    double t = glm::dot(hip_ - pa, along) / glm::dot(along, along);
    t = t < 0 ? 0 : (t > 1 ? 1 : t);
    const glm::dvec3 point = pa + along * t;
    const glm::dvec3 away = point - hip_;
    const double squared = glm::dot(away, away);
    if (!(squared < best_.squared - kLeastGain)) return;
    best_ = {t == 1.0 ? b : a, t == 0.0 ? a : b, point, squared};
  }

  // One step; false at the minimum.
  bool advance() RELIEVO_RT {
    const Place here = best_;
    if (here.a == here.b) aroundVertex(here.a);
    else besideEdge(here.a, here.b);
    return best_.squared < here.squared;
  }
  void aroundVertex(const Node& n) RELIEVO_RT {
    const glm::dvec3 centre = at(n);
    Node previous{n.c + kRing[5].c, n.r + kRing[5].r};
    glm::dvec3 previous_point = at(previous);
    for (const Node& offset : kRing) {
      const Node next{n.c + offset.c, n.r + offset.r};
      const glm::dvec3 next_point = at(next);
      // An edge is part of the surface only where a whole triangle is.
      if (!std::isnan(previous_point.z + next_point.z)) {
        tryEdge(n, centre, previous, previous_point);
        tryEdge(n, centre, next, next_point);
        tryEdge(previous, previous_point, next, next_point);
      }
      previous = next;
      previous_point = next_point;
    }
  }
  // Both triangles that share the edge a-b: their third corners are the common neighbours of a and b, found on the ring
  // around a just before and just after b.
  void besideEdge(const Node& a, const Node& b) RELIEVO_RT {
    const Node offset{b.c - a.c, b.r - a.r};
    std::size_t i = 0;
    while (i < kRing.size() && !(kRing[i] == offset)) ++i;
    if (i == kRing.size()) return;
    const glm::dvec3 pa = at(a), pb = at(b);
    for (const std::size_t side : {(i + 1) % 6, (i + 5) % 6}) {
      const Node third{a.c + kRing[side].c, a.r + kRing[side].r};
      const glm::dvec3 p = at(third);
      tryEdge(a, pa, third, p);
      tryEdge(b, pb, third, p);
    }
  }

  const SurfaceInTime& surface_;
  glm::dvec3 hip_;
  Place best_;
};

}  // namespace

glm::dvec3 walkToClosest(const SurfaceInTime& surface, const Crossing& crossing, const glm::dvec3& hip_mm) RELIEVO_RT {
  return Walk(surface, hip_mm).from(crossing.triangle, crossing.point_mm);
}

}  // namespace relievo
