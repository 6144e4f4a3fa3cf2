// SPDX-License-Identifier: Apache-2.0
// One film as the camera saw it serves all; each enhancement's film is felt by all methods, in 8 bits and as it is.
#include "app/lab/measure/enhance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "app/enhance/enhancer.h"
#include "app/lab/chart/csv_table.h"
#include "app/lab/detail/mesh_points.h"
#include "app/lab/film/depth_rendering.h"
#include "app/lab/film/parallel.h"
#include "app/lab/film/sensor_depth.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/accuracy.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::array kFeltBy{"modified-proxy-graph", "god-object", "god-object-smoothed", "relievo"};
constexpr std::array<std::optional<Enhancement>, 4> kKinds{std::nullopt, Enhancement::Median, Enhancement::Dibm,
                                                           Enhancement::SpaceTime};
const char* nameOf(const std::optional<Enhancement>& kind) {
  return kind ? name(*kind) : "none";
}

struct Plan {
  std::vector<std::string_view> felt{"plane", "sphere-sliding", "face-nodding"};
  std::vector<std::string_view> edges{"step", "step-moving"};
  std::vector<double> noises{1, 2, 3, 4};
  double duration_s = 1.5;
  int edge_pictures = 9;

  static Plan of(bool quick) {
    if (!quick) return {};
    return {.felt = {"face-nodding"}, .edges = {"step-moving"}, .noises = {4}, .duration_s = 0.5, .edge_pictures = 7};
  }
};

struct EnhanceRow {
  SensorModel sensor;
  std::optional<Enhancement> kind;
  int bits = 8;
  const char* felt_by = "";
  ForceErrorSum sum;
};
struct EdgeRow {
  SensorModel sensor;
  std::optional<Enhancement> kind;
  double mean_px = 0, most_px = 0, within_percent = 0;  // rows whose edge is within a sample
};

// The pictures after an enhancement, in 16 bits; without an enhancement, unchanged.
Result<std::vector<Frame>> enhanced(std::span<const Frame> pictures, const std::optional<Enhancement>& kind) {
  if (!kind) return std::vector<Frame>(pictures.begin(), pictures.end());
  DepthEnhancer enhancer(*kind, kSensorCalibration);
  std::vector<Frame> done;
  const auto collect = [&] {
    while (auto frame = enhancer.next()) done.push_back(std::move(*frame));
  };
  for (const Frame& picture : pictures) {
    if (auto added = enhancer.add(picture); !added) return std::unexpected(added.error());
    collect();
  }
  enhancer.finish();
  collect();
  return done;
}

std::vector<Frame> sensedFilm(const TrueSurface& surface, const SensorModel& sensor, int count) {
  std::vector<Frame> pictures(count);
  inParallel(pictures.size(), [&](std::size_t i) {
    pictures[i] = sensedDepth(renderDepth(surface, {.bits = 16}, static_cast<int>(i)), sensor, i + 1);
  });
  return pictures;
}

// How many samples the edge is off in a row: the samples within kAround of it that are higher than the edge's middle
// are counted, and compared with the truth.
int edgeOff(const HeightField& field, const StepWall& wall, int row) {
  constexpr int kAround = 12;
  const GridMapping& grid = field.grid();
  const double y = grid.y(row);
  const int edge = static_cast<int>(std::lround(grid.u((wall.offset_mm - wall.normal.y * y) / wall.normal.x)));
  int off = 0;
  for (int c = edge - kAround; c < edge + kAround; ++c) {
    off += field.heightMm(c, row) > 0.5 * (wall.high_mm + wall.low_mm) ? 1 : 0;
    off -= wall.distance(grid.x(c), y) < 0 ? 1 : 0;
  }
  return std::abs(off);
}

class Enhance {
 public:
  explicit Enhance(const MeasureOptions& options) : options_(options), plan_(Plan::of(options.quick)) {}

  Outcome<std::vector<ChartWords>> run() {
    for (const bool faults : {false, true}) {
      for (const double noise : plan_.noises) {
        const SensorModel sensor{.noise_levels = noise, .faults = faults};
        if (auto done = addForces(sensor); !done) return std::unexpected(done.error());
        if (auto done = addEdges(sensor); !done) return std::unexpected(done.error());
      }
    }
    if (auto done = writeForces(); !done) return std::unexpected(done.error());
    const auto points = measureMeshPoints(options_);
    if (!points) return std::unexpected(points.error());
    return std::vector{forceWords(), *points};
  }

 private:
  Outcome<void> addForces(const SensorModel& sensor) {
    const std::size_t first = forces_.size();
    for (const auto& kind : kKinds) {
      for (const int bits : {8, 16}) {
        for (const char* felt_by : kFeltBy) forces_.push_back({sensor, kind, bits, felt_by, {}});
      }
    }
    for (const std::string_view scene : plan_.felt) {
      options_.tell(print("force, noise %g%s, %s", sensor.noise_levels, sensor.faults ? " with faults" : "",
                          std::string(scene).c_str()));
      const auto surface = makeTrueSurface(scene);
      const auto path = makeFingerPath(*surface, {.duration_s = plan_.duration_s});
      const auto truth = truthAlong(*surface, path);
      const int count = static_cast<int>(std::ceil(plan_.duration_s * 30)) + SurfaceWindow::kAhead + 1;
      const auto seen = sensedFilm(*surface, sensor, count);
      for (std::size_t k = 0; k < kKinds.size(); ++k) {
        const auto wide = enhanced(seen, kKinds[k]);
        if (!wide) return failOn(std::string(scene), wide.error());
        for (const bool narrow : {true, false}) {
          if (!narrow && !kKinds[k]) continue;
          std::vector<Frame> pictures = *wide;
          if (narrow && kKinds[k]) std::transform(pictures.begin(), pictures.end(), pictures.begin(), asEightBits);
          const auto film = MemoryFilm::of(pictures, {.bits = narrow ? 8 : 16, .invalid = 0});
          if (!film) return failOn(std::string(scene), film.error());
          const FilmViews views(*film);
          inParallel(kFeltBy.size(), [&](std::size_t m) {
            const auto ticks = playPath(views, *contender(kFeltBy[m]), path, truth);
            forces_[first + (k * 2 + (narrow ? 0 : 1)) * kFeltBy.size() + m].sum.add(forceErrors(ticks, kSettledS));
          });
        }
      }
    }
    return {};
  }

  Outcome<void> addEdges(const SensorModel& sensor) {
    const std::size_t first = edges_.size();
    for (const auto& kind : kKinds) edges_.push_back({sensor, kind});
    for (const std::string_view scene : plan_.edges) {
      options_.tell(print("edges, noise %g, %s", sensor.noise_levels, std::string(scene).c_str()));
      const auto surface = makeTrueSurface(scene);
      const auto seen = sensedFilm(*surface, sensor, plan_.edge_pictures);
      for (std::size_t k = 0; k < kKinds.size(); ++k) {
        const auto pictures = enhanced(seen, kKinds[k]);
        if (!pictures) return failOn(std::string(scene), pictures.error());
        const auto film = MemoryFilm::of(*pictures, {.bits = kKinds[k] ? 16 : 8, .invalid = 0});
        if (!film) return failOn(std::string(scene), film.error());
        const double share =
            1.0 / static_cast<double>(film->frames().size() * seen.front().height * plan_.edges.size());
        for (const TimedSurface& shown : film->frames()) {
          const StepWall wall = *surface->wallAt(toSeconds(shown.time));
          for (int row = 0; row < shown.field.rows(); ++row) {
            const double off = edgeOff(shown.field, wall, row);
            edges_[first + k].mean_px += off * share;
            edges_[first + k].most_px = std::max(edges_[first + k].most_px, off);
            edges_[first + k].within_percent += off <= 1 ? 100 * share : 0;
          }
        }
      }
    }
    return {};
  }

  Outcome<void> writeForces() const {
    CsvTable table({"figure", "faults", "noise_levels", "enhancement", "bits", "method", "force_rms_n",
                    "force_rms_percent", "direction_rms_deg", "lost_ticks", "contact_lost", "edge_mean_px",
                    "edge_most_px", "edge_within_1_px_percent"});
    for (const EnhanceRow& r : forces_) {
      if (!r.kind && r.bits == 16) continue;  // the camera has 8
      const ForceError e = r.sum.result();
      table.row({"force", r.sensor.faults ? 1 : 0, r.sensor.noise_levels, nameOf(r.kind), r.bits, r.felt_by, e.rms_n,
                 e.rms_percent, e.direction_rms_deg, e.lost_ticks, e.contactLost() ? 1 : 0, kNothing, kNothing,
                 kNothing});
    }
    for (const EdgeRow& r : edges_) {
      table.row({"edge", r.sensor.faults ? 1 : 0, r.sensor.noise_levels, nameOf(r.kind), "", "", kNothing, kNothing,
                 kNothing, "", "", r.mean_px, r.most_px, r.within_percent});
    }
    return table.write(options_.out + "/enhance.csv");
  }

  [[nodiscard]] double percent(const SensorModel& s, const std::optional<Enhancement>& kind, int bits,
                               std::string_view felt_by = kFeltBy[0]) const {
    const auto found = std::find_if(forces_.begin(), forces_.end(), [&](const EnhanceRow& r) {
      return r.sensor.noise_levels == s.noise_levels && r.sensor.faults == s.faults && r.kind == kind &&
             r.bits == bits && r.felt_by == felt_by;
    });
    return found->sum.result().rms_percent;
  }

  // Each method's error without any enhancement and with the one that suits it best, at the most noise.
  [[nodiscard]] std::string methodWords(const SensorModel& sensor) const {
    std::string words;
    for (const char* method : kFeltBy) {
      const auto best = *std::min_element(kKinds.begin(), kKinds.end(), [&](const auto& a, const auto& b) {
        return percent(sensor, a, 8, method) < percent(sensor, b, 8, method);
      });
      words += print("%s%s %.3g, at best %.3g (%s)", words.empty() ? "" : "; ", method,
                     percent(sensor, std::nullopt, 8, method), percent(sensor, best, 8, method), nameOf(best));
    }
    return words;
  }

  [[nodiscard]] ChartWords forceWords() const {
    double least_gain = std::numeric_limits<double>::infinity(), within = 100;
    for (const bool faults : {false, true}) {
      for (const double noise : plan_.noises) {
        const SensorModel s{noise, faults};
        least_gain = std::min(least_gain, percent(s, std::nullopt, 8) / percent(s, Enhancement::Dibm, 8));
      }
    }
    for (const EdgeRow& r : edges_) within = r.kind == Enhancement::Dibm ? std::min(within, r.within_percent) : within;
    const SensorModel noise{plan_.noises.back(), false}, faults{plan_.noises.back(), true};
    return {"Enhancement: the force's error on depth that a camera has seen, and where its edges are",
            print("With modified-proxy-graph dibm's error is at most 1/%.1f of none's. Of dibm's edges %.1f %% are "
                  "within 1 px at worst. Errors in %% at noise of %g levels, 8 bits, "
                  "without any enhancement and with the best: %s. With salt, holes and flying pixels: %s.",
                  least_gain, within, noise.noise_levels, methodWords(noise).c_str(), methodWords(faults).c_str())};
  }

  const MeasureOptions& options_;
  Plan plan_;
  std::vector<EnhanceRow> forces_;
  std::vector<EdgeRow> edges_;
};

}  // namespace

Outcome<std::vector<ChartWords>> measureEnhancement(const MeasureOptions& options) {
  return Enhance(options).run();
}

}  // namespace relievo
