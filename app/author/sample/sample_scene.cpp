// SPDX-License-Identifier: Apache-2.0
// Motion of the sample film, and its exact height.
#include "app/author/sample/sample_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/author/sample/sample_stage.h"

namespace relievo {
namespace sample {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double smooth(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// Rises from 0 to 1 and back within `width` seconds around `middle`.
double blink(double t, double middle, double width) {
  const double s = 1 - std::abs(t - middle) / (0.5 * width);
  return smooth(s);
}

constexpr double kHandFrom = 2.1, kHandTo = 5.4;

}  // namespace

HandPose handPose(double t) noexcept {
  // Straight across at a steady 74 mm/s, on a low arc, leaning back a little like a waving hand.
  const double s = (t - kHandFrom) / (kHandTo - kHandFrom);
  const double x = 122 - 244 * s;
  HandPose pose;
  pose.palm = {x, -14 - 0.0016 * x * x, 50};
  pose.roll = 0.0022 * x + 0.06 * std::sin(kTurn * 0.5 * (t - kHandFrom));
  pose.swing = 0.25 * std::sin(kTurn * 0.45 * (t - 3.2));
  pose.curl = 0.22 + 0.16 * std::sin(kTurn * 0.55 * (t - 2.8));
  pose.spread = 0.13 + 0.05 * std::sin(kTurn * 0.4 * (t - 3.0));
  return pose;
}

bool handIsIn(double t) noexcept {
  return t > kHandFrom && t < kHandTo;
}

HeadPose headPose(double t) noexcept {
  HeadPose pose;
  pose.turn = 0.30 * std::sin(kTurn * 0.32 * t) + 0.05 * std::sin(kTurn * 0.61 * t);
  pose.nod = 0.02 + 0.085 * std::sin(kTurn * 0.55 * t);
  pose.tilt = 0.05 * std::sin(kTurn * 0.27 * t + 0.6) - 0.05 * std::sin(0.6);
  pose.eyes_closed = std::max({blink(t, 1.45, 0.34), blink(t, 4.9, 0.34), blink(t, 7.2, 0.34)});
  // The eyes look at the viewer, and follow the hand while it passes.
  const double follow = smooth((t - 2.2) / 0.5) * (1 - smooth((t - 5.0) / 0.5));
  const Vec3<double> hand = handPose(t).palm;
  const Vec3<double> at = Vec3<double>{0, 10, 160} * (1 - follow) + Vec3<double>{hand.x, hand.y + 25, 75} * follow;
  const double right = std::atan2(at.x, at.z) - pose.turn, up = std::atan2(at.y, at.z) + pose.nod - 0.06;
  const double r = std::clamp(right, -0.42, 0.42), u = std::clamp(up, -0.28, 0.28);
  pose.gaze = {std::sin(r) * std::cos(u), std::sin(u), std::cos(r) * std::cos(u)};
  return pose;
}

namespace {

template <class Scene>
double heightMm(const Scene& scene, double x, double y) {
  const double ground = scene.ground(x, y);
  return kReliefMmPerStageMm * std::max(march(scene, x, y, Scene::kFront, ground, 1e-7, kAllParts), ground);
}

}  // namespace
}  // namespace sample

double sampleSceneHeight(double x_mm, double y_mm, double t_s) noexcept {
  const double t = std::clamp(t_s, 0.0, SampleFilm::kSeconds);
  if (t < SampleFilm::kCutSeconds) return sample::heightMm(sample::Portrait<double>(t), x_mm, y_mm);
  return sample::heightMm(sample::StillLife<double>(t), x_mm, y_mm);
}

}  // namespace relievo
