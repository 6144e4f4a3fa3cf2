// SPDX-License-Identifier: Apache-2.0
// All matchers get the same pictures, one film after the other, so that each is timed alone.
#include "app/lab/measure/stereo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/requantised.h"
#include "app/lab/film/view_film.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/contenders.h"
#include "app/lab/measure/stereo_matchers.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kPlayersBudgetMs = 0.6 * 1000 / 24;  // what the player allows a relief of a film of 24 pictures/s

// One film of an axis, which differs from the base film in one thing; the base film is on every axis.
struct Place {
  const char* axis;
  std::string value;
  ViewFilmFormat film;
};

struct Plan {
  std::vector<std::string_view> scenes{"face-heaving", "sphere-heaving"};
  std::vector<int> sizes{320, 640, 960};
  std::vector<double> reaches{0.014, 0.028, 0.056};
  std::vector<std::optional<int>> qualities{std::nullopt, 18, 28};
  int cols = 640;
  double frames_per_s = 30, duration_s = 0.9;

  static Plan of(bool quick) {
    if (!quick) return {};
    return {.scenes = {"face-heaving"},
            .sizes = {320, 480},
            .reaches = {0.028, 0.056},
            .qualities = {std::nullopt, 28},
            .cols = 320,
            .frames_per_s = 15,
            .duration_s = 0.5};
  }
  [[nodiscard]] int pictures() const {
    return static_cast<int>(std::ceil(duration_s * frames_per_s)) + SurfaceWindow::kAhead + 1;
  }
  [[nodiscard]] ViewFilmFormat base() const { return {.cols = cols, .frames_per_s = frames_per_s}; }
  [[nodiscard]] std::vector<Place> places() const {
    std::vector<Place> all;
    const auto add = [&](const char* axis, std::string value, auto&& change) {
      Place place{axis, std::move(value), base()};
      change(place.film);
      all.push_back(std::move(place));
    };
    for (const int size : sizes) add("size", print("%d", size), [&](auto& f) { f.cols = size; });
    for (const double reach : reaches) {
      add("baseline", print("%.1f %%", 100 * reach), [&](auto& f) { f.reach = reach; });
    }
    for (const auto& crf : qualities) {
      add("codec", crf ? print("crf %d", *crf) : "none", [&](auto& f) { f.crf = crf; });
    }
    for (const bool rich : {true, false}) add("texture", rich ? "rich" : "weak", [&](auto& f) { f.rich = rich; });
    return all;
  }
};

struct Figures {
  ForceErrorSum force;
  HeightErrorSum heights;
  std::vector<double> ms;

  [[nodiscard]] double percent() const { return force.result().rms_percent; }
  [[nodiscard]] double time() const { return spreadOf(ms).median; }
};

using FilmKey = std::array<double, 4>;
FilmKey keyOf(const ViewFilmFormat& f) {
  return {static_cast<double>(f.cols), f.reach, f.crf ? static_cast<double>(*f.crf) : -1.0, f.rich ? 1.0 : 0.0};
}

class Stereo {
 public:
  explicit Stereo(const MeasureOptions& options) : options_(options), plan_(Plan::of(options.quick)) {}

  Outcome<std::vector<ChartWords>> run() {
    const auto places = plan_.places();
    for (const std::string_view name : plan_.scenes) {
      const Scene scene = makeScene(name);
      std::map<FilmKey, bool> seen;
      for (const Place& place : places) {
        if (!seen.try_emplace(keyOf(place.film), true).second) continue;
        options_.tell(print("%s, %s %s", std::string(name).c_str(), place.axis, place.value.c_str()));
        if (auto done = addFilm(scene, place.film); !done) return failOn(std::string(name), done.error());
      }
    }
    if (auto done = writeTable(places); !done) return std::unexpected(done.error());
    return std::vector{words(places)};
  }

 private:
  struct Scene {
    std::unique_ptr<TrueSurface> surface;
    std::vector<HipTick> path;
    std::vector<TrueTouch> truth;
  };
  Scene makeScene(std::string_view name) const {
    Scene scene{makeTrueSurface(name), {}, {}};
    scene.path = makeFingerPath(*scene.surface, {.duration_s = plan_.duration_s});
    scene.truth = truthAlong(*scene.surface, scene.path);
    return scene;
  }

  Result<void> addFilm(const Scene& scene, const ViewFilmFormat& format) {
    const auto views = ViewFilm::make(*scene.surface, format, plan_.pictures());
    if (!views) return std::unexpected(views.error());
    auto exact = renderDepthFilm(
        *scene.surface, {.cols = format.cols, .rows = format.rows(), .frames_per_s = format.frames_per_s, .bits = 16},
        plan_.pictures());
    if (auto done = feel(scene, exact, exact, figures_[{keyOf(format), "exact"}]); !done) return done;
    for (const Contestant& who : contestantsOn(format)) {
      Figures& figures = figures_[{keyOf(format), who.name}];
      const Matcher match = who.make(format);
      std::vector<Frame> depth;
      for (std::size_t i = 0; i < views->left.size(); ++i) {
        auto [picture, ms] = match(views->left[i], views->right[i]);
        depth.push_back(std::move(picture));
        if (i > 0) figures.ms.push_back(ms);  // the first one of a shot takes longer
      }
      if (auto done = feel(scene, depth, exact, figures); !done) return done;
    }
    return {};
  }

  static Result<void> feel(const Scene& scene, std::span<const Frame> depth, std::span<const Frame> exact,
                           Figures& figures) {
    const auto film = MemoryFilm::of(depth, {.bits = 16});
    if (!film) return std::unexpected(film.error());
    const auto method = contender("relievo")->make(*film);
    figures.force.add(forceErrors(playPath(*film, *method, scene.path, scene.truth), kSettledS));
    if (depth.front().width != exact.front().width) return {};
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const auto felt = HeightField::make(depth[i], {.bits = 16}, TrueSurface::kVolume);
      const auto truth = HeightField::make(exact[i], {.bits = 16}, TrueSurface::kVolume);
      if (!felt || !truth) return std::unexpected(felt ? truth.error() : felt.error());
      figures.heights.add(*felt, *truth);
    }
    return {};
  }

  [[nodiscard]] const Figures& of(const ViewFilmFormat& film, const std::string& name) const {
    return figures_.at({keyOf(film), name});
  }
  // The largest size of the player's that keeps within its time.
  [[nodiscard]] std::string playersAt(const ViewFilmFormat& film) const {
    std::string chosen;
    for (const Contestant& who : contestantsOn(film)) {
      if (who.quick_cols == 0) continue;
      if (chosen.empty() || of(film, who.name).time() <= kPlayersBudgetMs) chosen = who.name;
    }
    return chosen;
  }

  [[nodiscard]] Outcome<void> writeTable(const std::vector<Place>& places) const {
    CsvTable table({"axis", "value", "matcher", "marked", "cpu_ms", "force_rms_percent", "direction_rms_deg",
                    "lost_ticks", "contact_lost", "height_rms_mm"});
    for (const Place& place : places) {
      const std::string players = playersAt(place.film);
      auto names = contestantsOn(place.film);
      names.push_back({"exact"});
      for (const Contestant& who : names) {
        const Figures& f = of(place.film, who.name);
        const ForceError e = f.force.result();
        const char* marked = who.name == kAuthors ? "author" : who.name == players ? "player" : "";
        const bool timed = who.name != "exact";
        table.row({place.axis, place.value, who.name, marked,
                   timed ? f.time() : std::numeric_limits<double>::quiet_NaN(), e.rms_percent, e.direction_rms_deg,
                   e.lost_ticks, e.contactLost() ? 1 : 0,
                   f.heights.rms() > 0 || !timed ? f.heights.rms() : std::numeric_limits<double>::quiet_NaN()});
      }
    }
    return table.write(options_.out + "/stereo.csv");
  }

  [[nodiscard]] std::string tell(const ViewFilmFormat& film, const std::string& name) const {
    const double percent = of(film, name).percent(), ms = of(film, name).time();
    return print(percent < 99.5 ? "%.2g %% in " : "%.0f %% in ", percent) +
           print(ms < 999.5 ? "%.3g ms" : "%.0f ms", ms);
  }
  [[nodiscard]] ChartWords words(const std::vector<Place>& places) const {
    const ViewFilmFormat base = plan_.base();
    const std::string players = playersAt(base);
    std::map<FilmKey, std::string> best;
    for (const Place& place : places) {
      std::string& least = best[keyOf(place.film)];
      for (const Contestant& who : contestantsOn(place.film)) {
        if (least.empty() || of(place.film, who.name).percent() < of(place.film, least).percent()) least = who.name;
      }
    }
    const auto wins = [&](auto&& counts) {
      return std::ranges::count_if(best, [&](const auto& b) { return counts(b.second); });
    };
    ViewFilmFormat weak = base;
    weak.rich = false;
    std::string text = print("%d columns a view, crf 18, rich texture: ", base.cols);
    for (const std::string& name : {std::string(kAuthors), players, std::string("SGBM"), std::string("BM")}) {
      text += print("%s %s; ", name.c_str(), tell(base, name).c_str());
    }
    text += print("exact depth %.2g %%. Weak texture: ", of(base, "exact").percent());
    text += print("author %s, %s %s, SGBM %s. ", tell(weak, kAuthors).c_str(), players.c_str(),
                  tell(weak, players).c_str(), tell(weak, "SGBM").c_str());
    text += print("Of %zu films the author's matcher has the least error in %td and one of the player's sizes in %td; ",
                  best.size(), wins([](const std::string& n) { return n == kAuthors; }),
                  wins([](const std::string& n) { return n.starts_with("quick"); }));
    text += print(
        "the player's takes %.0f %% of the author's time. Heights of the whole "
        "picture, what one eye alone sees included, are off by %.2g mm rms with the author's, %.2g with the player's, "
        "%.2g with SGBM alone. The author's, SGBM and BM are given the true range of disparities, and finding it is "
        "not timed; the player's finds its own.",
        100 * of(base, players).time() / of(base, kAuthors).time(), of(base, kAuthors).heights.rms(),
        of(base, players).heights.rms(), of(base, "SGBM").heights.rms());
    return {"Depth from two views: the force's error against the time that a picture takes", text};
  }

  const MeasureOptions& options_;
  Plan plan_;
  std::map<std::pair<FilmKey, std::string>, Figures> figures_;
};

}  // namespace

Outcome<std::vector<ChartWords>> measureStereo(const MeasureOptions& options) {
  return Stereo(options).run();
}

}  // namespace relievo
