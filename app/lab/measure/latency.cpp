// SPDX-License-Identifier: Apache-2.0
// All surfaces get the same frames, which arrive at the same times.
#include "app/lab/measure/latency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "app/depth_window/touch_plan.h"
#include "app/haptics/method/relievo_method.h"
#include "app/lab/chart/csv_table.h"
#include "app/lab/film/live_run.h"
#include "app/lab/film/parallel.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/finger/held_finger.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/numbers/spectrum.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kScene = "face-nodding";
constexpr double kPeakHalfWidthHz = 2;  // the scene's own movements are sidebands of the frame rate
constexpr Duration kExpectedLate = std::chrono::milliseconds(12);  // of CameraDelay{}
constexpr std::array kRates{15, 30, 60};
constexpr std::array kDepths{&kDepthKinds[0], &kDepthKinds[1], &kDepthKinds[3]};

struct SurfaceKind {
  std::string name;
  LookAhead ahead;  // `frames` may be more than any law needs: a reserve
  bool held = false;
};

std::vector<SurfaceKind> surfacesAt(int frames_per_s) {
  const Duration period = fromSeconds(1.0 / frames_per_s);
  std::vector<SurfaceKind> kinds{{"hold", {0, Duration(0)}, true}};
  for (int frames = 1; frames <= 5; ++frames) kinds.push_back({print("%d ahead", frames), {frames, Duration(0)}});
  kinds.push_back({"carried half", {1, period / 2}});
  kinds.push_back({"carried", {1, period}});
  kinds.push_back({"chosen", lookAheadFor(period, kExpectedLate)});
  return kinds;
}

struct Curve {
  int frames_per_s;
  const DepthKind* depth;
  SurfaceKind kind;
  Spectrum spectrum;
  ForceErrorSum own, now;  // against the scene at the moment that is felt, and at the present one
  std::vector<double> ages_ms;

  [[nodiscard]] double peakDb() const {
    if (own.result().contactLost()) return std::numeric_limits<double>::quiet_NaN();
    const auto density = spectrum.density();
    const auto at = [&](double hz) { return density.begin() + std::lround(hz / spectrum.stepHz()); };
    return toDecibel(*std::max_element(at(frames_per_s - kPeakHalfWidthHz), at(frames_per_s + kPeakHalfWidthHz) + 1));
  }
};

FeltScale scaleOf(const MemoryFilm& film, const SurfaceKind& kind) {
  LookAhead ahead = kind.ahead;
  ahead.frames = std::max(ahead.frames, 1);
  FeltScale scale = planFilm(film.frames(), ahead).scale;
  if (kind.held) scale.narrow_time = scale.wide_time = TimeLaw::Hold;
  return scale;
}

void addSegment(const TrueSurface& face, const MemoryFilm& film, const HoldPlan& plan, Curve& cell) {
  RelievoMethod method({.stiffness_n_per_mm = kStiffnessNPerMm, .scale = scaleOf(film, cell.kind)});
  LiveRun run(film, method, cell.kind.ahead, {});
  Oracle then(face);
  std::vector<PlayedTick> felt;
  const auto answer = [&](const HipTick& hip) {
    PlayedTick tick = run.tick(hip);
    tick.truth = then.update(hip.hip_mm, run.feltS());
    if (hip.t_s >= plan.from_s + HoldPlan::kSettleS) {
      felt.push_back(tick);
      cell.ages_ms.push_back(1e3 * (hip.t_s - run.feltS()));
    }
    return tick;
  };
  auto now = holdFinger(face, answer, FingerHold::FixedPoint, plan);
  std::vector<double> magnitudes;
  magnitudes.reserve(now.size());
  for (const PlayedTick& tick : now) magnitudes.push_back(glm::length(tick.touch.force_n));
  cell.spectrum.add(magnitudes);
  cell.now.add(forceErrors(now, 0));
  cell.own.add(forceErrors(felt, 0));
}

class Latency {
 public:
  explicit Latency(const MeasureOptions& options)
      : options_(options), segments_(options.quick ? 1 : 5), segment_s_(options.quick ? 2 : 4) {}

  Outcome<std::vector<ChartWords>> run() {
    const auto face = makeTrueSurface(kScene);
    for (const int rate : kRates) {
      for (const DepthKind* depth : kDepths) {
        if (auto done = addFilms(*face, rate, *depth); !done) return std::unexpected(done.error());
      }
    }
    if (auto done = writeTable(); !done) return std::unexpected(done.error());
    return std::vector{words()};
  }

 private:
  Outcome<void> addFilms(const TrueSurface& face, int rate, const DepthKind& depth) {
    const std::size_t first = cells_.size();
    for (SurfaceKind& kind : surfacesAt(rate)) {
      auto spectrum =
          Spectrum::make(static_cast<std::size_t>(segment_s_ / FingerPathOptions::kTickS), FingerPathOptions::kTickS);
      if (!spectrum) return failOn("latency", spectrum.error());
      cells_.push_back({rate, &depth, std::move(kind), std::move(*spectrum), {}, {}, {}});
    }
    for (int s = 0; s < segments_; ++s) {
      options_.tell(print("%d frames/s, %s, film %d of %d", rate, depth.name, s + 1, segments_));
      const HoldPlan plan{.from_s = s * segment_s_, .measured_s = segment_s_};
      const auto film = MemoryFilm::make(face, {.depth = depth, .frames_per_s = static_cast<double>(rate)}, plan.from_s,
                                         plan.from_s + HoldPlan::kSettleS + segment_s_);
      if (!film) return failOn(kScene, film.error());
      inParallel(cells_.size() - first, [&](std::size_t i) { addSegment(face, *film, plan, cells_[first + i]); });
    }
    return {};
  }

  [[nodiscard]] const Curve& find(int rate, const DepthKind* depth, std::string_view kind) const {
    return *std::find_if(cells_.begin(), cells_.end(), [&](const Curve& c) {
      return c.frames_per_s == rate && c.depth == depth && c.kind.name == kind;
    });
  }
  [[nodiscard]] double underHoldDb(const Curve& c) const {
    return find(c.frames_per_s, c.depth, "hold").peakDb() - c.peakDb();
  }

  [[nodiscard]] Outcome<void> writeTable() const {
    CsvTable table({"frames_per_s", "depth", "surface", "look_ahead_frames", "carried_ms", "age_median_ms",
                    "age_p99_ms", "own_rms_percent", "now_rms_percent", "peak_db", "under_hold_db", "lost_ticks"});
    for (const Curve& c : cells_) {
      const Spread age = spreadOf(c.ages_ms);
      table.row({c.frames_per_s, c.depth->name, c.kind.name, c.kind.ahead.frames, 1e3 * toSeconds(c.kind.ahead.carried),
                 age.median, age.p99, c.own.result().rms_percent, c.now.result().rms_percent, c.peakDb(),
                 underHoldDb(c), c.own.result().lost_ticks});
    }
    return table.write(options_.out + "/latency.csv");
  }

  [[nodiscard]] ChartWords words() const {
    std::string reading;
    for (const int rate : kRates) {
      const Curve& c = find(rate, &kEightBits, "chosen");
      reading +=
          print("%s%d frames/s: %.0f ms old (p99), %.2g %% off the present scene, %.0f dB under hold",
                reading.empty() ? "" : "; ", rate, spreadOf(c.ages_ms).p99, c.now.result().rms_percent, underHoldDb(c));
    }
    return {"Age of the felt surface of a live film, against the error of the force and the tremor at the frame rate",
            "Camera with 5 ms of jitter, a finger held on a nodding face. What the player chooses, 8 bits: " + reading +
                "."};
  }

  const MeasureOptions& options_;
  int segments_;
  double segment_s_;
  std::vector<Curve> cells_;
};

}  // namespace

Outcome<std::vector<ChartWords>> measureLatency(const MeasureOptions& options) {
  return Latency(options).run();
}

}  // namespace relievo
