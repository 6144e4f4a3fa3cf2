// SPDX-License-Identifier: Apache-2.0
// Drawing 3D at 1280 x 720, side by side: making the relief's triangles from a depth picture, and drawing frames of
// them. Uses the sample film (made by toolchain/demo) and the real depth video beside the project; missing files are
// skipped with a message. `relievo-lab detail` draws the uniform grid of all samples for comparison.
//   picture_bench FILM..   instead draws these films in turns, picture by picture, and compares each with the first:
//                          what does a larger film cost on the same screen?
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/render/gl/scene_renderer.h"
#include "app/render/relief/relief_triangles.h"
#include "app/render/relief/stereo.h"
#include "drivers/egl/egl.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "platform/clock.h"
#include "tests/support/film/real_depth.h"

namespace relievo {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr int kPictures = 40;

struct Film {
  std::string name;
  std::vector<FramePair> pairs;
  DepthCalibration calibration;
  DisplayVolume volume;
};

// Every `stride`th pair.
Film read(std::string name, const SourceOptions& source, int stride, int pictures = kPictures) {
  Film film{.name = std::move(name)};
  PairReader reader(
      {[](const std::string&) { return makeFfmpegSource(); }, [](const StreamInfo&) { return makeFfmpegDecoder(); }});
  if (!reader.open(source)) {
    std::fprintf(stderr, "picture_bench: %s not found; skipped\n", source.url.c_str());
    return film;
  }
  film.calibration = reader.info().calibration.calibration;
  for (int i = 0; static_cast<int>(film.pairs.size()) < pictures; ++i) {
    auto pair = reader.next();
    if (!pair || !*pair) break;
    if (i % stride == 0 && !(*pair)->depth.empty()) film.pairs.push_back(std::move(**pair));
  }
  if (!film.pairs.empty()) {
    const Frame& depth = film.pairs[0].depth;
    film.volume = DisplayVolume::forPicture(depth.width, depth.height);
  }
  return film;
}

Film cones(const std::string& data) {
  auto disparity = test::readCones(data);
  Film film{.name = "cones"};
  if (!disparity) return film;
  PairReader reader(
      {[](const std::string&) { return makeFfmpegSource(); }, [](const StreamInfo&) { return makeFfmpegDecoder(); }});
  if (!reader.open({.url = data + "/cones/left_rgb_8bit.png"})) return film;
  auto pair = reader.next();
  if (!pair || !*pair) return film;
  film.pairs = {{.color = (*pair)->color, .depth = test::depthOf(*disparity)}};
  std::ranges::reverse(disparity->pixels);  // upside down, so that no row repeats
  film.pairs.push_back({.color = (*pair)->color, .depth = test::depthOf(*disparity)});
  film.calibration = {.bits = 16, .invalid = 0};
  film.volume = DisplayVolume::forPicture(test::Disparity::kCols, test::Disparity::kRows);
  return film;
}

ReliefDetail wanted(const DisplayVolume& volume) {
  const StereoSettings stereo{.layout = StereoLayout::SideBySide};
  const EyeViews eyes = eyeViews(stereo, volume, kWidth, kHeight);
  return {.most_across = ReliefDetail::cellsFor(eyes.pixels_per_mm * volume.width_mm),
          .error_mm = SceneRenderer::kErrorPx * heightOfPixelMm(stereo, volume, eyes.pixels_per_mm),
          .view = {.eye_mm = std::abs(eyes.views[0].eye_x_mm),
                   .distance_mm = stereo.viewing_distance_mm,
                   .screen_z_mm = stereo.screen_z_mm}};
}

struct Meshes {
  std::vector<Duration> best;  // by picture
  std::size_t most = 0, sum = 0, cuts = 0;
};

// Plays the film several times and takes the best time of each picture, as on an idle machine. Pictures follow their
// predecessors in the film, so that reuse between pictures is realistic, or less if some are skipped.
Meshes makeMeshes(const Film& film) {
  constexpr int kTimes = 8;
  const MonotonicClock clock;
  const ReliefDetail detail = wanted(film.volume);
  ReliefTriangles triangles;
  Meshes meshes;
  meshes.best.assign(film.pairs.size(), std::chrono::hours(1));
  for (int time = 0; time < kTimes; ++time) {
    meshes.most = meshes.sum = meshes.cuts = 0;
    for (std::size_t i = 0; i < film.pairs.size(); ++i) {
      const HeightField field = HeightField::make(film.pairs[i].depth, film.calibration, film.volume).value();
      const MonotonicTime begin = clock.now();
      triangles.build(field, film.volume, detail);
      meshes.best[i] = std::min(meshes.best[i], clock.now() - begin);
      const std::size_t count = triangles.indices().size() / 3;
      meshes.most = std::max(meshes.most, count);
      meshes.sum += count;
      meshes.cuts += triangles.cutCells();
    }
  }
  return meshes;
}

double meanMs(const Meshes& meshes) {
  return toSeconds(std::accumulate(meshes.best.begin(), meshes.best.end(), Duration(0))) * 1e3 /
         static_cast<double>(meshes.best.size());
}

void makeTriangles(benchmark::State& state, const Film& film) {
  Meshes meshes;
  for (auto _ : state) meshes = makeMeshes(film);
  const auto pictures = static_cast<double>(film.pairs.size());
  const Frame& depth = film.pairs[0].depth;
  state.counters["mean_ms"] = meanMs(meshes);
  state.counters["worst_ms"] = toSeconds(std::ranges::max(meshes.best)) * 1e3;
  state.counters["triangles"] = static_cast<double>(meshes.sum) / pictures;
  state.counters["most"] = static_cast<double>(meshes.most);
  state.counters["cut_cells"] = static_cast<double>(meshes.cuts) / pictures;
  state.counters["all_samples"] = 2.0 * (depth.width - 1) * (depth.height - 1);
}

void drawFrames(benchmark::State& state, const Film& film) {
  const MonotonicClock clock;
  const auto display = makeOffscreenDisplay({}, clock);
  if (!display->open({kWidth, kHeight})) return state.SkipWithError("no EGL with GLES 3");
  const auto surface = display->beginFrame();
  {
    auto renderer = SceneRenderer::create(std::chrono::hours(1)).value();
    renderer->setStereo({.layout = StereoLayout::SideBySide});
    std::size_t i = 0;
    for (auto _ : state) {
      const FramePair& pair = film.pairs[i++ % film.pairs.size()];
      if (!renderer->setFrame(pair.color, pair.depth, film.calibration, film.volume) ||
          !renderer->draw(*surface, {FingerMark{.position_mm = {0, 0, 30}, .force_n = {0, 0, 2}, .contact = true}})) {
        return state.SkipWithError("a frame was not drawn");
      }
    }
    state.counters["triangles"] = static_cast<double>(renderer->statistics().triangles);
  }
  state.counters["frames_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  display->close();
}

struct Drawn {
  std::unique_ptr<SceneRenderer> renderer;
  std::vector<double> frame_ms, cpu_ms;  // by picture
  double triangles = 0;
};

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// Processor time is that of all threads; it is steadier than the frame's on a machine with other work.
void printTurns(const std::vector<Film>& all, const std::vector<Drawn>& drawn) {
  std::printf("%-28s %9s %6s %9s %6s %9s %10s %6s\n", "film", "frame ms", "x", "CPU ms", "x", "mesh ms", "triangles",
              "x");
  const Drawn& first = drawn[0];
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Drawn& each = drawn[k];
    const double frame = medianOf(each.frame_ms), cpu = medianOf(each.cpu_ms);
    std::printf("%-28s %9.2f %6.2f %9.2f %6.2f %9.2f %10.0f %6.2f\n", all[k].name.c_str(), frame,
                frame / medianOf(first.frame_ms), cpu, cpu / medianOf(first.cpu_ms), meanMs(makeMeshes(all[k])),
                each.triangles / static_cast<double>(each.frame_ms.size()), each.triangles / first.triangles);
  }
}

// A frame is all that follows decoding: taking the pair, making the triangles, drawing both eyes.
int drawInTurns(const std::vector<Film>& all) {
  constexpr int kTimes = 4;
  const MonotonicClock clock;
  const auto display = makeOffscreenDisplay({}, clock);
  if (!display->open({kWidth, kHeight})) return std::fprintf(stderr, "picture_bench: no EGL with GLES 3\n"), 1;
  const auto surface = display->beginFrame();
  std::vector<Drawn> drawn(all.size());
  for (Drawn& each : drawn) {
    each.renderer = SceneRenderer::create(std::chrono::hours(1)).value();
    each.renderer->setStereo({.layout = StereoLayout::SideBySide});
  }
  const std::size_t pictures =
      std::ranges::min(all, {}, [](const Film& film) { return film.pairs.size(); }).pairs.size();
  for (std::size_t i = 0; i < kTimes * pictures; ++i) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      const FramePair& pair = all[k].pairs[i % pictures];
      SceneRenderer& renderer = *drawn[k].renderer;
      const MonotonicTime begin = clock.now();
      const std::clock_t cpu_begin = std::clock();
      if (!renderer.setFrame(pair.color, pair.depth, all[k].calibration, all[k].volume)) return 1;
      if (!renderer.draw(*surface, {FingerMark{.position_mm = {0, 0, 30}}})) return 1;
      drawn[k].frame_ms.push_back(toSeconds(clock.now() - begin) * 1e3);
      drawn[k].cpu_ms.push_back(static_cast<double>(std::clock() - cpu_begin) * 1e3 / CLOCKS_PER_SEC);
      drawn[k].triangles += static_cast<double>(renderer.statistics().triangles);
    }
  }
  printTurns(all, drawn);
  drawn.clear();
  display->close();
  return 0;
}

// Kept while the benchmarks run.
std::vector<std::unique_ptr<const Film>>& films() {
  static std::vector<std::unique_ptr<const Film>> all;
  return all;
}

void registerAll() {
  const std::string data = RELIEVO_TEST_DATA;
  for (Film film :
       {read("sample", {.url = RELIEVO_SOURCE_DIR "/out/sample.mkv"}, 9),
        read("cup", {.url = data + "/cup/color_output.webm", .depth_url = data + "/cup/depth_output.webm"}, 14),
        read("desk", {.url = data + "/desk/Test.mov", .packing = Packing::TopBottom, .depth_code = DepthCode::Hue}, 1),
        cones(data)}) {
    if (film.pairs.empty()) continue;
    films().push_back(std::make_unique<const Film>(std::move(film)));
    const Film& kept = *films().back();
    benchmark::RegisterBenchmark(("make/" + kept.name).c_str(), makeTriangles, kept)->Iterations(1);
    benchmark::RegisterBenchmark(("draw/" + kept.name).c_str(), drawFrames, kept)
        ->MeasureProcessCPUTime()
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond)
        ->MinTime(3);
  }
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  using namespace relievo;
  benchmark::Initialize(&argc, argv);
  std::vector<Film> asked;
  for (int i = 1; i < argc; ++i) {
    asked.push_back(read(std::filesystem::path(argv[i]).filename(), {.url = argv[i]}, 3, 16));
    if (asked.back().pairs.empty()) return 1;
  }
  if (!asked.empty()) return drawInTurns(asked);
  registerAll();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
