// SPDX-License-Identifier: Apache-2.0
// Runs of a method through a rendered film: what the method sees, and errors that are known on paper.
#include "app/lab/film/film_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/haptics/baseline/methods.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/finger/resting_hand.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/tick_timing.h"

namespace relievo {
namespace {

// Remembers what it was shown.
class Witness final : public TouchMethod {
 public:
  struct View {
    MediaTime now, first, last;
    int count = 0;
    bool ended = false;
  };
  Touch update(const glm::dvec3& hip, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override {
    views.push_back({now, window.frames[0].time, window.frames[window.count - 1].time, window.count, window.ended});
    return {.proxy_mm = hip};
  }
  void upkeep(const SurfaceWindow& /*window*/, MediaTime /*now*/) RELIEVO_RT override { ++upkeeps; }
  void reset() RELIEVO_RT override { ++resets; }

  std::vector<View> views;
  int upkeeps = 0, resets = 0;
};

std::vector<HipTick> ticksFrom(double from_s, double until_s) {
  std::vector<HipTick> ticks;
  for (double t = from_s; t < until_s; t += 0.001) ticks.push_back({t, {0, 0, 39}});
  return ticks;
}

TEST(FilmRun, ShowsTheFramesFromTwoBeforeThePresentToFourAfterIt) {
  const auto surface = makeTrueSurface("plane");
  const auto film = MemoryFilm::make(*surface, {.cols = 72, .rows = 48, .frames_per_s = 25}, 1.0, 2.0).value();
  Witness witness;
  FilmRun run(film, witness);
  for (const HipTick& tick : ticksFrom(1.0005, 2.0)) static_cast<void>(run.tick(tick));
  EXPECT_EQ(witness.resets, 1);
  EXPECT_EQ(witness.upkeeps, static_cast<int>(witness.views.size()));
  for (const auto& view : witness.views) {
    ASSERT_EQ(view.count, 7);
    const double age = toSeconds(view.now - view.first), ahead = toSeconds(view.last - view.now);
    ASSERT_TRUE(age >= 2 * 0.04 && age < 3 * 0.04) << age;
    ASSERT_TRUE(ahead > 3 * 0.04 && ahead <= 4 * 0.04) << ahead;
  }
}

TEST(FilmRun, BeginsWithTheFirstFrameAndEndsWithTheLast) {
  const auto surface = makeTrueSurface("plane");
  const auto film = MemoryFilm::make(*surface, {.cols = 72, .rows = 48, .frames_per_s = 25}, 0, 0.4).value();
  Witness witness;
  FilmRun run(film, witness);
  for (const HipTick& tick : ticksFrom(0, 0.6)) static_cast<void>(run.tick(tick));
  EXPECT_EQ(witness.views.front().count, 5);
  EXPECT_FALSE(witness.views.front().ended);
  EXPECT_EQ(film.frames().size(), 15u);
  EXPECT_TRUE(witness.views.back().ended);
  EXPECT_EQ(witness.views.back().last, film.frames().back().time);
}

class OnAPlane : public testing::Test {
 protected:
  ForceError errorOf(std::string_view scene, const char* name, const MethodConfig& config) {
    const auto surface = makeTrueSurface(scene);
    const auto path = makeFingerPath(*surface, {.duration_s = 2});
    const auto truth = truthAlong(*surface, path);
    const auto film = MemoryFilm::make(*surface, {.depth = kDepthKinds[0]}, 0, 2).value();
    ticks_ = playPath(film, *makeMethod(name, config), path, truth);
    return forceErrors(ticks_, kSettledS).result();
  }
  std::vector<PlayedTick> ticks_;
};

// The proxy graph knows edges and vertices alone. The foot of the perpendicular lies anywhere in a triangle with legs
// of a pitch p = 160/720 mm, and the nearest edge is off by up to its inradius r = p (2 - sqrt 2)/2; the area further
// than d from all edges is (1 - d/r)^2 of it, so that the mean square is r^2/6.
TEST_F(OnAPlane, TheProxyGraphIsOffByTheDistanceToTheNearestEdge) {
  const ForceError e = errorOf("plane", "modified-proxy-graph", {.jump_threshold = false});
  const double inradius = 160.0 / 720 * (2 - std::numbers::sqrt2) / 2;
  EXPECT_NEAR(e.rms_n, 0.5 * inradius / std::sqrt(6.0), 0.05 * e.rms_n);
  EXPECT_EQ(e.lost_ticks, 0u);
  EXPECT_EQ(e.ticks, 1700u);
}

// Holding a frame is to touch where the plane was when the frame was taken.
TEST_F(OnAPlane, HoldingAFrameIsOffByWhatThePlaneHasMovedSince) {
  const ForceError e = errorOf("plane-heaving", "penalty", {.time = TimeLaw::Hold});
  const auto heave = [](double t) { return 2 * std::sin(2 * std::numbers::pi * 0.67 * t); };
  // 16 bits turn the normal by up to 0.0006 mm / 0.22 mm, and with it the depth along it by a thousandth.
  const double normal_z = 1 / std::sqrt(1 + 0.15 * 0.15 + 0.08 * 0.08);
  double squares = 0;
  int counted = 0;
  for (const PlayedTick& tick : ticks_) {
    if (tick.t_s < kSettledS) continue;
    const double frame = std::floor(tick.t_s * 30 + 1e-6) / 30;
    const double off = 0.5 * normal_z * (heave(frame) - heave(tick.t_s));
    const double felt = glm::length(tick.touch.force_n) - 2.5;
    ASSERT_NEAR(felt, off, 0.002) << tick.t_s;
    squares += off * off;
    ++counted;
  }
  EXPECT_NEAR(e.rms_n, std::sqrt(squares / counted), 0.002);
}

TEST_F(OnAPlane, TimesAreTakenOfEveryTick) {
  static_cast<void>(errorOf("plane", "relievo", {}));
  Duration sum{0};
  for (const PlayedTick& tick : ticks_) sum += tick.update;  // one alone may be shorter than a step of the clock
  EXPECT_GT(sum.count(), 0);
}

TEST(TickTiming, CountsTheTicksOfAllRoundsButThoseOfTheWayIn) {
  const auto surface = makeTrueSurface("plane");
  const auto path = makeFingerPath(*surface, {.duration_s = 0.5});
  const FilmViews film(MemoryFilm::make(*surface, {}, 0, 0.5).value());
  const std::vector<const Contender*> two{contender("relievo"), contender("penalty")};
  const auto times = timeTicks(two, {film, path, 300}, 3);
  ASSERT_EQ(times.size(), 2u);
  for (const TickTimes& t : times) {
    EXPECT_EQ(t.update.count, 600u);
    EXPECT_EQ(t.upkeep.count, 600u);
    EXPECT_LE(t.update.median, t.update.p99);
    EXPECT_LE(t.update.p99, t.update.p999);
    EXPECT_EQ(t.own_update.count, 200u) << "once for three rounds";
    EXPECT_EQ(t.own_upkeep.count, 200u);
  }
  EXPECT_EQ(timeColdTicks(two, {film, path, 300}, 3)[1].update.count, 3u);
}

TEST(Contenders, AreAllMade) {
  const auto film = MemoryFilm::make(*makeTrueSurface("face-nodding"), {}, 0, 0.1).value();
  for (const Contender& c : contenders()) EXPECT_NE(c.make(film), nullptr) << c.label;
  EXPECT_EQ(contender("no such method"), nullptr);
}

TEST(Contenders, AreMadeOfThePartsThatTheyAreNamedFor) {
  const auto film = MemoryFilm::make(*makeTrueSurface("face-nodding"), {}, 0, 0.1).value();
  EXPECT_STREQ(contender("relievo hold")->parts(film).time, "hold");
  EXPECT_EQ(contender("relievo fitted")->parts(film).look_ahead_frames, 3);
  EXPECT_EQ(contender("relievo 0.43")->parts(film).wide_mm, 0.43);
  EXPECT_STREQ(contender("god-object")->parts(film).space, "triangles");
  EXPECT_EQ(contender("proxy-graph")->parts(film).look_ahead_frames, 0);
}

// Every smooth scene that lasts and moves its surface by less than 100 mm/s.
TEST(AccuracyScenes, AreTheSmoothAndSlowOnes) {
  const auto scenes = accuracyScenes();
  EXPECT_EQ(scenes.size(), 11u);
  for (const std::string_view scene : scenes) {
    const auto traits = makeTrueSurface(scene)->traits();
    EXPECT_TRUE(traits.smooth && 0.5 * traits.max_speed_mm_per_s < 50) << scene;
  }
}

// F = k x at rest, and critical damping does not ring.
TEST(RestingHand, GivesWayByTheForceOverItsStiffnessWithoutRinging) {
  RestingHand hand;
  double furthest = 0;
  for (int i = 0; i < 2000; ++i) {
    hand.move({0, 0, 0}, {0, 0, 0.6}, 0.001);
    furthest = std::max(furthest, hand.position_mm.z);
  }
  EXPECT_NEAR(hand.position_mm.z, 2.0, 1e-6);
  EXPECT_LT(furthest, 2.0 * 1.001);
  // A free mass on this spring would be back after 2 pi sqrt(m/k) = 0.115 s; half way it is at 1.68 / omega = 31 ms.
  RestingHand other;
  for (int i = 0; i < 31; ++i) other.move({0, 0, 2}, {0, 0, 0}, 0.001);
  EXPECT_NEAR(other.position_mm.z, 1.0, 0.03);
}

}  // namespace
}  // namespace relievo
