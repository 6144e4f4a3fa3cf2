// SPDX-License-Identifier: Apache-2.0
// The figures of the chart of detail, as a table and in words.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "app/lab/chart/chart.h"
#include "app/lab/detail/drawn_level.h"
#include "app/lab/detail/picture_quality.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/numbers/statistics.h"

namespace relievo {

inline constexpr std::array kDetails{
    DrawnLevel{.error_px = 0.125}, DrawnLevel{.error_px = 0.25}, DrawnLevel{.error_px = 0.5},
    DrawnLevel{.error_px = 1},     DrawnLevel{.error_px = 2},    DrawnLevel{.error_px = 4},
    DrawnLevel{.grid_step = 1},    DrawnLevel{.grid_step = 2},   DrawnLevel{.grid_step = 3},
    DrawnLevel{.grid_step = 4},    DrawnLevel{.grid_step = 6},   DrawnLevel{.grid_step = 8},
    DrawnLevel{.grid_step = 12},
};
// The methods that feel the triangles: the player's first, then its rivals.
inline constexpr std::array kDetailFeltBy{"relievo", "god-object", "god-object-smoothed"};
inline constexpr std::array kDrawnDepths{&kDepthKinds[1], &kDepthKinds[2]};
// Pixels this near to a silhouette are left out of `away`: a codec smears them, and the grid of all samples stretches
// its triangles over them. A triangle stretched farther out is an error of the level.
inline constexpr int kNearSilhouetteSamples = 3;

struct DetailFigures {
  const DepthKind* depth = nullptr;
  DrawnLevel level;
  double triangles = 0;              // per picture, on average
  double frame_ms = 0, draw_ms = 0;  // of a new picture; of the same drawn again
  PictureError away, whole;          // against the grid of all samples
  PictureError truth;                // against the ray-cast picture
  std::array<ForceError, kDetailFeltBy.size()> touch;
  double touch_triangles = 0;  // per picture of the film that is felt
};

[[nodiscard]] Outcome<void> writeDetail(std::span<const DetailFigures> figures, const std::string& path);
[[nodiscard]] ChartWords detailWords(std::span<const DetailFigures> figures);

}  // namespace relievo
