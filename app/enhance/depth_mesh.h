// SPDX-License-Identifier: Apache-2.0
// A depth picture as a mesh of feature points, with as few as an error bound allows.
#pragma once

#include <vector>

#include "app/enhance/delaunay.h"
#include "app/enhance/depth_map.h"

namespace relievo {

struct DepthMesh {
  std::vector<Delaunay::Point> points;  // sample columns and rows; the first four are the picture's corners
  std::vector<float> codes;             // of the points
  std::vector<Delaunay::Triangle> triangles;
};

// Greedy insertion: while a known sample is farther than `bound` from the mesh, the farthest one of its triangle
// becomes a point. A plane therefore needs only the four corners, a curved area as many points as its curvature
// requires, and a step is followed on both sides. (The paper picks samples with a large gradient; here a constant slope
// costs nothing.) Nullopt if the picture has no known sample or only one row or column.
[[nodiscard]] DepthMesh meshOf(const DepthMap& map, float bound);

// Replaces the known samples' codes by the mesh's.
void renderMesh(const DepthMesh& mesh, DepthMap& map);

}  // namespace relievo
