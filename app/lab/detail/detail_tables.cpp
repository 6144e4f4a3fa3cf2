// SPDX-License-Identifier: Apache-2.0
// One row per level; the reading compares the player's level with the grids.
#include "app/lab/detail/detail_tables.h"

#include <algorithm>

#include "app/lab/chart/csv_table.h"
#include "platform/print.h"

namespace relievo {
namespace {

bool isGrid(const DetailFigures& row) {
  return row.level.grid_step > 0;
}
bool isPlayers(const DetailFigures& row) {
  return !isGrid(row) && row.level.error_px == DrawnLevel{}.error_px;
}

}  // namespace

Outcome<void> writeDetail(std::span<const DetailFigures> figures, const std::string& path) {
  CsvTable table({"depth",
                  "model",
                  "error_px",
                  "grid_step",
                  "players",
                  "triangles",
                  "mesh_ms",
                  "draw_ms",
                  "frame_ms",
                  "away_psnr_db",
                  "away_ssim",
                  "away_percent",
                  "whole_psnr_db",
                  "whole_ssim",
                  "truth_psnr_db",
                  "truth_ssim",
                  "touch_triangles",
                  "force_rms_percent",
                  "direction_rms_deg",
                  "lost_ticks",
                  "contact_lost",
                  "god_object_rms_percent",
                  "god_object_smoothed_rms_percent"});
  for (const DetailFigures& f : figures) {
    const double mesh_ms = std::max(0.0, f.frame_ms - f.draw_ms);
    const double away = static_cast<double>(f.away.pixels()) / static_cast<double>(f.whole.pixels());
    const auto& [own, god_object, smoothed] = f.touch;
    table.row({f.depth->name,
               isGrid(f) ? "grid" : "network",
               isGrid(f) ? Cell("") : Cell(f.level.error_px),
               isGrid(f) ? Cell(f.level.grid_step) : Cell(""),
               isPlayers(f) ? 1 : 0,
               f.triangles,
               mesh_ms,
               f.draw_ms,
               f.frame_ms,
               f.away.psnrDb(),
               f.away.similarity(),
               100 * away,
               f.whole.psnrDb(),
               f.whole.similarity(),
               f.truth.psnrDb(),
               f.truth.similarity(),
               f.touch_triangles,
               own.rms_percent,
               own.direction_rms_deg,
               own.lost_ticks,
               own.contactLost() ? 1 : 0,
               god_object.rms_percent,
               smoothed.rms_percent});
  }
  return table.write(path);
}

// The words of the chart, with the figures of the first kind of depth.
ChartWords detailWords(std::span<const DetailFigures> figures) {
  const DetailFigures& own = *std::find_if(figures.begin(), figures.end(), isPlayers);
  const auto grid = [&](auto&& wanted) -> const DetailFigures& {
    const DetailFigures* found = nullptr;
    for (const DetailFigures& f : figures) {
      if (f.depth == own.depth && isGrid(f) && wanted(f)) found = &f;  // the coarsest: it comes last
    }
    return *found;
  };
  const DetailFigures& all = grid([](const DetailFigures& f) { return f.level.grid_step == 1; });
  const DetailFigures& alike = grid([&](const DetailFigures& f) { return f.triangles >= own.triangles; });
  const double away = static_cast<double>(own.away.pixels()) / static_cast<double>(own.whole.pixels());
  return {
      "Detail: what it costs to draw, and the errors of picture and touch",
      print(
          "%s, the player's %g px: %.0f thousand triangles (%.0f %% of the full grid's), %.1f dB (SSIM %.3f) from "
          "what the eyes would see; the full grid %.1f (%.3f), a grid of %.0f thousand %.1f. Near silhouettes the full "
          "mesh is no measure; away from them (%.0f %% of the pixels) the player's is %.1f dB from it, the grid of "
          "%.0f thousand %.1f. The error of the force would be %.2g %% on these triangles; relievo feels all samples, "
          "where it is %.2g %%. With god-object it is %.2g and %.2g %%, with god-object-smoothed %.2g and %.2g %%.",
          own.depth->name, own.level.error_px, own.triangles / 1e3, 100 * own.triangles / all.triangles,
          own.truth.psnrDb(), own.truth.similarity(), all.truth.psnrDb(), all.truth.similarity(), alike.triangles / 1e3,
          alike.truth.psnrDb(), 100 * away, own.away.psnrDb(), alike.triangles / 1e3, alike.away.psnrDb(),
          own.touch[0].rms_percent, all.touch[0].rms_percent, own.touch[1].rms_percent, all.touch[1].rms_percent,
          own.touch[2].rms_percent, all.touch[2].rms_percent)};
}

}  // namespace relievo
