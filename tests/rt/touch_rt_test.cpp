// SPDX-License-Identifier: Apache-2.0
// A tick of the haptic task allocates nothing, takes no lock and makes no system call, with every method and under
// motion, cuts, holes, gaps and a darting finger.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/depth_window/shots.h"
#include "app/haptics/baseline/methods.h"
#include "app/haptics/task/haptic_task.h"
#include "platform/allocation_counter.h"
#include "tests/rt/forbidden_calls.h"
#include "tests/support/device/fake_haptic_device.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/film/material_frames.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

constexpr DisplayVolume kVolume{160, 108, 40};
constexpr double kPeriodS = 1.0 / 30, kTickS = 0.001;
constexpr int kFrames = 40, kCut = 20;

// A moving wave with a hole in it, and another scene after the cut.
std::vector<TimedSurface> movingFilm() {
  const GridMapping grid(kVolume, 180, 122);
  std::vector<TimedSurface> film;
  for (int k = 0; k < kFrames; ++k) {
    const Frame frame = test::makeGrayFrame(180, 122, 8, mediaTime(k * kPeriodS), [&](int c, int r) {
      if (std::abs(c - 90) < 4 && std::abs(r - 61 - k) < 4) return 0.0;
      const double z = k < kCut ? 15 + 5 * std::sin(0.1 * grid.x(c) + 0.3 * k) : 28 + 0.1 * grid.y(r);
      return z / 40 * 255;
    });
    film.push_back({HeightField::make(frame, {.invalid = 0}, kVolume).value(), frame.pts, frame.owner});
  }
  for (std::size_t k = 0; k < film.size(); ++k) {  // stripes that move; some pictures have none
    if (k % 11 == 10) continue;
    film[k].material = test::materialOf(90, 60, kVolume, [k](double x, double) {
      return static_cast<int>(std::floor(0.2 * x + static_cast<double>(k))) % 2 != 0 ? test::MaterialCodes{200, 0, 250}
                                                                                     : test::MaterialCodes{60, 200, 0};
    });
  }
  ShotFinder().mark(film);
  return film;
}

struct Taken {
  std::uint64_t allocations = 0, locks = 0, contact_ticks = 0;
};

// The complete task in simulated time, with a simulated device and a synthetic film.
class Stage {
 public:
  explicit Stage(const std::string& method) : method_(made(method)) {
    static_cast<void>(device_.open() && device_.home() && device_.start());
    task_ = std::make_unique<HapticTask>(device_, *method_, clock_, kVolume, SafetyLimits{}, 0.5);
  }

  Taken play() {
    Taken taken;
    for (int tick = 0; tick < 1300; ++tick) {
      show(tick);
      // Repeatedly comes in from outside; strokes, then darts at 5 m/s. The volume's centre is the device's.
      const double press = 20 * std::max(0.0, std::sin(0.02 * tick));
      device_.position = {60 * std::sin((tick > 700 ? 0.08 : 0.003) * tick), 20 * std::cos(0.01 * tick), 14 - press};
      if (tick % 500 == 250) device_.position.x = std::numeric_limits<double>::quiet_NaN();
      if (tick % 500 == 400) device_.next_error = ErrorCode::Io;
      const std::uint64_t allocations = threadAllocations(), locks = test::threadLocks();
      static_cast<void>(task_->loop({static_cast<std::uint64_t>(tick), clock_.now(), clock_.now()}));
      taken.allocations += threadAllocations() - allocations;
      taken.locks += test::threadLocks() - locks;
      clock_.advance(fromSeconds(kTickS));
    }
    taken.contact_ticks = task_->counters().contact_ticks;
    return taken;
  }

 private:
  // "rough": relievo on a surface with friction and texture; "places": on one whose material is that of each place.
  static std::unique_ptr<TouchMethod> made(const std::string& method) {
    if (method == "places") {
      const Material full{.stiffness_n_per_mm = 1, .friction = Friction{0.4, 0.3}, .texture = Texture{0.1, 0.8}};
      return makeMethod("relievo", {.places = scaleHeldBy(full, {}, 1, 8)});
    }
    if (method != "rough") return makeMethod(method, {});
    return makeMethod("relievo", {.friction = {0.3, 0.2}, .texture = {0.1, 0.8}});
  }
  void show(int tick) {
    const int now = static_cast<int>(tick * kTickS / kPeriodS + 1e-9), first = std::max(now - 2, 0);
    SurfaceWindow& window = task_->windowToFill();
    window.count = tick % 400 == 399 ? 0 : std::min(now + 4, kFrames) - first;
    for (int i = 0; i < window.count; ++i)
      window.frames[static_cast<std::size_t>(i)] = film_[static_cast<std::size_t>(first + i)];
    window.epoch = tick > 1000 ? 1 : 0;
    window.clock = {.media = mediaTime(tick * kTickS), .monotonic = clock_.now(), .rate = 1};
    task_->publishWindow();
  }

  const std::vector<TimedSurface> film_ = movingFilm();
  ManualClock clock_{MonotonicTime{} + std::chrono::seconds(5)};
  test::FakeHapticDevice device_;
  std::unique_ptr<TouchMethod> method_;
  std::unique_ptr<HapticTask> task_;
};

class TouchRt : public testing::TestWithParam<std::string> {};

TEST_P(TouchRt, ATickAllocatesNothingAndTakesNoLock) {
  const Taken taken = Stage(GetParam()).play();
  EXPECT_EQ(taken.allocations, 0U);
  EXPECT_EQ(taken.locks, 0U);
  EXPECT_GT(taken.contact_ticks, 50U) << "the film and the finger must meet";
}

TEST_P(TouchRt, ATickDoesNotCallTheSystem) {
  if (kMemorySanitizer || kRealtimeSanitizer) GTEST_SKIP() << "a sanitizer makes calls of its own";
  constexpr int kNoFilter = 77;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    Stage stage(GetParam());
    if (!test::forbidSystemCalls()) ::_exit(kNoFilter);
    ::_exit(stage.play().contact_ticks > 50 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNoFilter) GTEST_SKIP() << "this kernel has no seccomp";
  EXPECT_FALSE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS) << "a tick has called the system: see strace -f";
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

INSTANTIATE_TEST_SUITE_P(Methods, TouchRt,
                         testing::Values("relievo", "rough", "places", "modified-proxy-graph", "proxy-graph",
                                         "proxy-blend", "penalty"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ForbiddenCalls, ALockThatNobodyHoldsIsCounted) {
  if (kThreadSanitizer || kRealtimeSanitizer) GTEST_SKIP() << "the sanitizer needs the locks to itself";
  std::mutex free_lock;
  const std::uint64_t before = test::threadLocks();
  {
    const std::lock_guard guard(free_lock);
  }
  EXPECT_EQ(test::threadLocks() - before, 1U);
}

TEST(ForbiddenCalls, ASystemCallEndsTheProcess) {
  if (kMemorySanitizer || kRealtimeSanitizer) GTEST_SKIP() << "a sanitizer makes calls of its own";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (!test::forbidSystemCalls()) ::_exit(77);
    ::_exit(::getppid() == 0 ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "this kernel has no seccomp";
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS) << status;
}

}  // namespace
}  // namespace relievo
