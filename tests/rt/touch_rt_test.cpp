// SPDX-License-Identifier: Apache-2.0
// The tick of every method allocates nothing, whatever comes: motion, cuts, holes, gaps, a finger that darts.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "app/haptics/methods.h"
#include "app/haptics/safety.h"
#include "app/haptics/shots.h"
#include "platform/allocation_counter.h"
#include "tests/support/depth_frames.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriodS = 1.0 / 30, kTickS = 0.001;
constexpr int kFrames = 40, kCut = 20;

// A wave that runs, with a hole in it, and another scene from the cut on.
std::vector<TimedSurface> movingFilm() {
  const GridMapping grid(kVolume, 180, 122);
  std::vector<TimedSurface> film;
  for (int k = 0; k < kFrames; ++k) {
    const Frame frame = test::makeGrayFrame(180, 122, 8, mediaTime(k * kPeriodS), [&](int c, int r) {
      if (std::abs(c - 90) < 4 && std::abs(r - 61 - k) < 4) return 0.0;
      const double z = k < kCut ? 15 + 5 * std::sin(0.1 * grid.x(c) + 0.3 * k) : 28 + 0.1 * grid.y(r);
      return z / 40 * 255;
    });
    film.push_back({HeightField::make(frame, {.invalid_code = 0}, kVolume).value(), frame.pts, frame.owner});
  }
  ShotFinder().mark(film);
  return film;
}

class TouchRt : public testing::TestWithParam<std::string> {};

TEST_P(TouchRt, ATickAllocatesNothing) {
  const auto film = movingFilm();
  const auto method = makeMethod(GetParam(), {});
  SafetyFilter safety({}, 0.5);
  SurfaceWindow window;
  std::uint64_t allocations = 0;
  int contacts = 0;
  for (int tick = 0; tick < 1300; ++tick) {
    const double t = tick * kTickS;
    const int now = static_cast<int>(t / kPeriodS + 1e-9), first = std::max(now - 2, 0);
    window.count = tick % 400 == 399 ? 0 : std::min(now + 4, kFrames) - first;
    for (int i = 0; i < window.count; ++i)
      window.frames[static_cast<std::size_t>(i)] = film[static_cast<std::size_t>(first + i)];
    window.epoch = tick > 1000 ? 1 : 0;
    // Comes in from outside again and again; strokes, then darts at 5 m/s.
    const double press = 20 * std::max(0.0, std::sin(0.02 * tick));
    glm::dvec3 hip(60 * std::sin((tick > 700 ? 0.08 : 0.003) * tick), 20 * std::cos(0.01 * tick), 34 - press);
    if (tick % 500 == 250) hip.x = std::numeric_limits<double>::quiet_NaN();

    const std::uint64_t before = threadAllocations();
    const Touch touch = method->update(hip, window, mediaTime(t));
    const glm::dvec3 force = safety.apply(touch.force_n, hip, kTickS);
    method->upkeep(window, mediaTime(t));
    allocations += threadAllocations() - before;
    contacts += touch.contact ? 1 : 0;
    ASSERT_TRUE(std::isfinite(force.z)) << tick;
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_GT(contacts, 50) << "the film and the finger must meet";
}

INSTANTIATE_TEST_SUITE_P(Methods, TouchRt,
                         testing::Values("relievo", "modified-proxy-graph", "proxy-graph", "proxy-blend", "penalty"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace relievo
