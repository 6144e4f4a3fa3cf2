// SPDX-License-Identifier: Apache-2.0
// A loop of driver, device and hand on a stiff wall, through encoder counts, wire format and motor commands, in
// simulated time: the stiffness at which it starts to oscillate, compared with theory.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "hal/moving_mass.h"
#include "tests/support/device/model_port.h"
#include "tests/support/device/usb/usb_kinds.h"

namespace relievo {
namespace {

using test::UsbKind;

constexpr Duration kTick = std::chrono::milliseconds(1);
constexpr double kTickS = 0.001;
constexpr double kPushN = 2, kOffMm = 0.5;  // without oscillation it does not leave the wall

// Of the moving parts and the hand together.
struct Friction {
  double viscous_n_s_per_mm = 0, dry_n = 0;
};

class Loop {
 public:
  // The device runs, its force has faded in, and its handle is held where it was homed.
  explicit Loop(const UsbKind& kind) : kind_(kind), bench_(kind.make()) {
    hand_ = bench_.model->grip;
    bench_.model->grip = [this](double t_s) { return hand_(t_s); };
    device_ = bench_.driver(std::make_unique<test::ModelPort>(*bench_.model, cable_, clock_), clock_);
    EXPECT_TRUE(device_->open() && device_->home());
    clock_.advance(std::chrono::milliseconds(100));
    EXPECT_TRUE(device_->start());
    for (int i = 0; i < 600; ++i) (void)tick([](const glm::dvec3&) { return glm::dvec3(0); });
  }

  // The largest jump of the reported position along that path, which is the size of a count there.
  double encoderStep(const glm::dvec3& way) {
    double step_mm = 0, before_mm = 0;
    hand_ = [this, way, moved_mm = 0.0](double) mutable { return kind_.rest_mm + (moved_mm += 1e-3) * way; };
    for (int i = 0; i < 1000; ++i) {
      const double told_mm = glm::dot(way, tick([](const glm::dvec3&) { return glm::dvec3(0); }));
      if (i > 1) step_mm = std::max(step_mm, std::abs(told_mm - before_mm));
      before_mm = told_mm;
    }
    return step_mm;
  }

  // Releases the handle kOffMm above its equilibrium in the wall; returns the amplitude after one and a half seconds.
  double swingOn(double stiffness, const glm::dvec3& normal, const Friction& friction) {
    normal_ = normal;
    mass_ = {.mass_kg = 0.15,
             .damping_n_s_per_mm = friction.viscous_n_s_per_mm,
             .coulomb_friction_n = friction.dry_n,
             .position_mm = kind_.rest_mm};
    hand_ = [this](double t_s) { return mass(t_s); };
    const double wall_mm = glm::dot(normal, kind_.rest_mm) + kPushN / stiffness - kOffMm;
    const double peak_n = device_->capabilities().peak_force_n;
    double low = 1e9, high = -1e9;
    for (int i = 0; i < 2000; ++i) {
      const double told_mm = glm::dot(normal, tick([&](const glm::dvec3& told) {
                                        const double deep_mm = wall_mm - glm::dot(normal, told);
                                        return std::clamp(stiffness * deep_mm, 0.0, peak_n) * normal;
                                      }));
      if (i < 1500) continue;
      low = std::min(low, told_mm);
      high = std::max(high, told_mm);
    }
    return high - low;
  }

 private:
  template <class ForceOf>
  glm::dvec3 tick(const ForceOf& forceOf) {
    clock_.advance(kTick);
    const auto sample = device_->read();
    EXPECT_TRUE(sample && device_->write(forceOf(sample->position_mm)));
    return sample ? sample->position_mm : glm::dvec3(0);
  }

  // Called once for each command, at the time of its answer; until then the previous command's force acts.
  glm::dvec3 mass(double t_s) {
    const double commanded_s = t_s - toSeconds(kind_.answers_in);
    advanceTo(commanded_s);
    motors_n_ = bench_.model->forceAt(mass_.position_mm, clock_.now());
    advanceTo(t_s);
    return mass_.position_mm;
  }

  // A soft hand holds it in the directions across the wall's normal.
  void advanceTo(double until_s) {
    constexpr int kSteps = 16;
    constexpr double kAsideNPerMm = 0.05;
    if (!at_s_) at_s_ = until_s;
    const double step_s = (until_s - *at_s_) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const glm::dvec3 off = mass_.position_mm - kind_.rest_mm;
      const glm::dvec3 aside = off - glm::dot(off, normal_) * normal_;
      mass_.step(motors_n_ - kPushN * normal_ - kAsideNPerMm * aside, step_s);
    }
    at_s_ = until_s;
  }

  const UsbKind& kind_;
  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  test::Cable cable_;
  test::UsbBench bench_;
  std::function<glm::dvec3(double t_s)> hand_;
  MovingMass mass_;
  glm::dvec3 normal_{0}, motors_n_{0};
  std::optional<double> at_s_;            // the time of the mass's state
  std::unique_ptr<HapticDevice> device_;  // destroyed first, since its last command must be answered
};

const glm::dvec3 kNormals[] = {{0, 0, 1}, {1, 0, 0}, {-2 / 7.0, 3 / 7.0, 6 / 7.0}};

class UsbLoop : public testing::TestWithParam<UsbKind> {
 protected:
  static double swing(double stiffness, const glm::dvec3& normal, const Friction& friction) {
    return Loop(GetParam()).swingOn(stiffness, normal, friction);
  }
  // 2b / ((1 + 2n) T): a command holds for a tick, and its position is n ticks old.
  static double viscousBound(const Friction& friction) {
    const double n = 1 - toSeconds(GetParam().answers_in) / kTickS;
    return 2 * friction.viscous_n_s_per_mm / ((1 + 2 * n) * kTickS);
  }
};
INSTANTIATE_TEST_SUITE_P(Kinds, UsbLoop, testing::ValuesIn(test::usbKinds().begin(), test::usbKinds().end()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST_P(UsbLoop, WithoutDryFrictionItSwingsFromTheViscousBoundOn) {
  constexpr Friction kViscous{.viscous_n_s_per_mm = 0.002};
  const double bound = viscousBound(kViscous);
  for (const glm::dvec3& normal : kNormals) {
    SCOPED_TRACE(testing::Message() << normal.x << ", " << normal.y << ", " << normal.z);
    EXPECT_LT(swing(0.8 * bound, normal, kViscous), kOffMm);
    EXPECT_GT(swing(1.2 * bound, normal, kViscous), 3 * kOffMm) << "of twice at the beginning";
  }
}

// The bound by the delay, and the bound by the encoders: 2 f / step. Far above the former the device oscillates anyway.
TEST_P(UsbLoop, WithDryFrictionItIsStillUpToFourFifthsOfTheBounds) {
  constexpr Friction kDelayed{.viscous_n_s_per_mm = 0.002, .dry_n = 0.2};
  constexpr Friction kCoarse{.viscous_n_s_per_mm = 0.01, .dry_n = 0.02};
  for (const glm::dvec3& normal : kNormals) {
    const double step_mm = Loop(GetParam()).encoderStep(normal);
    ASSERT_GT(2 * kDelayed.dry_n / step_mm, viscousBound(kDelayed));
    ASSERT_LT(2 * kCoarse.dry_n / step_mm, viscousBound(kCoarse));
    for (const double share : {0.4, 0.8}) {
      EXPECT_LT(swing(share * viscousBound(kDelayed), normal, kDelayed), 0.5 * step_mm) << share;
      EXPECT_LT(swing(share * 2 * kCoarse.dry_n / step_mm, normal, kCoarse), 0.5 * step_mm) << share;
    }
    EXPECT_GT(swing(3 * viscousBound(kDelayed), normal, kDelayed), 1.0);
  }
}

}  // namespace
}  // namespace relievo
