// SPDX-License-Identifier: Apache-2.0
// The figures of the chart of detail, as a table and in words.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "app/lab/accuracy.h"
#include "app/lab/chart.h"
#include "app/lab/picture_quality.h"
#include "app/lab/statistics.h"
#include "app/render/scene_renderer.h"

namespace relievo {

inline constexpr std::array kDetails{
    DetailSettings{.error_px = 0.125}, DetailSettings{.error_px = 0.25}, DetailSettings{.error_px = 0.5},
    DetailSettings{.error_px = 1},     DetailSettings{.error_px = 2},    DetailSettings{.error_px = 4},
    DetailSettings{.grid_step = 1},    DetailSettings{.grid_step = 2},   DetailSettings{.grid_step = 3},
    DetailSettings{.grid_step = 4},    DetailSettings{.grid_step = 6},   DetailSettings{.grid_step = 8},
    DetailSettings{.grid_step = 12},
};
inline constexpr std::array kDrawnDepths{&kDepthKinds[1], &kDepthKinds[2]};
// No sample of any level is stretched farther from a silhouette than the coarsest grid does.
inline constexpr int kNearSilhouetteSamples = 12;

struct DetailFigures {
  const DepthKind* depth = nullptr;
  DetailSettings level;
  double triangles = 0;                           // of a picture, in the mean
  double mesh_ms = 0, draw_ms = 0, frame_ms = 0;  // a new picture takes the sum
  PictureError whole, away;
  ForceError touch;
  double touch_triangles = 0;  // of a picture of the film that is felt
};

[[nodiscard]] Outcome<void> writeDetail(std::span<const DetailFigures> figures, const std::string& path);
[[nodiscard]] ChartWords detailWords(std::span<const DetailFigures> figures);

}  // namespace relievo
