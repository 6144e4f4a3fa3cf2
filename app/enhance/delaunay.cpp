// SPDX-License-Identifier: Apache-2.0
// Lawson's algorithm: split the triangle, then flip edges until every circumcircle is empty. The newest point is the
// third corner of every triangle around it, so that the edge to check is always the first.
#include "app/enhance/delaunay.h"

#include <algorithm>

namespace relievo {

std::int64_t insideCircle(const Delaunay::Point& a, const Delaunay::Point& b, const Delaunay::Point& c,
                          const Delaunay::Point& d) {
  const std::int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
  return (ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) +
         (cx * cx + cy * cy) * (ax * by - ay * bx);
}

Delaunay::Delaunay(int right, int bottom) : points_{{0, 0}, {right, 0}, {right, bottom}, {0, bottom}} {
  addTriangle();
  addTriangle();
  triangles_ = {{0, 1, 2}, {0, 2, 3}};
  join(2, 3);
}

int Delaunay::addTriangle() {
  triangles_.push_back({});
  beside_.insert(beside_.end(), 3, kNone);
  return static_cast<int>(triangles_.size()) - 1;
}

void Delaunay::set(int triangle, int a, int b, int c, int beside_ab) {
  triangles_[triangle] = {a, b, c};
  join(3 * triangle, beside_ab);
}

void Delaunay::join(int edge, int other) {
  beside_[edge] = other;
  if (other != kNone) beside_[other] = edge;
}

std::span<const int> Delaunay::insert(const Point& point, int triangle) {
  const int index = static_cast<int>(points_.size());
  points_.push_back(point);
  around_.clear();
  const auto [a, b, c] = triangles_[triangle];
  const int first = 3 * triangle;
  if (turn(points_[a], points_[b], point) == 0) {
    splitEdge(first, index);
  } else if (turn(points_[b], points_[c], point) == 0) {
    splitEdge(first + 1, index);
  } else if (turn(points_[c], points_[a], point) == 0) {
    splitEdge(first + 2, index);
  } else {
    split(triangle, index);
  }
  // A flip appends another edge, which is checked in turn.
  for (std::size_t i = 0; i < around_.size(); ++i) flipWhereNeeded(around_[i]);
  return around_;
}

void Delaunay::split(int triangle, int point) {
  const auto [a, b, c] = triangles_[triangle];
  const int ab = beside_[3 * triangle], bc = beside_[3 * triangle + 1], ca = beside_[3 * triangle + 2];
  const int second = addTriangle(), third = addTriangle();
  set(triangle, a, b, point, ab);
  set(second, b, c, point, bc);
  set(third, c, a, point, ca);
  join(3 * triangle + 1, 3 * second + 2);
  join(3 * second + 1, 3 * third + 2);
  join(3 * third + 1, 3 * triangle + 2);
  around_ = {triangle, second, third};
}

void Delaunay::splitEdge(int edge, int point) {
  const int here = triangleOf(edge), a = pointOf(edge), b = pointOf(next(edge)), c = pointOf(next(next(edge)));
  const int bc = beside_[next(edge)], ca = beside_[next(next(edge))], there_edge = beside_[edge];
  const int second = addTriangle();
  set(here, b, c, point, bc);
  set(second, c, a, point, ca);
  join(3 * here + 1, 3 * second + 2);
  beside_[3 * here + 2] = beside_[3 * second + 1] = kNone;
  around_ = {here, second};
  if (there_edge == kNone) return;

  const int there = triangleOf(there_edge), d = pointOf(next(next(there_edge)));
  const int ad = beside_[next(there_edge)], db = beside_[next(next(there_edge))];
  const int fourth = addTriangle();
  set(there, a, d, point, ad);
  set(fourth, d, b, point, db);
  join(3 * there + 1, 3 * fourth + 2);
  join(3 * here + 2, 3 * fourth + 1);
  join(3 * second + 1, 3 * there + 2);
  around_ = {here, second, there, fourth};
}

void Delaunay::flipWhereNeeded(int triangle) {
  for (;;) {
    const auto [a, b, point] = triangles_[triangle];
    const int across = beside_[3 * triangle];
    if (across == kNone) return;
    const int d = pointOf(next(next(across)));
    if (insideCircle(points_[a], points_[b], points_[point], points_[d]) <= 0) return;
    const int other = triangleOf(across);
    const int ad = beside_[next(across)], db = beside_[next(next(across))];
    const int bp = beside_[3 * triangle + 1], pa = beside_[3 * triangle + 2];
    set(triangle, a, d, point, ad);
    set(other, d, b, point, db);
    join(3 * triangle + 2, pa);
    join(3 * other + 1, bp);
    join(3 * triangle + 1, 3 * other + 2);
    around_.push_back(other);
  }
}

}  // namespace relievo
