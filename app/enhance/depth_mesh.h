// SPDX-License-Identifier: Apache-2.0
// A depth picture as the mesh of its feature points: no more of them than an error bound asks for.
#pragma once

#include <vector>

#include "app/enhance/delaunay.h"
#include "app/enhance/depth_map.h"

namespace relievo {

struct DepthMesh {
  std::vector<Delaunay::Point> points;  // columns and rows of samples; the first four are the picture's corners
  std::vector<float> codes;             // of the points
  std::vector<Delaunay::Triangle> triangles;
};

// Greedily: as long as a known sample is farther than `bound` from the mesh, the farthest of its triangle becomes a
// point. So a plane takes the four corners, a curved place as many as its curvature, and a step is followed on both
// sides. (The paper samples where the first gradient is large; a slope that goes on costs nothing here.) Nothing for a
// picture without a known sample, or of one row or column.
[[nodiscard]] DepthMesh meshOf(const DepthMap& map, float bound);

// The mesh's codes in place of the known samples'.
void renderMesh(const DepthMesh& mesh, DepthMap& map);

}  // namespace relievo
