// SPDX-License-Identifier: Apache-2.0
// Garland and Heckbert, Fast Polygonal Approximation of Terrains and Height Fields (1995): after inserting a point,
// only the triangles around it are measured again.
#include "app/enhance/depth_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "app/enhance/in_bands.h"

namespace relievo {
namespace {

using Point = Delaunay::Point;

constexpr int floorDivide(int a, int b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}

// Calls row(r, first, last) for each row of samples inside a triangle or on its edge, of the rows from `begin` to
// before `end` that `every` divides.
template <class Row>
void eachRow(const std::array<Point, 3>& corners, int begin, int end, int every, Row&& row) {
  const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  const int from = (std::max(top, begin) + every - 1) / every * every;
  for (int r = from; r < std::min(bottom + 1, end); r += every) {
    int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
    for (int k = 0; k < 3; ++k) {
      const Point &a = corners[k], &b = corners[(k + 1) % 3];
      if (r < std::min(a.y, b.y) || r > std::max(a.y, b.y)) continue;
      if (a.y == b.y) {
        first = std::min({first, a.x, b.x});
        last = std::max({last, a.x, b.x});
        continue;
      }
      const int along = (b.x - a.x) * (r - a.y), down = b.y - a.y;
      first = std::min(first, a.x - floorDivide(-along, down));
      last = std::max(last, a.x + floorDivide(along, down));
    }
    if (first <= last) row(r, first, last);
  }
}

// The plane through three points.
struct Facet {
  double origin = 0, across = 0, down = 0;

  Facet(const std::array<Point, 3>& p, const std::array<float, 3>& codes) {
    const double a = static_cast<double>(codes[0]);
    const double ab = static_cast<double>(codes[1]) - a, ac = static_cast<double>(codes[2]) - a;
    const double bx = p[1].x - p[0].x, by = p[1].y - p[0].y, cx = p[2].x - p[0].x, cy = p[2].y - p[0].y;
    const double per_area = 1 / (bx * cy - by * cx);
    across = (ab * cy - ac * by) * per_area;
    down = (ac * bx - ab * cx) * per_area;
    origin = a - across * p[0].x - down * p[0].y;
  }
};

class Growing {
 public:
  Growing(const DepthMap& map, float bound)
      : map_(map), known_(map.codes), bound_(bound), delaunay_(map.cols - 1, map.rows - 1) {
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (map.holes[i] != 0) known_[i] = std::numeric_limits<float>::quiet_NaN();
    }
    for (const Point& corner : delaunay_.points()) codes_.push_back(cornerCode(corner));
    measure({0, 1});
  }

  // In rounds: the worst sample of each triangle beyond the bound becomes a point, in order of decreasing error; then
  // the changed triangles are measured once. Inserting one point at a time would save a few points and take twice the
  // time.
  DepthMesh grow() {
    std::vector<int> changed, changed_in;  // by triangle: the round in which it changed
    for (int round = 1; !worst_.empty(); ++round) {
      std::vector<Candidate> candidates = std::exchange(worst_, {});
      std::ranges::sort(candidates, [](const Candidate& a, const Candidate& b) {
        return a.error != b.error ? a.error > b.error : a.triangle < b.triangle;
      });
      changed.clear();
      for (const Candidate& next : candidates) {
        changed_in.resize(delaunay_.triangles().size());
        if (changed_in[next.triangle] == round) continue;  // its triangle has changed in this round
        codes_.push_back(map_.codes[map_.at(next.point.x, next.point.y)]);
        const auto touched = delaunay_.insert(next.point, next.triangle);
        changed_in.resize(delaunay_.triangles().size());
        for (const int triangle : touched) {
          if (std::exchange(changed_in[triangle], round) != round) changed.push_back(triangle);
        }
      }
      measure(changed);
    }
    return {delaunay_.points(), std::move(codes_), delaunay_.triangles()};
  }

 private:
  struct Candidate {
    float error = 0;
    int triangle = 0;
    Point point;
  };

  // At a hole, the code of the nearest known sample.
  [[nodiscard]] float cornerCode(const Point& corner) const {
    if (const std::size_t i = map_.at(corner.x, corner.y); map_.holes[i] == 0) return map_.codes[i];
    std::size_t found = 0;
    long nearest = std::numeric_limits<long>::max();
    for (int r = 0; r < map_.rows; ++r) {
      for (int c = 0; c < map_.cols; ++c) {
        const long dc = c - corner.x, dr = r - corner.y, distance = dc * dc + dr * dr;
        if (map_.holes[map_.at(c, r)] != 0 || distance >= nearest) continue;
        nearest = distance;
        found = map_.at(c, r);
      }
    }
    return map_.codes[found];
  }

  // On all cores. The results stay in the order of the triangles.
  void measure(const std::vector<int>& triangles) {
    std::vector<Candidate> found(triangles.size());
    inBands(static_cast<int>(triangles.size()), [&](int first, int end) {
      for (int i = first; i < end; ++i) found[i] = farFrom(triangles[i]);
    });
    std::ranges::copy_if(found, std::back_inserter(worst_), [&](const Candidate& each) { return each.error > bound_; });
  }

  // A sample that is far from a triangle; `bound_` and no sample if all are within it. For a high triangle it is the
  // farthest in some of its rows and their neighbours; all rows are examined only if those are within the bound, since
  // the large triangles of the first rounds are soon divided.
  [[nodiscard]] Candidate farFrom(int triangle) const {
    constexpr int kRowsEnough = 48;
    const auto [a, b, c] = delaunay_.triangles()[triangle];
    const auto& p = delaunay_.points();
    const auto [top, bottom] = std::minmax({p[a].y, p[b].y, p[c].y});
    int every = 1;
    while (bottom - top >= 2 * kRowsEnough * every && every < 16) every *= 2;
    const Candidate far = farthestFrom(triangle, 0, map_.rows, every);
    if (every == 1) return far;
    if (far.error > bound_) return farthestFrom(triangle, far.point.y - every + 1, far.point.y + every, 1);
    return farthestFrom(triangle, 0, map_.rows, 1);
  }

  // The sample that is farthest from a triangle, in the rows from `begin` to before `end` that `every` divides.
  [[nodiscard]] Candidate farthestFrom(int triangle, int begin, int end, int every) const {
    const auto [a, b, c] = delaunay_.triangles()[triangle];
    const auto& p = delaunay_.points();
    const std::array<Point, 3> corners{p[a], p[b], p[c]};
    const Facet facet(corners, {codes_[a], codes_[b], codes_[c]});
    constexpr int kAhead = 4, kLine = 16;  // rows; samples of a cache line
    Candidate worst{.error = bound_, .triangle = triangle};
    eachRow(corners, begin, end, every, [&](int row, int first, int last) {
      const float* const codes = known_.data() + map_.at(first, row);
      // The processor foresees the next samples, but not a small triangle's next rows: each cost a wait for memory.
      const std::size_t ahead = map_.at(first, row + kAhead), past = std::min(ahead + last - first + 1, known_.size());
      for (std::size_t i = ahead; i < past; i += kLine) __builtin_prefetch(&known_[i]);
      const auto start = static_cast<float>(facet.origin + facet.down * row + facet.across * first);
      const auto step = static_cast<float>(facet.across);
      const auto error = [&](int i) { return std::abs(codes[i] - (start + step * static_cast<float>(i))); };
      const int count = last - first + 1;
      int beyond = 0;  // usually 0: without a branch the loop is vectorised
      for (int i = 0; i < count; ++i) beyond |= error(i) > worst.error ? 1 : 0;
      if (beyond == 0) return;
      for (int i = 0; i < count; ++i) {
        if (!(error(i) > worst.error)) continue;
        worst.error = error(i);
        worst.point = {first + i, row};
      }
    });
    return worst;
  }

  const DepthMap& map_;
  std::vector<float> known_;  // codes, NaN at a hole, so that its error never exceeds another
  float bound_;
  Delaunay delaunay_;
  std::vector<float> codes_;
  std::vector<Candidate> worst_;  // the worst samples beyond the bound, one per triangle
};

}  // namespace

DepthMesh meshOf(const DepthMap& map, float bound) {
  if (map.cols < 2 || map.rows < 2) return {};
  if (std::all_of(map.holes.begin(), map.holes.end(), [](std::uint8_t hole) { return hole != 0; })) return {};
  // Rounding must not make a corner a candidate again.
  constexpr float kLeast = 1.0F / 16;
  return Growing(map, std::max(bound, kLeast)).grow();
}

// A band of rows at a time, so that where triangles meet the same one is drawn last.
void renderMesh(const DepthMesh& mesh, DepthMap& map) {
  inBands(map.rows, [&](int begin, int end) {
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::array<Point, 3> corners{mesh.points[a], mesh.points[b], mesh.points[c]};
      const auto [top, bottom] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
      if (bottom < begin || top >= end) continue;
      const Facet facet(corners, {mesh.codes[a], mesh.codes[b], mesh.codes[c]});
      eachRow(corners, begin, end, 1, [&](int row, int first, int last) {
        float* const codes = map.codes.data() + map.at(0, row);
        const std::uint8_t* const holes = map.holes.data() + map.at(0, row);
        const double origin = facet.origin + facet.down * row;
        for (int column = first; column <= last; ++column) {
          const auto code = static_cast<float>(origin + facet.across * column);
          codes[column] = holes[column] == 0 ? code : codes[column];
        }
      });
    }
  });
}

}  // namespace relievo
