// SPDX-License-Identifier: Apache-2.0
// One row per level; the reading compares the player's level with the grids.
#include "app/lab/detail_tables.h"

#include <algorithm>

#include "app/cli/text.h"
#include "app/lab/csv_table.h"

namespace relievo {
namespace {

bool isGrid(const DetailFigures& row) {
  return row.level.grid_step > 0;
}
bool isPlayers(const DetailFigures& row) {
  return !isGrid(row) && row.level.error_px == DetailSettings{}.error_px;
}

}  // namespace

Outcome<void> writeDetail(std::span<const DetailFigures> figures, const std::string& path) {
  CsvTable table({"depth", "model", "error_px", "grid_step", "players", "triangles", "mesh_ms", "draw_ms", "frame_ms",
                  "psnr_db", "ssim", "psnr_away_db", "ssim_away", "away_percent", "touch_triangles",
                  "force_rms_percent", "direction_rms_deg", "lost_ticks", "contact_lost"});
  for (const DetailFigures& f : figures) {
    table.row({f.depth->name, isGrid(f) ? "grid" : "network", isGrid(f) ? Cell("") : Cell(f.level.error_px),
               isGrid(f) ? Cell(f.level.grid_step) : Cell(""), isPlayers(f) ? 1 : 0, f.triangles, f.mesh_ms, f.draw_ms,
               f.frame_ms, f.whole.psnrDb(), f.whole.similarity(), f.away.psnrDb(), f.away.similarity(),
               100.0 * static_cast<double>(f.away.pixels()) / static_cast<double>(f.whole.pixels()), f.touch_triangles,
               f.touch.rms_percent, f.touch.direction_rms_deg, f.touch.lost_ticks, f.touch.contactLost() ? 1 : 0});
  }
  return table.write(path);
}

ChartWords detailWords(std::span<const DetailFigures> figures) {
  const DetailFigures& own = *std::find_if(figures.begin(), figures.end(), isPlayers);
  return {"Detail: what it costs to draw, and the errors of picture and touch", print("%.0f", own.triangles)};
}

}  // namespace relievo
