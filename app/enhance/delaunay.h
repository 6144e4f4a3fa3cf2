// SPDX-License-Identifier: Apache-2.0
// The Delaunay triangulation of a rectangle that points are put into one by one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace relievo {

// OpenCV's cv::Subdiv2D decides in single precision and does not tell which triangles a point has changed.
// Points have whole-number coordinates up to 16383, so that every decision is exact: no four of them upset it, in
// whatever line or circle they stand. All of the rectangle is covered, its rim included.
class Delaunay {
 public:
  struct Point {
    int x = 0, y = 0;
    bool operator==(const Point&) const = default;
  };
  using Triangle = std::array<int, 3>;  // indices of points, in the order of x towards y

  // Begins with the corners (0, 0), (right, 0), (right, bottom), (0, bottom), which are points 0 to 3, and two
  // triangles. right and bottom are 1 at least.
  Delaunay(int right, int bottom);

  // A new point inside or on the rim of `triangle`, and none of its corners. The triangles that are new or other than
  // they were are those around the point; valid until the next call. No triangle goes away, but any may change.
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
      beside_;  // by edge, 3 t + k, from corner k of triangle t to the next: the same edge of its neighbour
  std::vector<int> around_;  // of the newest point
};

// Positive where a, b, c turn from x towards y; twice the area.
[[nodiscard]] constexpr std::int64_t turn(const Delaunay::Point& a, const Delaunay::Point& b,
                                          const Delaunay::Point& c) {
  return static_cast<std::int64_t>(b.x - a.x) * (c.y - a.y) - static_cast<std::int64_t>(b.y - a.y) * (c.x - a.x);
}
// Positive where d lies inside the circle through a, b, c, which turn positively.
[[nodiscard]] std::int64_t insideCircle(const Delaunay::Point& a, const Delaunay::Point& b, const Delaunay::Point& c,
                                        const Delaunay::Point& d);

}  // namespace relievo
