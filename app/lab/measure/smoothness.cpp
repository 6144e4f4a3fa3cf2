// SPDX-License-Identifier: Apache-2.0
// All curves use one film of 12 s at a time, so that 100 s are never in memory.
#include "app/lab/measure/smoothness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/parallel.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/finger/held_finger.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/numbers/spectrum.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kScene = "face-nodding";
constexpr double kSegmentS = 10;
constexpr double kHighestHz = 100;      // of the tables
constexpr double kPeakHalfWidthHz = 2;  // the scene's own movements are sidebands of the frame rate

struct CurveKind {
  const char* contender;
  const char* hold;  // the curve that its peak is compared with: the same or a similar surface, with the frame held
};
constexpr std::array kCurves{
    CurveKind{"relievo", "relievo hold"},
    CurveKind{"relievo hold", "relievo hold"},
    CurveKind{"relievo linear", "relievo hold"},
    CurveKind{"relievo bspline", "relievo hold"},
    CurveKind{"relievo fitted", "relievo hold"},
    CurveKind{"modified-proxy-graph", "modified hold"},
    CurveKind{"modified hold", "modified hold"},
    CurveKind{"proxy-blend", "modified hold"},
    CurveKind{"proxy-graph", "modified hold"},
    CurveKind{"god-object", "god-object hold"},
    CurveKind{"god-object hold", "god-object hold"},
    CurveKind{"god-object-smoothed", "relievo hold"},
};

struct Setting {
  FingerHold hold;
  int frames_per_s;
  const DepthKind* depth;
};
constexpr int kFrameRates[] = {15, 30};
constexpr const DepthKind* kDepths[] = {&kDepthKinds[1], &kDepthKinds[0]};
constexpr FingerHold kHolds[] = {FingerHold::FixedPoint, FingerHold::RestingHand};

struct Curve {
  Setting setting;
  const CurveKind* kind;
  Spectrum spectrum;
  ForceErrorSum errors;
  std::vector<double> density;
  int look_ahead_frames = 0;

  [[nodiscard]] std::string column() const {
    return print("%s %d/s %s", kind->contender, setting.frames_per_s, setting.depth->name);
  }
  // NaN where contact is lost, since there is hardly any force.
  [[nodiscard]] double peakDb() const {
    if (lost()) return std::numeric_limits<double>::quiet_NaN();
    const double step = spectrum.stepHz();
    const auto index = [&](double hz) { return std::lround(hz / step); };
    const auto from = density.begin() + index(setting.frames_per_s - kPeakHalfWidthHz);
    const auto to = density.begin() + index(setting.frames_per_s + kPeakHalfWidthHz) + 1;
    return toDecibel(*std::max_element(from, to));
  }
  [[nodiscard]] double latencyMs() const { return 1000.0 * look_ahead_frames / setting.frames_per_s; }
  [[nodiscard]] bool lost() const { return errors.result().contactLost(); }
};

class Smoothness {
 public:
  explicit Smoothness(const MeasureOptions& options) : options_(options), segments_(options.quick ? 1 : 10) {}

  Outcome<std::vector<ChartWords>> run() {
    const auto face = makeTrueSurface(kScene);
    for (const int rate : kFrameRates) {
      for (const DepthKind* depth : kDepths) {
        if (auto done = addFilms(*face, rate, *depth); !done) return std::unexpected(done.error());
      }
    }
    if (auto done = writeTables(); !done) return std::unexpected(done.error());
    return std::vector{spectrumWords(FingerHold::FixedPoint), spectrumWords(FingerHold::RestingHand), peakWords()};
  }

 private:
  Outcome<void> addFilms(const TrueSurface& face, int rate, const DepthKind& depth) {
    const std::size_t first = curves_.size();
    for (const FingerHold hold : kHolds) {
      for (const CurveKind& kind : kCurves) {
        auto spectrum =
            Spectrum::make(static_cast<std::size_t>(kSegmentS / FingerPathOptions::kTickS), FingerPathOptions::kTickS);
        if (!spectrum) return failOn("smoothness", spectrum.error());
        curves_.push_back({{hold, rate, &depth}, &kind, std::move(*spectrum), {}, {}});
      }
    }
    for (int s = 0; s < segments_; ++s) {
      const int films = static_cast<int>(std::size(kFrameRates) * std::size(kDepths)) * segments_;
      options_.tell(print("spectra, film %d of %d: %d frames/s, %s", ++films_begun_, films, rate, depth.name));
      const HoldPlan plan{.from_s = s * kSegmentS, .measured_s = kSegmentS};
      const auto film = MemoryFilm::make(face, {.depth = depth, .frames_per_s = static_cast<double>(rate)}, plan.from_s,
                                         plan.from_s + HoldPlan::kSettleS + kSegmentS);
      if (!film) return failOn(kScene, film.error());
      const FilmViews views(*film);
      inParallel(curves_.size() - first, [&](std::size_t i) { addSegment(face, views, plan, curves_[first + i]); });
    }
    for (std::size_t i = first; i < curves_.size(); ++i) curves_[i].density = curves_[i].spectrum.density();
    return {};
  }

  static void addSegment(const TrueSurface& face, const FilmViews& film, const HoldPlan& plan, Curve& curve) {
    const Contender& who = *contender(curve.kind->contender);
    const auto method = who.make(film.raw());
    const auto ticks = holdFinger(face, film.of(who), *method, curve.setting.hold, plan);
    std::vector<double> magnitudes;
    magnitudes.reserve(ticks.size());
    for (const PlayedTick& tick : ticks) magnitudes.push_back(glm::length(tick.touch.force_n));
    curve.look_ahead_frames = who.parts(film.raw()).look_ahead_frames;
    curve.spectrum.add(magnitudes);
    curve.errors.add(forceErrors(ticks, 0));
  }

  [[nodiscard]] const Curve& find(const Setting& setting, std::string_view contender_label) const {
    return *std::find_if(curves_.begin(), curves_.end(), [&](const Curve& c) {
      return c.setting.hold == setting.hold && c.setting.frames_per_s == setting.frames_per_s &&
             c.setting.depth == setting.depth && contender_label == c.kind->contender;
    });
  }
  [[nodiscard]] double underHoldDb(const Curve& curve) const {
    return find(curve.setting, curve.kind->hold).peakDb() - curve.peakDb();
  }

  [[nodiscard]] Outcome<void> writeTables() const {
    if (auto done = writeSpectra(FingerHold::FixedPoint, "/smoothness.csv"); !done) return done;
    if (auto done = writeSpectra(FingerHold::RestingHand, "/smoothness-hand.csv"); !done) return done;
    CsvTable table({"finger", "frames_per_s", "depth", "method", "peak_db", "under_hold_db", "force_rms_n",
                    "force_rms_percent", "magnitude_rms_percent", "lost_ticks", "look_ahead_frames",
                    "added_latency_ms"});
    for (const Curve& c : curves_) {
      const ForceError e = c.errors.result();
      table.row({c.setting.hold == FingerHold::FixedPoint ? "fixed point" : "resting hand", c.setting.frames_per_s,
                 c.setting.depth->name, c.kind->contender, c.peakDb(), underHoldDb(c), e.rms_n, e.rms_percent,
                 e.magnitude_rms_percent, e.lost_ticks, c.look_ahead_frames, c.latencyMs()});
    }
    return table.write(options_.out + "/smoothness-peaks.csv");
  }

  [[nodiscard]] Outcome<void> writeSpectra(FingerHold hold, const char* name) const {
    std::vector<Cell> header{"frequency_hz"};
    for (const Curve& c : curves_) {
      if (c.setting.hold == hold) header.emplace_back(c.column());
    }
    CsvTable table(header);
    const double step = curves_.front().spectrum.stepHz();
    for (std::size_t k = 1; static_cast<double>(k) * step <= kHighestHz; ++k) {
      std::vector<Cell> row{static_cast<double>(k) * step};
      for (const Curve& c : curves_) {
        if (c.setting.hold == hold) row.emplace_back(toDecibel(c.density[k]));
      }
      table.row(row);
    }
    return table.write(options_.out + name);
  }

  [[nodiscard]] std::string lostWords(const Setting& setting) const {
    std::string losers;
    for (const CurveKind& kind : kCurves) {
      if (find(setting, kind.contender).lost()) losers += (losers.empty() ? "" : ", ") + std::string(kind.contender);
    }
    return losers.empty() ? "" : " Without contact, and so without a curve: " + losers + ".";
  }

  [[nodiscard]] ChartWords spectrumWords(FingerHold hold) const {
    const Setting setting{hold, 15, &kEightBits};
    std::string reading;
    for (const char* method : {"relievo", "god-object", "god-object-smoothed", "modified-proxy-graph"}) {
      const Curve& curve = find(setting, method);
      reading +=
          print("%s%s %.0f dB (%d)", reading.empty() ? "" : ", ", method, underHoldDb(curve), curve.look_ahead_frames);
    }
    return {print("Force spectrum on a nodding face, %s, %d s",
                  hold == FingerHold::FixedPoint ? "finger held at a point" : "a resting hand",
                  static_cast<int>(segments_ * kSegmentS)),
            "15 frames/s, 8 bits. How far each method's peak at the frame rate lies below that of holding the frame, "
            "with its frames of look-ahead: " +
                reading +
                "; the paper says 18 dB for its method. Smoothing every frame calms the steps of depth between "
                "the movements of the scene; at the frame rate, the interpolation in time decides." +
                lostWords(setting)};
  }

  [[nodiscard]] ChartWords peakWords() const {
    const Setting setting{FingerHold::FixedPoint, 15, &kEightBits};
    std::string reading;
    for (const char* method : {"relievo", "relievo linear", "god-object", "god-object-smoothed"}) {
      const Curve& curve = find(setting, method);
      reading += print("%s%s %.0f dB with %.2g %%", reading.empty() ? "" : "; ", method, underHoldDb(curve),
                       curve.errors.result().rms_percent);
    }
    return {"The peak at the frame rate against the error of the force",
            "15 frames/s, 8 bits, finger held at a point. How far each peak lies below that of holding the frame on "
            "the same surface (of god-object-smoothed: on a similar one), and with what error of the force: " +
                reading + "." + lostWords(setting)};
  }

  const MeasureOptions& options_;
  int segments_;
  int films_begun_ = 0;
  std::vector<Curve> curves_;
};

}  // namespace

Outcome<std::vector<ChartWords>> measureSmoothness(const MeasureOptions& options) {
  return Smoothness(options).run();
}

}  // namespace relievo
