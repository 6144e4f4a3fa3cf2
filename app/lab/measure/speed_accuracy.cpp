// SPDX-License-Identifier: Apache-2.0
// Accuracy first, on all processors; then times, on one.
#include "app/lab/measure/speed_accuracy.h"

#include <algorithm>

#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/speed_accuracy_tables.h"
#include "platform/print.h"

namespace relievo {
namespace {

struct Plan {
  std::vector<std::string_view> scenes = accuracyScenes();
  double duration_s = 3;
  std::vector<double> speeds_m_per_s{kSlowMPerS, 1, 5};
  std::vector<PictureSize> sizes{{720, 486}, {1920, 1080}, {3840, 2160}};
  int rounds = 50;
  std::size_t cold_ticks = 1000;  // on the smallest and the largest picture

  static Plan of(bool quick) {
    if (!quick) return {};
    return {.scenes = {"plane-heaving", "sphere-sliding", kTimedScene},
            .duration_s = 1.5,
            .speeds_m_per_s = {kSlowMPerS, 1},
            .sizes = {{720, 486}},
            .rounds = 3,
            .cold_ticks = 20};
  }
};

class SpeedAccuracy {
 public:
  explicit SpeedAccuracy(const MeasureOptions& options) : options_(options), plan_(Plan::of(options.quick)) {
    for (const Contender& c : contenders()) all_.push_back(&c);
    figures_.clock_ns = static_cast<int>(clockCost().count());
  }

  Outcome<std::vector<ChartWords>> run() {
    if (auto done = addAccuracy(); !done) return std::unexpected(done.error());
    for (const PictureSize& size : plan_.sizes) {
      for (const DepthKind& depth : kDepthKinds) {
        if (size != PictureSize{} && &depth != &kEightBits) continue;
        if (auto done = addTimes(size, depth); !done) return std::unexpected(done.error());
      }
    }
    if (auto done = writeTables(figures_, options_.out); !done) return std::unexpected(done.error());
    return chartWords(figures_);
  }

 private:
  Outcome<void> addAccuracy() {
    const auto table = measureAccuracy(contenders(), {plan_.scenes, plan_.duration_s}, options_.tell);
    if (!table) return std::unexpected(table.error());
    for (std::size_t c = 0; c < all_.size(); ++c) {
      for (std::size_t d = 0; d < kDepthKinds.size(); ++d) {
        ForceErrorSum together;
        for (std::size_t s = 0; s < plan_.scenes.size(); ++s) {
          const auto& [sum, parts] = (*table)[c][d][s];
          together.add(sum);
          addError(*all_[c], kDepthKinds[d], std::string(plan_.scenes[s]), parts, sum.result());
        }
        addError(*all_[c], kDepthKinds[d], kAllScenes, {}, together.result());
      }
    }
    return {};
  }

  void addError(const Contender& who, const DepthKind& depth, std::string scene, const ContenderParts& parts,
                const ForceError& error) {
    figures_.rows.push_back({.who = &who, .depth = &depth, .scene = std::move(scene), .parts = parts, .error = error});
  }

  // One film. Other depth than 8 bits is timed with the slow finger alone.
  Outcome<void> addTimes(const PictureSize& size, const DepthKind& depth) {
    const std::string what = print("%dx%d, %s", size.cols, size.rows, depth.name);
    const std::size_t films = kDepthKinds.size() + plan_.sizes.size() - 1;
    const std::string film_of = print("times, film %zu of %zu: ", ++films_timed_, films) + what;
    options_.tell(film_of);
    const auto surface = makeTrueSurface(kTimedScene);
    const auto film = MemoryFilm::make(*surface, {depth, size.cols, size.rows}, 0, plan_.duration_s);
    if (!film) return failOn("depth of " + what, film.error());
    const FilmViews views(*film);
    for (const double speed : plan_.speeds_m_per_s) {
      if (speed != kSlowMPerS && &depth != &kEightBits) continue;
      options_.tell(film_of + print(", %g m/s", speed));
      const auto path = makeFingerPath(*surface, {.speed_mm_per_s = 1000 * speed, .duration_s = plan_.duration_s});
      const auto truth = truthAlong(*surface, path);
      const TimedPath timed{views, path, static_cast<std::size_t>(kSettledS / FingerPathOptions::kTickS)};
      const auto times = timeTicks(all_, timed, plan_.rounds);
      for (std::size_t c = 0; c < all_.size(); ++c) {
        const auto error = forceErrors(playPath(views, *all_[c], path, truth), kSettledS).result();
        addTimed({all_[c], &depth, kTimedScene, size, speed, false, all_[c]->parts(*film), error, times[c]});
      }
      if (speed == kSlowMPerS && &depth == &kEightBits) {
        options_.tell(film_of + ", cold caches");
        addColdTimes(size, timed);
      }
    }
    return {};
  }

  // If its accuracy was measured already, only the times are added; they apply to all scenes together, too.
  void addTimed(SpeedAccuracyRow row) {
    if (auto* known = figures_.find(row)) {
      known->times = row.times;
      row.scene = kAllScenes;
      figures_.find(row)->times = row.times;
    } else {
      figures_.rows.push_back(std::move(row));
    }
  }

  void addColdTimes(const PictureSize& size, const TimedPath& timed) {
    if (size != plan_.sizes.front() && size != plan_.sizes.back()) return;
    const std::vector<const Contender*> some{contender("relievo"), contender("god-object"),
                                             contender("god-object-smoothed")};
    const auto times = timeColdTicks(some, timed, plan_.cold_ticks);
    for (std::size_t c = 0; c < some.size(); ++c) {
      figures_.rows.push_back(
          {.who = some[c], .size = size, .cold = true, .parts = some[c]->parts(timed.film.raw()), .times = times[c]});
    }
  }

  const MeasureOptions& options_;
  Plan plan_;
  std::vector<const Contender*> all_;
  std::size_t films_timed_ = 0;
  SpeedAccuracyFigures figures_;
};

}  // namespace

Outcome<std::vector<ChartWords>> measureSpeedAndAccuracy(const MeasureOptions& options) {
  return SpeedAccuracy(options).run();
}

}  // namespace relievo
