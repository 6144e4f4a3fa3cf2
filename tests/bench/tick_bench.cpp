// SPDX-License-Identifier: Apache-2.0
// The time of one haptic tick, from position to force, and of its upkeep: a finger 5 mm deep in moving 8-bit depth, by
// picture size, speed, material and method.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "platform/histogram.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/material_frames.h"

namespace relievo {
namespace {

constexpr double kTickS = 0.001;
constexpr double kFramePeriodS = 1.0 / 30;
constexpr std::size_t kTicks = 20000;

// A nodding head of 30 mm with a nose and two eyes: 3 mm at 0.7 Hz.
double relief(double x, double y, double t) {
  const auto bump = [&](double cx, double cy, double size, double sigma) {
    const double r2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
    return size * std::exp(-r2 / (2 * sigma * sigma));
  };
  const double nod = 3.0 * std::sin(2 * std::numbers::pi * 0.7 * t);
  return 5 + bump(0, nod, 20, 25) + bump(0, nod - 4, 6, 5) + bump(-10, nod + 8, -3, 5) + bump(10, nod + 8, -3, 5);
}

// The finger's path at a constant speed along a Lissajous figure 5 mm below the surface; computed before the timing
// starts.
std::vector<glm::dvec3> fingerPath(double speed_mm_per_s) {
  std::vector<glm::dvec3> path;
  double phase = 0;
  for (std::size_t i = 0; i < kTicks; ++i) {
    const double x = 50 * std::sin(phase), y = 33 * std::sin(0.73 * phase + 0.5);
    const double dx = 50 * std::cos(phase), dy = 33 * 0.73 * std::cos(0.73 * phase + 0.5);
    path.emplace_back(x, y, relief(x, y, kTickS * static_cast<double>(i)) - 5);
    phase += speed_mm_per_s * kTickS / std::hypot(dx, dy);
  }
  return path;
}

// The depth of a gray picture as hues, 4:2:0 of full range.
Frame asHue(const Frame& gray) {
  const auto samples = std::make_shared<std::vector<std::uint8_t>>();
  const auto part = [&](int c, int r, int n) {
    const double s = 0.03 + 0.94 * gray.planes[0].data[r * gray.planes[0].stride_bytes + c] / 255.0;
    return std::clamp(std::abs(std::fmod(6 * s + n, 6) - 3) - 1, 0.0, 1.0);
  };
  const auto put = [&](int c, int r, int component) {
    const double red = part(c, r, 0), green = part(c, r, 4), blue = part(c, r, 2);
    const double y = 0.299 * red + 0.587 * green + 0.114 * blue;
    const double share[] = {y, (blue - y) / 1.772 + 0.5, (red - y) / 1.402 + 0.5};
    samples->push_back(static_cast<std::uint8_t>(std::lround(255 * share[component])));
  };
  Frame hue = gray;
  hue.model = ColorModel::Yuv;
  hue.matrix = ColorMatrix::Bt601;
  hue.chroma_shift_x = hue.chroma_shift_y = 1;
  std::size_t begins[3] = {};
  for (std::uint8_t k = 0; k < 3; ++k) {
    const int step = k == 0 ? 1 : 2;
    begins[k] = samples->size();
    for (int r = 0; r < gray.height; r += step) {
      for (int c = 0; c < gray.width; c += step) put(c, r, k);
    }
    hue.components[k] = {.plane = k};
  }
  for (std::size_t k = 0; k < 3; ++k) {
    hue.planes[k] = {samples->data() + begins[k], k == 0 ? gray.width : (gray.width + 1) / 2};
  }
  hue.owner = samples;
  return hue;
}

// A film of these pictures, back and forth: the window of each moment, a frame period apart.
std::vector<SurfaceWindow> filmOf(const std::vector<TimedSurface>& pictures) {
  const auto last = pictures.size() - 1;
  const auto surfaceAt = [&](std::size_t k) {
    TimedSurface surface = pictures[k / last % 2 == 0 ? k % last : last - k % last];
    surface.time = mediaTime(kFramePeriodS * static_cast<double>(k));
    return surface;
  };
  std::vector<SurfaceWindow> film(static_cast<std::size_t>(kTickS * kTicks / kFramePeriodS) + 1);
  for (std::size_t now = 0; now < film.size(); ++now) {
    const std::size_t first = now - std::min<std::size_t>(now, SurfaceWindow::kBefore);
    for (std::size_t k = first; k <= now + SurfaceWindow::kAhead; ++k) {
      film[now].frames[static_cast<std::size_t>(film[now].count++)] = surfaceAt(k);
    }
  }
  return film;
}

void touchTick(benchmark::State& state, const char* name, MethodConfig config, DepthCode code = DepthCode::Luma) {
  const int cols = static_cast<int>(state.range(0)), rows = static_cast<int>(state.range(1));
  const double speed = static_cast<double>(state.range(2));
  const auto volume = DisplayVolume::forPicture(cols, rows);
  std::vector<TimedSurface> pictures;
  for (int k = 0; k < 5; ++k) {
    const GridMapping grid(volume, cols, rows);
    const Frame gray = test::makeGrayFrame(cols, rows, 8, {}, [&](int c, int r) {
      return relief(grid.x(c), grid.y(r), kFramePeriodS * k) / volume.depth_mm * 255 + 0.5;
    });
    pictures.push_back(test::surfaceOf(code == DepthCode::Hue ? asHue(gray) : gray, volume, {.code = code}));
    if (!config.places.exists()) continue;
    // Patches of 10 mm.
    pictures.back().material = test::materialOf(cols, rows, volume, [](double x, double y) {
      const bool odd = static_cast<int>(std::floor(x / 10) + std::floor(y / 10)) % 2 != 0;
      return odd ? test::MaterialCodes{128, 100, 128} : test::MaterialCodes{100, 128, 60};
    });
  }
  std::vector<SurfaceWindow> film = filmOf(pictures);
  const std::vector<glm::dvec3> path = fingerPath(speed);
  config.jump_threshold = false;
  const auto method = makeMethod(name, config);
  const MonotonicClock clock;
  Histogram times, upkeep_times;
  std::size_t i = 0;
  for (auto _ : state) {
    const std::size_t k = i++ % kTicks;
    const double t = kTickS * static_cast<double>(k);
    if (k == 0) {  // the film begins anew, and the finger enters from outside
      for (SurfaceWindow& w : film) ++w.epoch;
      static_cast<void>(method->update(path[0] + glm::dvec3(0, 0, 30), film[0], {}));
    }
    const SurfaceWindow& window = film[static_cast<std::size_t>(t / kFramePeriodS)];
    const MonotonicTime begin = clock.now();
    Touch touch = method->update(path[k], window, mediaTime(t));
    const MonotonicTime done = clock.now();
    method->upkeep(window, mediaTime(t));
    upkeep_times.add(clock.now() - done);
    times.add(done - begin);
    benchmark::DoNotOptimize(touch);
  }
  const auto us = [](const Histogram& h, double q) { return static_cast<double>(h.quantile(q).count()) * 1e-3; };
  state.counters["median_us"] = us(times, 0.5);
  state.counters["p99_us"] = us(times, 0.99);
  state.counters["p99.9_us"] = us(times, 0.999);
  state.counters["upkeep_median_us"] = us(upkeep_times, 0.5);
  state.counters["upkeep_p99.9_us"] = us(upkeep_times, 0.999);
}

void sizesAndSpeeds(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"cols", "rows", "mm_per_s"})->Iterations(100000);
  for (const auto& [cols, rows] : {std::pair(720, 486), std::pair(1920, 1080), std::pair(3840, 2160)}) {
    for (const int speed : {100, 1000, 5000}) bench->Args({cols, rows, speed});
  }
}

BENCHMARK_CAPTURE(touchTick, relievo, "relievo", MethodConfig{})->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, relievo_on_hue, "relievo", MethodConfig{}, DepthCode::Hue)->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, relievo_with_friction, "relievo", MethodConfig{.friction = {0.3, 0.2}})
    ->Apply(sizesAndSpeeds);

// The same on a material of the whole film, and on a map of it.
const MethodConfig kOneMaterial{.stiffness_n_per_mm = 0.5, .friction = {0.3, 0.2}, .texture = {0.05, 1}};
MethodConfig ofPlaces(const Material& full) {
  MethodConfig config;
  config.places = scaleHeldBy(full, {}, 1, 8);
  return config;
}
const Material kFullStiffness{.stiffness_n_per_mm = 1, .friction = {}, .texture = {}};
const Material kFullMaterial{.stiffness_n_per_mm = 1, .friction = Friction{0.6, 0.4}, .texture = Texture{0.1, 1}};
BENCHMARK_CAPTURE(touchTick, relievo_on_one_material, "relievo", kOneMaterial)->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, relievo_on_places_of_stiffness, "relievo", ofPlaces(kFullStiffness))
    ->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, relievo_on_places, "relievo", ofPlaces(kFullMaterial))->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, god_object, "relievo", MethodConfig{.space = SpaceLaw::Triangles})->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, modified_proxy_graph, "modified-proxy-graph", MethodConfig{})->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, proxy_graph, "proxy-graph", MethodConfig{})->Apply(sizesAndSpeeds);
BENCHMARK_CAPTURE(touchTick, penalty, "penalty", MethodConfig{})->Apply(sizesAndSpeeds);

}  // namespace
}  // namespace relievo
