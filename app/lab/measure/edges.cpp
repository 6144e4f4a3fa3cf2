// SPDX-License-Identifier: Apache-2.0
// A finger on its way over an edge, at many places along it.
#include "app/lab/measure/edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <string_view>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/parallel.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/contenders.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::array<std::string_view, 10> kMethods{
    "relievo",     "relievo 0.14",        "relievo 0.28", "relievo 0.43",        "relievo 0.72",
    "relievo 1.0", "relievo 0.28 + 0.72", "god-object",   "god-object-smoothed", "modified-proxy-graph"};
constexpr std::array kFingerDepthsMm{2.0, 5.0};
constexpr double kBeginS = 0.5, kTickS = 0.001, kUntilS = 1.6;
constexpr double kFarMm = 8;  // beyond the edge

// One method on one film, at one place along the edge. Distances are from the edge, across it, positive beyond it.
class Crossing {
 public:
  Crossing(const TrueSurface& surface, const MemoryFilm& film, TouchMethod& method, double along_mm)
      : surface_(surface), run_(film, method), along_mm_(along_mm) {}

  // How far from the edge a finger that comes down on it from outside, half way between floor and wall, finds the
  // surface.
  double surfaceFromEdge() {
    constexpr double kFromMm = 4, kMmPerS = 20;
    for (int i = 0;; ++i) {
      const double off = kFromMm - i * kMmPerS * kTickS;
      if (off < -kFarMm) return kFarMm;
      if (tick(off / std::numbers::sqrt2, off / std::numbers::sqrt2).contact) return std::abs(off);
    }
  }

  // How far beyond the edge a finger that is swept off the floor has lost half of its force; nullopt: it never does.
  std::optional<double> fallOff(double deep_mm) {
    constexpr double kFromMm = -10, kFullAtMm = -5, kAboveMm = 1, kStepMm = 100 * kTickS;
    double above = kAboveMm;
    while ((above -= kStepMm) > -deep_mm) tick(kFromMm, above);
    double full_n = 0;
    for (int i = 0;; ++i) {
      const double distance = kFromMm + i * kStepMm;
      if (distance > kFarMm) return std::nullopt;
      const double force_n = glm::length(tick(distance, -deep_mm).force_n);
      if (distance <= kFullAtMm) {
        full_n = std::max(full_n, force_n);
      } else if (force_n < 0.5 * full_n || full_n == 0) {
        return distance;
      }
    }
  }

 private:
  Touch tick(double distance_mm, double above_mm) {
    const double t = kBeginS + ticks_++ * kTickS;
    const StepWall wall = *surface_.wallAt(t);
    const glm::dvec2 along(-wall.normal.y, wall.normal.x);
    const glm::dvec2 place = (wall.offset_mm + distance_mm) * wall.normal + along_mm_ * along;
    return run_.tick({t, {place, wall.high_mm + above_mm}}).touch;
  }

  const TrueSurface& surface_;
  FilmRun run_;
  double along_mm_;
  int ticks_ = 0;
};

struct Figures {
  std::string_view method;
  const DepthKind* depth = nullptr;
  double edge_mm_per_s = 0;
  double corner_mean_mm = 0, corner_worst_mm = 0;
  struct FallOff {
    double rms_mm = 0, earliest_mm = 0, latest_mm = 0;
    int held = 0;
    // The larger of the two; the end of the path if the force never fell.
    [[nodiscard]] double worst() const { return held > 0 ? kFarMm : std::max(-earliest_mm, latest_mm); }
  };
  std::array<FallOff, kFingerDepthsMm.size()> fall_off;
  int places = 0;
};

void measure(const TrueSurface& surface, const FilmViews& views, int places, Figures& figures) {
  constexpr double kLengthMm = 28;  // along the edge
  const Contender& who = *contender(figures.method);
  const MemoryFilm& film = views.of(who);
  const auto method = who.make(views.raw());
  figures.places = places;
  const auto along = [&](int k) { return kLengthMm * ((k + 0.5) / places - 0.5); };
  for (int k = 0; k < places; ++k) {
    const double corner = Crossing(surface, film, *method, along(k)).surfaceFromEdge();
    figures.corner_mean_mm += corner / places;
    figures.corner_worst_mm = std::max(figures.corner_worst_mm, corner);
  }
  for (std::size_t d = 0; d < kFingerDepthsMm.size(); ++d) {
    Figures::FallOff& fall = figures.fall_off[d];
    double squares = 0;
    fall.earliest_mm = kFarMm;
    fall.latest_mm = -kFarMm;
    for (int k = 0; k < places; ++k) {
      const auto at = Crossing(surface, film, *method, along(k)).fallOff(kFingerDepthsMm[d]);
      if (!at) ++fall.held;
      const double off = at.value_or(kFarMm);
      squares += off * off;
      fall.earliest_mm = std::min(fall.earliest_mm, off);
      fall.latest_mm = std::max(fall.latest_mm, off);
    }
    fall.rms_mm = std::sqrt(squares / places);
  }
}

Outcome<void> write(const std::vector<Figures>& all, const std::string& path) {
  CsvTable table({"method", "depth", "edge_mm_per_s", "places", "corner_mean_mm", "corner_worst_mm", "finger_deep_mm",
                  "fall_off_rms_mm", "fall_off_earliest_mm", "fall_off_latest_mm", "fall_off_worst_mm", "held"});
  for (const Figures& f : all) {
    for (std::size_t d = 0; d < kFingerDepthsMm.size(); ++d) {
      const Figures::FallOff& fall = f.fall_off[d];
      table.row({std::string(f.method), f.depth->name, f.edge_mm_per_s, f.places, f.corner_mean_mm, f.corner_worst_mm,
                 kFingerDepthsMm[d], fall.rms_mm, fall.earliest_mm, fall.latest_mm, fall.worst(), fall.held});
    }
  }
  return table.write(path);
}

ChartWords wordsOf(const std::vector<Figures>& all) {
  struct Worst {
    double corner_mm = 0, fall_off_mm = 0;
  };
  const auto worst = [&](std::string_view method, std::string_view depth) {
    Worst result;
    for (const Figures& f : all) {
      if (f.method != method || f.depth->name != depth) continue;
      result.corner_mm = std::max(result.corner_mm, f.corner_mean_mm);
      for (const auto& fall : f.fall_off) result.fall_off_mm = std::max(result.fall_off_mm, fall.worst());
    }
    return result;
  };
  const auto told = [&](std::string_view method, std::string_view depth) {
    const Worst w = worst(method, depth);
    return print("%s %.2f and %.2f mm", std::string(depth).c_str(), w.corner_mm, w.fall_off_mm);
  };
  return {
      "Edges: what smoothing costs on a step of 15 mm, still and moving",
      print("Two distances from the edge: that of the felt surface (mean of the places), and that at which a finger "
            "that is swept off has lost half of its force (worst place). relievo as it plans: %s; %s; %s; %s. Widths "
            "alone: "
            "0.28 mm, %s; 0.72 mm, %s. Two levels, 0.28 + 0.72 mm: %s; they go with an edge that moves from frame to "
            "frame. Smoothing every frame rounds the edge: god-object-smoothed %s; the raw god-object keeps it, %s, "
            "until noise traps it (%s).",
            told("relievo", "16-bit").c_str(), told("relievo", "8-bit").c_str(),
            told("relievo", "H.264 crf 23").c_str(), told("relievo", "noise 1 %").c_str(),
            told("relievo 0.28", "8-bit").c_str(), told("relievo 0.72", "8-bit").c_str(),
            told("relievo 0.28 + 0.72", "8-bit").c_str(), told("god-object-smoothed", "8-bit").c_str(),
            told("god-object", "8-bit").c_str(), told("god-object", "noise 1 %").c_str())};
}

}  // namespace

Outcome<std::vector<ChartWords>> measureEdges(const MeasureOptions& options) {
  const int places = options.quick ? 16 : 40;
  std::vector<Figures> all;
  for (const double speed : {0.0, 50.0, -50.0}) {
    const auto surface =
        speed == 0 ? makeTrueSurface("step") : makeTrueSurface("step-moving", {.speed_mm_per_s = speed});
    for (const DepthKind& depth : kDepthKinds) {
      options.tell(print("%s, edge at %g mm/s, %zu methods", depth.name, speed, kMethods.size()));
      const auto film = MemoryFilm::make(*surface, {.depth = depth}, 0, kUntilS);
      if (!film) return failOn(depth.name, film.error());
      std::vector<Figures> figures;
      figures.reserve(kMethods.size());
      for (const std::string_view method : kMethods) {
        figures.push_back({.method = method, .depth = &depth, .edge_mm_per_s = speed});
      }
      const FilmViews views(*film);
      inParallel(figures.size(), [&](std::size_t i) { measure(*surface, views, places, figures[i]); });
      all.insert(all.end(), figures.begin(), figures.end());
    }
  }
  if (auto done = write(all, options.out + "/edges.csv"); !done) return std::unexpected(done.error());
  return std::vector{wordsOf(all)};
}

}  // namespace relievo
