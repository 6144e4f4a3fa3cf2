// SPDX-License-Identifier: Apache-2.0
// The rivals are as good as their authors would make them: what a blur does to planes, noise and holes by theory, and
// forces that are known on paper.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "app/lab/film/made_film.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/accuracy.h"
#include "app/lab/measure/tick_timing.h"
#include "app/lab/rival/bullet_proxy.h"
#include "app/lab/rival/depth_smoother.h"
#include "app/lab/rival/smoothed_film.h"
#include "app/lab/scenario/scenarios.h"

namespace relievo {
namespace {

constexpr double kVolumeDepthMm = 40;

// A picture of codes of 16 bits, 0 a hole, samples of 0.2 by 0.2 mm.
struct Picture {
  int cols, rows;
  std::shared_ptr<const std::vector<std::uint16_t>> codes;  // the field is a view of them

  template <class Height>
  Picture(int width, int height, Height&& mm) : cols(width), rows(height) {
    std::vector<std::uint16_t> row_by_row;
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        const double z = mm(c, r);
        row_by_row.push_back(std::isnan(z) ? std::uint16_t{0}
                                           : static_cast<std::uint16_t>(std::lround(z / kVolumeDepthMm * 65535)));
      }
    }
    codes = std::make_shared<const std::vector<std::uint16_t>>(std::move(row_by_row));
  }
  [[nodiscard]] HeightField field() const {
    return HeightField::make(grayFrame(codes, cols, rows), {.bits = 16, .invalid = 0},
                             {0.2 * cols, 0.2 * rows, kVolumeDepthMm})
        .value();
  }
};

struct Smoothed {
  int cols, rows;
  std::vector<std::uint16_t> codes;
  bool hole;

  Smoothed(const Picture& picture, double sigma_mm, DepthSmoother::Order order = DepthSmoother::Order::First) {
    DepthSmoother smoother(picture.field(), sigma_mm, order);
    cols = smoother.cols();
    rows = smoother.rows();
    codes.resize(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
    hole = smoother.smooth(picture.field(), codes);
  }
  [[nodiscard]] double mm(int c, int r) const {
    const std::uint16_t code = codes[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) + c];
    return code == DepthSmoother::kHole ? std::nan("") : code * kVolumeDepthMm / 65535;
  }
};

constexpr double kRoundedMm = kVolumeDepthMm / 65535;  // a code of 16 bits in, another one out

TEST(DepthSmoother, KeepsAPlaneAwayFromTheBorder) {
  const auto plane = [](int c, int r) { return 10 + 0.03 * c + 0.05 * r; };
  const Smoothed smoothed(Picture(200, 150, plane), 0.5);
  ASSERT_EQ(smoothed.cols, 200);
  for (int r = 10; r < 140; ++r) {
    for (int c = 10; c < 190; ++c) ASSERT_NEAR(smoothed.mm(c, r), plane(c, r), kRoundedMm) << c << " " << r;
  }
  EXPECT_FALSE(smoothed.hole);
}

// A column of one sample's width comes out as the kernel: its sum is the column's, its variance the square of sigma.
TEST(DepthSmoother, IsAsWideAsItIsAskedToBe) {
  for (const double sigma_mm : {0.3, 0.6, 1.0}) {
    const Smoothed smoothed(Picture(121, 121, [](int c, int) { return c == 60 ? 38.0 : 2.0; }), sigma_mm);
    double sum = 0, squares = 0;
    for (int c = 0; c < 121; ++c) {
      const double above = smoothed.mm(c, 60) - smoothed.mm(0, 60);
      sum += above;
      squares += above * std::pow(0.2 * (c - 60), 2);
    }
    EXPECT_NEAR(sum, 36, 0.02) << sigma_mm;
    EXPECT_NEAR(std::sqrt(squares / sum), sigma_mm, 0.02 * sigma_mm) << "cut off at 3.5 standard deviations";
  }
}

// A Gaussian of width w lifts a parabola z = a (x^2 + y^2) by 2 a w^2; the third order does not.
TEST(DepthSmoother, OfTheThirdOrderKeepsAParabola) {
  const auto bowl = [](int c, int r) { return 2 + 0.02 * (std::pow(0.2 * (c - 75), 2) + std::pow(0.2 * (r - 75), 2)); };
  const double sigma_mm = 1;
  const Smoothed first(Picture(150, 150, bowl), sigma_mm);
  const Smoothed third(Picture(150, 150, bowl), sigma_mm, DepthSmoother::Order::Third);
  for (int c = 50; c < 100; c += 7) {
    EXPECT_NEAR(first.mm(c, 75) - bowl(c, 75), 2 * 0.02 * sigma_mm * sigma_mm, 0.002) << c;
    EXPECT_NEAR(third.mm(c, 75), bowl(c, 75), 2 * kRoundedMm) << c;
  }
}

// Nine samples to a standard deviation: three of them go into one, and the picture that is left says the same.
TEST(DepthSmoother, OfAFinePictureIsAsWideOnFewerSamples) {
  const double sigma_mm = 1.8;
  const Smoothed smoothed(Picture(300, 300, [](int c, int) { return c < 150 ? 10.0 : 20.0; }), sigma_mm);
  ASSERT_EQ(smoothed.cols, 100);
  ASSERT_EQ(smoothed.rows, 100);
  for (int c = 20; c < 80; ++c) {
    const double off_mm = 0.6 * (c + 0.5) - 30;  // of the sample's middle from the step
    const double exact = 15 + 5 * std::erf(off_mm / (std::numbers::sqrt2 * sigma_mm));
    EXPECT_NEAR(smoothed.mm(c, 50), exact, 0.03) << c;
  }
}

// White noise of deviation s on samples p apart has the deviation s p/(sqrt(4 pi) w) after a Gaussian of width w; the
// mean stays.
TEST(DepthSmoother, LeavesOfNoiseWhatTheoryDoes) {
  std::uint32_t state = 1;
  const auto uniform = [&] {
    state = state * 1664525U + 1013904223U;
    return (state >> 8) / 16777216.0 - 0.5;
  };
  const Smoothed smoothed(Picture(400, 300, [&](int, int) { return 20 + 2 * uniform(); }), 0.6);
  double sum = 0, squares = 0, count = 0;
  for (int r = 20; r < 280; ++r) {
    for (int c = 20; c < 380; ++c) {
      sum += smoothed.mm(c, r) - 20;
      squares += std::pow(smoothed.mm(c, r) - 20, 2);
      ++count;
    }
  }
  const double noise = 2 / std::sqrt(12.0), expected = noise * 0.2 / (std::sqrt(4 * std::numbers::pi) * 0.6);
  EXPECT_NEAR(sum / count, 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / count), expected, 0.1 * expected);
}

TEST(DepthSmoother, HolesPullNoHeightAndSmallOnesAreFilled) {
  const auto scene = [](int c, int r) {
    const bool small = c % 17 == 3 && r % 13 == 5, large = std::hypot(c - 100, r - 75) < 25;
    return small || large ? std::nan("") : 20.0;
  };
  const Smoothed smoothed(Picture(200, 150, scene), 0.5);
  EXPECT_TRUE(smoothed.hole);
  EXPECT_TRUE(std::isnan(smoothed.mm(100, 75)));
  for (int r = 0; r < 150; ++r) {
    for (int c = 0; c < 200; ++c) {
      const double z = smoothed.mm(c, r), from_middle = std::hypot(c - 100, r - 75);
      const bool hole = std::isnan(z);
      ASSERT_TRUE(hole || std::abs(z - 20) < 2 * kRoundedMm) << c << " " << r << ": " << z;
      EXPECT_FALSE(hole && from_middle > 26) << c << " " << r;
      EXPECT_FALSE(!hole && from_middle < 22) << c << " " << r;
    }
  }
}

TEST(DepthSmoother, ForgetsTheHolesOfThePictureBefore) {
  const Picture holed(64, 64, [](int, int r) { return r < 32 ? std::nan("") : 20.0; });
  const Picture whole(64, 64, [](int, int) { return 30.0; });
  DepthSmoother smoother(whole.field(), 0.5);
  std::vector<std::uint16_t> codes(64 * 64);
  EXPECT_TRUE(smoother.smooth(holed.field(), codes));
  EXPECT_FALSE(smoother.smooth(whole.field(), codes));
  for (const std::uint16_t code : codes) ASSERT_NEAR(code * kVolumeDepthMm / 65535, 30, kRoundedMm);
  const Picture pierced(64, 64, [](int c, int r) { return c == 32 && r == 33 ? std::nan("") : 30.0; });
  EXPECT_TRUE(smoother.smooth(holed.field(), codes));
  EXPECT_FALSE(smoother.smooth(pierced.field(), codes)) << "rows beside the hole had holes before";
  for (const std::uint16_t code : codes) ASSERT_NEAR(code * kVolumeDepthMm / 65535, 30, kRoundedMm);
}

class OnASphere : public testing::Test {
 protected:
  [[nodiscard]] double errorOf(const char* label) const {
    return forceErrors(playPath(views_, *contender(label), path_, truth_), kSettledS).result().rms_percent;
  }
  std::unique_ptr<const TrueSurface> surface_ = makeTrueSurface("sphere-sliding");
  std::vector<HipTick> path_ = makeFingerPath(*surface_, {.duration_s = 1});
  std::vector<TrueTouch> truth_ = truthAlong(*surface_, path_);
  MemoryFilm film_ = MemoryFilm::make(*surface_, {.depth = kEightBits}, 0, 1).value();
  FilmViews views_{film_};
};

// Like relievo's plan: a codec makes of the steps an error that is as wide as the steps of larger ones.
TEST(BlurWidth, IsLargerWhereACodecHasChangedTheDepth) {
  ClipMeasure rounded{.quantum_mm = 40.0 / 255, .sample_mm = 0.2};
  ClipMeasure coarse = rounded, coded = rounded;
  coarse.quantum_mm *= 2;
  coded.ripples = 0.0024;
  EXPECT_EQ(blurWidthMm(coded), blurWidthMm(coarse));
  EXPECT_NEAR(blurWidthMm(rounded), 0.87, 0.01);
  EXPECT_NEAR(blurWidthMm(coded), 1.10, 0.01);
}

TEST_F(OnASphere, SmoothingTakesMostOfTheStepsAwayFromTheGodObject) {
  EXPECT_LT(errorOf("god-object-smoothed"), errorOf("god-object") / 10);
  EXPECT_LT(errorOf("god-object-smoothed"), 1.5);
}

// The same frames whether the film was smoothed before it is played or the method smooths what it is shown.
TEST_F(OnASphere, AFilmThatIsSmoothedAndAMethodOnSmoothedDepthFeelTheSame) {
  const Contender& god = *contender("god-object");
  const auto on_film = playPath(smoothedFilm(film_, 0.72), *god.make(film_), path_, truth_);
  const auto live = playPath(film_, *onSmoothedDepth(god.make(film_), film_.frames(), 0.72), path_, truth_);
  for (std::size_t i = 0; i < on_film.size(); ++i) ASSERT_EQ(on_film[i].touch.force_n, live[i].touch.force_n) << i;
  EXPECT_TRUE(live.back().touch.contact);
}

TEST_F(OnASphere, TheBlurIsCountedForThoseThatNeedIt) {
  const std::vector<const Contender*> three{contender("relievo"), contender("god-object"),
                                            contender("god-object-smoothed")};
  const auto times = timeTicks(three, {views_, path_, 300}, 2);
  EXPECT_EQ(times[0].frame_ms, 0);
  EXPECT_EQ(times[1].frame_us_per_tick, 0);
  ASSERT_GT(times[2].frame_ms, 0);
  EXPECT_NEAR(times[2].frame_us_per_tick, 1e3 * times[2].frame_ms / (1000.0 / 30), 1e-3 * times[2].frame_us_per_tick);
  for (const TickTimes& t : times) {
    EXPECT_EQ(t.whole.count, t.update.count);
    EXPECT_GE(t.whole.median, t.update.median);
    EXPECT_GE(t.whole.median, t.upkeep.median);
    EXPECT_EQ(t.medianUs(), t.whole.median + t.frame_us_per_tick);
  }
  const auto cold = timeColdTicks(three, {views_, path_, 300}, 3);
  EXPECT_EQ(cold[1].frame_us_per_tick, 0);
  EXPECT_GT(cold[2].frame_us_per_tick, 0);
}

TEST_F(OnASphere, BulletIsAsExactAsTheGodObjectOnSmoothedDepth) {
  if (contender("bullet") == nullptr) GTEST_SKIP() << "built without Bullet";
  EXPECT_NEAR(errorOf("bullet-smoothed"), errorOf("god-object-smoothed"), 0.1 * errorOf("god-object-smoothed"));
  EXPECT_NEAR(errorOf("bullet"), errorOf("god-object"), 0.15 * errorOf("god-object"));
}

TEST(BulletProxy, OnAPlaneIsTheSpringAlongTheNormal) {
  const auto method = makeBulletProxy(0.5);
  if (method == nullptr) GTEST_SKIP() << "built without Bullet";
  const auto film = makeFilm([](double x, double y, double) { return 20 + 0.3 * x - 0.2 * y; }, {}, 0.1);
  MemoryFeed feed(film);
  SurfaceWindow window;
  static_cast<void>(feed.update({}, 0, 0, window));
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.3, 0.2, 1)), on(1.3, 2.1, 20 + 0.3 * 1.3 - 0.2 * 2.1);
  EXPECT_FALSE(method->update(on + 1.0 * normal, window, {}).contact);
  const Touch touch = method->update(on - 3.0 * normal, window, {});
  ASSERT_TRUE(touch.contact);
  // A step of 16 bits over a sample, 0.6 µm over 0.22 mm, turns a triangle by 0.0027.
  EXPECT_NEAR(glm::distance(touch.force_n, 1.5 * normal), 0, 1.5 * 0.0027);
  // Out again, and in from below: nothing is felt there.
  EXPECT_FALSE(method->update(on + 1.0 * normal, window, {}).contact);
  method->reset();
  EXPECT_FALSE(method->update(on - 3.0 * normal, window, {}).contact);
  EXPECT_FALSE(method->update(on + 1.0 * normal, window, {}).contact) << "through the surface from its inside";
}

TEST(Scenarios, SmoothingEveryFrameMendsNoise) {
  EXPECT_FALSE(scenario::noise(challengerNamed("god-object"), true).pass);
  EXPECT_TRUE(scenario::noise(challengerNamed("god-object-smoothed"), true).pass);
}

}  // namespace
}  // namespace relievo
