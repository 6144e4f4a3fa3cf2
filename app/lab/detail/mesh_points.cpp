// SPDX-License-Identifier: Apache-2.0
#include "app/lab/detail/mesh_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "app/enhance/depth_map.h"
#include "app/enhance/depth_mesh.h"
#include "app/lab/chart/csv_table.h"
#include "app/lab/film/depth_rendering.h"
#include "app/lab/film/parallel.h"
#include "app/lab/trace/depth_film.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::array kBounds{0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr double kToldBound = 0.5;

struct Found {
  std::size_t points = 0;
  double rms = 0, most = 0;  // of the known samples, levels
};

Found pointsWithin(const DepthMap& map, double bound_levels) {
  const DepthMesh mesh = meshOf(map, static_cast<float>(bound_levels) * DepthMap::kLevel);
  DepthMap rendered = map;
  renderMesh(mesh, rendered);
  double sum = 0, most = 0;
  std::size_t known = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map.holes[i] != 0) continue;
    const double error = static_cast<double>(std::abs(rendered.codes[i] - map.codes[i]) / DepthMap::kLevel);
    sum += error * error;
    most = std::max(most, error);
    ++known;
  }
  return {mesh.points.size(), std::sqrt(sum / static_cast<double>(std::max<std::size_t>(known, 1))), most};
}

// One word: the file, or where it is a row of numbered pictures, their folder.
std::string nameOf(const std::string& film) {
  const std::filesystem::path path(film);
  const bool numbered = path.filename().string().find('%') != std::string::npos;
  std::string name = (numbered ? path.parent_path().filename() : path.stem()).string();
  std::replace_if(name.begin(), name.end(), [](char c) { return c == ' ' || c == ',' || c == '"'; }, '_');
  return name;
}

class MeshPoints {
 public:
  explicit MeshPoints(const MeasureOptions& options) : options_(options) {}

  Outcome<ChartWords> run() {
    for (const char* shape : {"plane", "sphere", "face", "step"}) {
      const auto map = readDepth(renderDepth(*makeTrueSurface(shape), {.bits = 16}, 0), {.bits = 16});
      if (!map) return failOn(shape, map.error());
      add(shape, *map);
    }
    for (const std::string& url : options_.depth_films) {
      DepthFilm film(options_.backends, {.source = {.url = url}});
      if (auto opened = film.open(); !opened) return std::unexpected(opened.error());
      const auto window = film.windowAt(0);
      if (!window) return std::unexpected(window.error());
      add(nameOf(url), mapOf((*window)->frames[0].field));
    }
    if (auto done = table_.write(options_.out + "/enhance-points.csv"); !done) return std::unexpected(done.error());
    return ChartWords{"Points of a mesh by its error bound",
                      "Within half a level of 255: points" + told_.substr(1) +
                          ". A plane takes its four corners whatever the bound; the others as many as their shape asks "
                          "for. Methods of touch are not in this chart: nothing is felt in it."};
  }

 private:
  void add(const std::string& scene, const DepthMap& map) {
    options_.tell("points, " + scene);
    std::array<Found, kBounds.size()> found;
    inParallel(kBounds.size(), [&](std::size_t b) { found[b] = pointsWithin(map, kBounds[b]); });
    for (std::size_t b = 0; b < kBounds.size(); ++b) {
      table_.row({scene, kBounds[b], found[b].points, found[b].rms, found[b].most});
      if (kBounds[b] == kToldBound) told_ += print(", %s %zu", scene.c_str(), found[b].points);
    }
  }

  const MeasureOptions& options_;
  CsvTable table_{{"scene", "bound_levels", "points", "rms_levels", "most_levels"}};
  std::string told_;
};

}  // namespace

Outcome<ChartWords> measureMeshPoints(const MeasureOptions& options) {
  return MeshPoints(options).run();
}

}  // namespace relievo
