// SPDX-License-Identifier: Apache-2.0
// The Delaunay triangulation of a rectangle into which points are inserted one by one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace relievo {

// Unlike OpenCV's cv::Subdiv2D, which decides in single precision and does not report the triangles that changed.
// Coordinates are whole numbers up to 16383, so that every decision is exact, also for points on a common line or
// circle. The triangles cover the whole rectangle.
class Delaunay {
 public:
  struct Point {
    int x = 0, y = 0;
    bool operator==(const Point&) const = default;
  };
  using Triangle = std::array<int, 3>;  // indices of points, ordered from x towards y

  // Starts with the corners (0, 0), (right, 0), (right, bottom), (0, bottom), which are points 0 to 3, and two
  // triangles. right and bottom must be at least 1.
  Delaunay(int right, int bottom);

  // Inserts a new point inside or on the edge of `triangle`, not at a corner. Returns the new or changed triangles,
  // which are those around the point; valid until the next call. Triangles are never removed, but any may change.
  std::span<const int> insert(const Point& point, int triangle);

  [[nodiscard]] const std::vector<Point>& points() const noexcept { return points_; }
  [[nodiscard]] const std::vector<Triangle>& triangles() const noexcept { return triangles_; }

 private:
  static constexpr int kNone = -1;
  static constexpr int triangleOf(int edge) { return edge / 3; }
  static constexpr int next(int edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }

  int addTriangle();
  void set(int triangle, int a, int b, int c, int beside_ab);
  void join(int edge, int other);
  void split(int triangle, int point);
  void splitEdge(int edge, int point);
  void flipWhereNeeded(int triangle);
  [[nodiscard]] int pointOf(int edge) const { return triangles_[triangleOf(edge)][edge % 3]; }

  std::vector<Point> points_;
  std::vector<Triangle> triangles_;
  std::vector<int>
      beside_;  // by edge 3 t + k, from corner k of triangle t to the next: the neighbour's index of the same edge
  std::vector<int> around_;  // triangles around the newest point
};

// Twice the signed area: positive if a, b, c turn from x towards y.
[[nodiscard]] constexpr std::int64_t turn(const Delaunay::Point& a, const Delaunay::Point& b,
                                          const Delaunay::Point& c) {
  return static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) - static_cast<std::int64_t>(b.y - a.y) * (c.x - a.x);
}
// Positive if d lies inside the circle through a, b, c, which must turn positively.
[[nodiscard]] std::int64_t insideCircle(const Delaunay::Point& a, const Delaunay::Point& b, const Delaunay::Point& c,
                                        const Delaunay::Point& d);

}  // namespace relievo
