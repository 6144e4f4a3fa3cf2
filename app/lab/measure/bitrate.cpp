// SPDX-License-Identifier: Apache-2.0
// Each scene is rendered once, in 16 bits; every coding begins from that.
#include "app/lab/measure/bitrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "app/lab/chart/csv_table.h"
#include "app/lab/film/coded_depth.h"
#include "app/lab/film/color_errors.h"
#include "app/lab/film/parallel.h"
#include "app/lab/film/requantised.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/contenders.h"
#include "app/lab/measure/tick_timing.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kFramesPerSecond = 30;

constexpr std::string_view kTimedScene = "face-nodding";
constexpr int kTimedCrf = 18;
constexpr std::size_t kPicturesPerColor = 8;  // every so many pictures are read naively, too

// How recorders paint depth, coded as films are.
constexpr DepthSteps kColored[] = {DepthSteps::Hue, DepthSteps::HueDisparity, DepthSteps::Turbo};

struct Coding {
  VideoCodec codec = VideoCodec::H264;
  int bits = 8;
  DepthSteps steps = DepthSteps::Even;
  int crf = 8;  // 0: lossless

  [[nodiscard]] bool isDefault() const {
    return codec == VideoCodec::H264 && bits == 8 && steps == DepthSteps::Even && crf == 8;
  }
};

struct Plan {
  std::vector<std::string_view> scenes{"plane-heaving", "sphere-sliding", "face-nodding", "shallow-plane"};
  std::vector<int> qualities{2, 5, 8, 12, 16, 20, 24, 30};
  std::vector<std::pair<VideoCodec, int>> codecs{{VideoCodec::H264, 8},
                                                 {VideoCodec::H264, 10},
                                                 {VideoCodec::Hevc, 8},
                                                 {VideoCodec::Hevc, 10},
                                                 {VideoCodec::Hevc, 12}};
  double duration_s = 2;

  static Plan of(bool quick) {
    if (!quick) return {};
    return {.scenes = {"face-nodding"},
            .qualities = {8, 20},
            .codecs = {{VideoCodec::H264, 8}, {VideoCodec::H264, 10}, {VideoCodec::Hevc, 10}},
            .duration_s = 0.5};
  }
  [[nodiscard]] std::vector<Coding> codings() const {
    std::vector<Coding> all;
    for (const auto& [codec, bits] : codecs) {
      for (const int crf : qualities) all.push_back({codec, bits, DepthSteps::Even, crf});
    }
    for (const DepthSteps steps : {DepthSteps::Dithered, DepthSteps::Disparity}) {
      for (const int crf : qualities) all.push_back({VideoCodec::H264, 8, steps, crf});
    }
    for (const DepthSteps steps : kColored) {
      for (const int crf : {18, 23}) all.push_back({VideoCodec::H264, 8, steps, crf});
    }
    for (const int bits : {8, 10, 12, 16}) all.push_back({VideoCodec::Ffv1, bits, DepthSteps::Even, 0});
    for (const DepthSteps steps : {DepthSteps::Even, DepthSteps::Dithered, DepthSteps::Disparity}) {
      all.push_back({VideoCodec::H264, 8, steps, 0});
    }
    return all;
  }
};

struct Figures {
  Coding coding;
  std::uint64_t bytes = 0;
  ForceErrorSum force;          // relievo's
  ForceErrorSum raw, smoothed;  // of the god-object, on depth as it is and on depth smoothed per frame
  HeightErrorSum heights;
  ColorErrors colors;
};

// One film, the way over it and the truth.
struct Scene {
  std::vector<Frame> frames;  // 16 bits
  std::vector<HipTick> path;
  std::vector<TrueTouch> truth;
};

Scene makeScene(std::string_view name, double duration_s) {
  const auto surface = makeTrueSurface(name);
  Scene scene;
  scene.frames.resize(static_cast<std::size_t>(std::ceil(duration_s * kFramesPerSecond)) + SurfaceWindow::kAhead + 1);
  inParallel(scene.frames.size(), [&](std::size_t i) {
    scene.frames[i] = renderDepth(*surface, {.frames_per_s = kFramesPerSecond, .bits = 16}, static_cast<int>(i));
  });
  scene.path = makeFingerPath(*surface, {.duration_s = duration_s});
  scene.truth = truthAlong(*surface, scene.path);
  return scene;
}

struct CodedFilm {
  MemoryFilm film;
  std::vector<Frame> frames;
  std::uint64_t bytes = 0;
};

Result<CodedFilm> codedFilm(const Scene& scene, const Coding& coding) {
  std::vector<Frame> steps;
  steps.reserve(scene.frames.size());
  for (const Frame& frame : scene.frames) steps.push_back(requantised(frame, coding.bits, coding.steps));
  auto coded = codeDepth(steps, {.codec = coding.codec,
                                 .bits = coding.bits,
                                 .to_touch = coding.steps < DepthSteps::Hue,
                                 .quick = true,
                                 .crf = coding.crf});
  if (!coded) return std::unexpected(coded.error());
  auto film = MemoryFilm::of(coded->frames, meaningOf(coding.bits, coding.steps));
  if (!film) return std::unexpected(film.error());
  return CodedFilm{std::move(*film), std::move(coded->frames), coded->bytes};
}

Result<void> addScene(const Scene& scene, Figures& figures) {
  const auto coded = codedFilm(scene, figures.coding);
  if (!coded) return std::unexpected(coded.error());
  figures.bytes += coded->bytes;
  const MemoryFilm& film = coded->film;
  const FilmViews views(film);
  for (const auto& [sum, method] : {std::pair{&figures.force, "relievo"},
                                    {&figures.raw, "god-object"},
                                    {&figures.smoothed, "god-object-smoothed"}}) {
    sum->add(forceErrors(playPath(views, *contender(method), scene.path, scene.truth), kSettledS));
  }
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const auto truth = HeightField::make(scene.frames[i], {.bits = 16}, TrueSurface::kVolume);
    if (truth) figures.heights.add(film.frames()[i].field, *truth);
    if (!truth || figures.coding.steps < DepthSteps::Hue || i % kPicturesPerColor != 0) continue;
    figures.colors.add(coded->frames[i], meaningOf(8, figures.coding.steps), film.frames()[i].field, *truth);
  }
  return {};
}

struct TimedSteps {
  DepthSteps steps = DepthSteps::Even;
  TickTimes ticks;
};

// Ticks of relievo on one scene, as brightness and in colours, in turns, while nothing else is measured; of each the
// turn that other work on the machine disturbed least.
Result<std::vector<TimedSteps>> timeSteps(const Scene& scene) {
  constexpr int kTurns = 4, kRounds = 3;
  std::vector<TimedSteps> all{{.steps = DepthSteps::Even}};
  for (const DepthSteps steps : kColored) all.push_back({.steps = steps});
  std::vector<CodedFilm> films;
  for (const TimedSteps& timed : all) {
    auto coded = codedFilm(scene, {.steps = timed.steps, .crf = kTimedCrf});
    if (!coded) return std::unexpected(coded.error());
    films.push_back(std::move(*coded));
  }
  const std::array methods{contender("relievo")};
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const FilmViews views(films[i].film);
      const TimedPath path{views, scene.path, static_cast<std::size_t>(kSettledS / FingerPathOptions::kTickS)};
      const TickTimes ticks = timeTicks(methods, path, kRounds).front();
      if (turn == 0 || ticks.own_whole.median < all[i].ticks.own_whole.median) all[i].ticks = ticks;
    }
  }
  return all;
}

double kbitPerSecond(const Figures& f, const Plan& plan) {
  const double frames = std::ceil(plan.duration_s * kFramesPerSecond) + SurfaceWindow::kAhead + 1;
  return static_cast<double>(f.bytes) * 8e-3 * kFramesPerSecond / (frames * static_cast<double>(plan.scenes.size()));
}

Outcome<void> write(const std::vector<Figures>& all, const Plan& plan, const std::string& path) {
  CsvTable table({"codec", "bits", "steps", "crf", "default", "kbit_s", "force_rms_n", "force_rms_percent",
                  "direction_rms_deg", "height_rms_mm", "height_max_mm", "lost_ticks", "god_object_rms_percent",
                  "god_object_smoothed_rms_percent"});
  for (const Figures& f : all) {
    const ForceError force = f.force.result();
    table.row({name(f.coding.codec), f.coding.bits, name(f.coding.steps), f.coding.crf, f.coding.isDefault() ? 1 : 0,
               kbitPerSecond(f, plan), force.rms_n, force.rms_percent, force.direction_rms_deg, f.heights.rms(),
               f.heights.largest(), force.lost_ticks, f.raw.result().rms_percent, f.smoothed.result().rms_percent});
  }
  return table.write(path);
}

Outcome<void> writeTicks(const std::vector<TimedSteps>& all, const std::string& path) {
  CsvTable table({"steps", "crf", "whole_own_us", "whole_own_p999_us"});
  for (const TimedSteps& timed : all) {
    table.row({name(timed.steps), kTimedCrf, timed.ticks.own_whole.median, timed.ticks.own_whole.p999});
  }
  return table.write(path);
}

std::string tellTicks(const std::vector<TimedSteps>& all) {
  const double even = all.front().ticks.own_whole.median;
  std::string text = print(" A tick takes %.2g us on brightness, at crf %d", even, kTimedCrf);
  for (const TimedSteps& timed : all) {
    if (timed.steps == DepthSteps::Even) continue;
    text += print(", %.2f times that on %s", timed.ticks.own_whole.median / even, name(timed.steps));
  }
  return text + ".";
}

// The force error of plain 8-bit H.264 at a bit rate, between its measured qualities; at their ends, that of the end.
double evenPercentAt(double kbit_s, const std::vector<Figures>& all, const Plan& plan) {
  const Figures *below = nullptr, *above = nullptr;
  for (const Figures& f : all) {
    const Coding& c = f.coding;
    if (c.codec != VideoCodec::H264 || c.bits != 8 || c.steps != DepthSteps::Even || c.crf == 0) continue;
    const double rate = kbitPerSecond(f, plan);
    if (rate <= kbit_s && (below == nullptr || rate > kbitPerSecond(*below, plan))) below = &f;
    if (rate >= kbit_s && (above == nullptr || rate < kbitPerSecond(*above, plan))) above = &f;
  }
  if (below == nullptr || above == nullptr) return (below == nullptr ? above : below)->force.result().rms_percent;
  const double from = kbitPerSecond(*below, plan), to = kbitPerSecond(*above, plan);
  const double share = to > from ? std::log(kbit_s / from) / std::log(to / from) : 0;
  const double a = below->force.result().rms_percent, b = above->force.result().rms_percent;
  return a * std::pow(b / a, share);
}

std::string tellColored(const std::vector<Figures>& all, const Plan& plan) {
  std::string text;
  for (const Figures& f : all) {
    if (f.coding.steps < DepthSteps::Hue) continue;
    const double rate = kbitPerSecond(f, plan);
    text += print("%s%s at crf %d %.2g %% at %.0f kbit/s (brightness %.2g %%)",
                  text.empty() ? " In colours, 4:2:0 tuned for the eye: " : "; ", name(f.coding.steps), f.coding.crf,
                  f.force.result().rms_percent, rate, evenPercentAt(rate, all, plan));
  }
  return text.empty() ? text : text + "; brightness is tuned for touch.";
}

ChartWords wordsOf(const std::vector<Figures>& all, const std::vector<TimedSteps>& timed, const Plan& plan) {
  const auto find = [&](auto&& wanted) {
    return *std::find_if(all.begin(), all.end(), [&](const Figures& f) { return wanted(f.coding); });
  };
  const auto tell = [&](const Figures& f) {
    return print("%.2g %% of the force at %.0f kbit/s", f.force.result().rms_percent, kbitPerSecond(f, plan));
  };
  const Figures own = find([](const Coding& c) { return c.isDefault(); });
  const auto atDefault = [&](VideoCodec codec, int bits, DepthSteps steps) {
    return find([&](const Coding& c) { return c.codec == codec && c.bits == bits && c.steps == steps && c.crf == 8; });
  };
  const Figures exact = find([](const Coding& c) { return c.codec == VideoCodec::Ffv1 && c.bits == 16; });
  return {
      "Bit rate: what the depth's coding costs, and what it does to the force",
      print("The author's default, H.264 of 8 bits at crf 8: off by %s (%.3f N; heights %.3f mm rms, %.2f at most). At "
            "the same crf, 10 bits: %s; HEVC of 10 bits: %s; 8 bits dithered: %s; 8 bits by disparity: %s. Lossless "
            "16 bits (FFV1): %s; that error is the method's own. The default with other methods: god-object %.2g "
            "%%, "
            "god-object-smoothed %.2g %%; lossless 16 bits %.2g and %.2g %%.",
            tell(own).c_str(), own.force.result().rms_n, own.heights.rms(), own.heights.largest(),
            tell(atDefault(VideoCodec::H264, 10, DepthSteps::Even)).c_str(),
            tell(atDefault(VideoCodec::Hevc, 10, DepthSteps::Even)).c_str(),
            tell(atDefault(VideoCodec::H264, 8, DepthSteps::Dithered)).c_str(),
            tell(atDefault(VideoCodec::H264, 8, DepthSteps::Disparity)).c_str(), tell(exact).c_str(),
            own.raw.result().rms_percent, own.smoothed.result().rms_percent, exact.raw.result().rms_percent,
            exact.smoothed.result().rms_percent) +
          tellColored(all, plan) + tellTicks(timed)};
}

}  // namespace

Outcome<std::vector<ChartWords>> measureBitrate(const MeasureOptions& options) {
  const Plan plan = Plan::of(options.quick);
  std::vector<Figures> all;
  std::vector<TimedSteps> timed;
  for (const Coding& coding : plan.codings()) all.push_back({.coding = coding});
  for (const std::string_view name : plan.scenes) {
    options.tell(print("%s, %zu codings", std::string(name).c_str(), all.size()));
    const Scene scene = makeScene(name, plan.duration_s);
    std::vector<Result<void>> added(all.size());
    inParallel(all.size(), [&](std::size_t i) { added[i] = addScene(scene, all[i]); });
    const auto failed = std::find_if(added.begin(), added.end(), [](const auto& a) { return !a.has_value(); });
    if (failed != added.end()) return failOn(std::string(name), failed->error());
    if (name != kTimedScene) continue;
    auto ticks = timeSteps(scene);
    if (!ticks) return failOn(std::string(name), ticks.error());
    timed = std::move(*ticks);
  }
  std::vector<ColorErrorsRow> rows;
  for (const Figures& f : all)
    if (f.coding.steps >= DepthSteps::Hue) rows.push_back({name(f.coding.steps), f.coding.crf, &f.colors});
  if (auto done = write(all, plan, options.out + "/bitrate.csv"); !done) return std::unexpected(done.error());
  if (auto done = writeColorErrors(rows, options.out); !done) return std::unexpected(done.error());
  if (auto done = writeTicks(timed, options.out + "/bitrate-ticks.csv"); !done) return std::unexpected(done.error());
  return std::vector{wordsOf(all, timed, plan)};
}

}  // namespace relievo
