// SPDX-License-Identifier: Apache-2.0
// One film for each scene and kind of depth is used by all widths.
#include "app/lab/measure/widths.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/parallel.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/contenders.h"
#include "app/lab/rival/smoothed_film.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kNoWidth = std::numeric_limits<double>::quiet_NaN();

// Depth smoothed with one width; order 0: depth as it is, felt by relievo.
struct Smoothing {
  int order = 0;
  double width_mm = kNoWidth;
};

struct Plan {
  std::vector<std::string_view> scenes = accuracyScenes();
  std::vector<double> widths_mm{0.3, 0.43, 0.6, 0.85, 1.2, 1.7, 2.4, 3.4};
  double duration_s = 3;

  static Plan of(bool quick) {
    if (!quick) return {};
    return {.scenes = {"shallow-plane", "face-nodding", "sphere-sliding"},
            .widths_mm = {0.6, 1.2, 1.7, 2.4},
            .duration_s = 0.8};
  }
  [[nodiscard]] std::vector<Smoothing> smoothings() const {
    std::vector<Smoothing> all{{}};
    for (const int order : {1, 3}) {
      for (const double width : widths_mm) all.push_back({order, width});
    }
    return all;
  }
};

struct Figure {
  double worst_percent = 0;
  std::string_view worst_scene;
  ForceErrorSum sum;

  void add(std::string_view scene, const ForceErrorSum& of_scene) {
    sum.add(of_scene);
    const double percent = of_scene.result().rms_percent;
    if (percent < worst_percent) return;
    worst_percent = percent;
    worst_scene = scene;
  }
};

// [kind of depth][smoothing]
using Figures = std::vector<std::vector<Figure>>;

ForceErrorSum errorOf(const MemoryFilm& film, const Smoothing& smoothing, std::span<const HipTick> path,
                      std::span<const TrueTouch> truth) {
  const bool own = smoothing.order == 0;
  const auto method = contender(own ? "relievo" : "god-object")->make(film);
  if (own) return forceErrors(playPath(film, *method, path, truth), kSettledS);
  const auto order = smoothing.order == 1 ? DepthSmoother::Order::First : DepthSmoother::Order::Third;
  return forceErrors(playPath(smoothedFilm(film, smoothing.width_mm, order), *method, path, truth), kSettledS);
}

Outcome<void> addScene(std::string_view name, const Plan& plan, const std::vector<Smoothing>& smoothings,
                       Figures& figures) {
  const auto surface = makeTrueSurface(name);
  const auto path = makeFingerPath(*surface, {.duration_s = plan.duration_s});
  const auto truth = truthAlong(*surface, path);
  for (std::size_t d = 0; d < kDepthKinds.size(); ++d) {
    const auto film = MemoryFilm::make(*surface, {.depth = kDepthKinds[d]}, 0, plan.duration_s);
    if (!film) return failOn("depth of " + std::string(name), film.error());
    std::vector<ForceErrorSum> errors(smoothings.size());
    inParallel(errors.size(), [&](std::size_t i) { errors[i] = errorOf(*film, smoothings[i], path, truth); });
    for (std::size_t i = 0; i < errors.size(); ++i) figures[d][i].add(name, errors[i]);
  }
  return {};
}

Outcome<void> write(const Figures& figures, const std::vector<Smoothing>& smoothings, const std::string& path) {
  CsvTable table({"depth", "order", "width_mm", "worst_percent", "scene", "mean_percent"});
  for (std::size_t d = 0; d < figures.size(); ++d) {
    for (std::size_t i = 0; i < smoothings.size(); ++i) {
      const Figure& f = figures[d][i];
      table.row({kDepthKinds[d].name, smoothings[i].order, smoothings[i].width_mm, f.worst_percent,
                 std::string(f.worst_scene), f.sum.result().rms_percent});
    }
  }
  return table.write(path);
}

ChartWords wordsOf(const Figures& figures, const std::vector<Smoothing>& smoothings) {
  std::string text;
  for (std::size_t d = 0; d < figures.size(); ++d) {
    const auto best = [&](int order) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < smoothings.size(); ++i) {
        if (smoothings[i].order == order) least = std::min(least, figures[d][i].worst_percent);
      }
      return least;
    };
    text +=
        print("%s%s: relievo %.2g %% of the force; the best width %.2g %% by a Gaussian, %.2g %% by the third order",
              d == 0 ? "" : "; ", kDepthKinds[d].name, best(0), best(1), best(3));
  }
  return {"Widths: a god-object on depth smoothed per frame with one width, and relievo",
          "In the worst smooth scene, each with the width that suits it best. " + text + "."};
}

}  // namespace

Outcome<std::vector<ChartWords>> measureWidths(const MeasureOptions& options) {
  const Plan plan = Plan::of(options.quick);
  const auto smoothings = plan.smoothings();
  Figures figures(kDepthKinds.size(), std::vector<Figure>(smoothings.size()));
  for (std::size_t s = 0; s < plan.scenes.size(); ++s) {
    const std::string scene(plan.scenes[s]);
    options.tell(print("scene %zu of %zu: %s", s + 1, plan.scenes.size(), scene.c_str()));
    if (auto added = addScene(plan.scenes[s], plan, smoothings, figures); !added) return std::unexpected(added.error());
  }
  if (auto done = write(figures, smoothings, options.out + "/widths.csv"); !done) return std::unexpected(done.error());
  return std::vector{wordsOf(figures, smoothings)};
}

}  // namespace relievo
