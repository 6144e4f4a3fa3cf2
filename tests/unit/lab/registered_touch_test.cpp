// SPDX-License-Identifier: Apache-2.0
// A generated rig of two cameras whose lenses bend lines: where edges lie after registration, and what a finger feels.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <optional>

#include "app/haptics/method/relievo_method.h"
#include "app/lab/truth/oracle.h"
#include "app/media/registration/registration.h"
#include "tests/support/film/depth_frames.h"

namespace relievo {
namespace {

constexpr int kCols = 320, kRows = 216, kDepthCols = 400, kDepthRows = 320;
constexpr double kUnitMm = 0.25;
using Point = glm::dvec3;

// The formula of OpenCV's documentation, and its inverse by fixed-point iteration: apart from the player's code.
struct TrueLens {
  Lens::Coefficients c;
  [[nodiscard]] double radial(double r2) const {
    const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = c;
    return (1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2) / (1 + k4 * r2 + k5 * r2 * r2 + k6 * r2 * r2 * r2);
  }
  [[nodiscard]] glm::dvec2 tangential(glm::dvec2 a) const {
    const double r2 = glm::dot(a, a);
    return {2 * c[2] * a.x * a.y + c[3] * (r2 + 2 * a.x * a.x), c[2] * (r2 + 2 * a.y * a.y) + 2 * c[3] * a.x * a.y};
  }
  [[nodiscard]] glm::dvec2 seen(glm::dvec2 a) const { return a * radial(glm::dot(a, a)) + tangential(a); }
  [[nodiscard]] glm::dvec2 ray(glm::dvec2 b) const {
    glm::dvec2 a = b;
    for (int i = 0; i < 300; ++i) a = (b - tangential(a)) / radial(glm::dot(a, a));
    return a;
  }
};

// The depth camera's is an Azure Kinect's in kind, the colour camera's that of a cheap wide lens.
RigCamera depthCamera() {
  return {.cols = kDepthCols,
          .rows = kDepthRows,
          .focal_x = 230,
          .focal_y = 231,
          .center_x = 203.4,
          .center_y = 161.2,
          .distortion = {4.1, 2.9, -0.0006, 0.0004, 0.15, 4.4, 4.3, 0.8}};
}
RigCamera colorCamera() {
  return {.cols = kCols,
          .rows = kRows,
          .focal_x = 255,
          .focal_y = 254,
          .center_x = 157.1,
          .center_y = 109.3,
          .distortion = {-0.28, 0.09, 0.0012, -0.0009, -0.012, 0, 0, 0}};
}
Registration rig() {
  const double a = 0.05, b = 0.03;  // turned down, then to the side
  return {.depth = depthCamera(),
          .color = colorCamera(),
          .rotation = {std::cos(b), std::sin(a) * std::sin(b), std::cos(a) * std::sin(b), 0, std::cos(a), -std::sin(a),
                       -std::sin(b), std::sin(a) * std::cos(b), std::cos(a) * std::cos(b)},
          .translation_mm = {-32, 2.5, 4},
          .unit_mm = kUnitMm};
}

glm::dvec2 pixelOf(const RigCamera& camera, const Point& p) {
  const glm::dvec2 seen = TrueLens{camera.distortion}.seen({p.x / p.z, p.y / p.z});
  return {camera.focal_x * seen.x + camera.center_x, camera.focal_y * seen.y + camera.center_y};
}
Point inColor(const Registration& r, const Point& p) {
  const auto& m = r.rotation;
  const auto& t = r.translation_mm;
  return {m[0] * p.x + m[1] * p.y + m[2] * p.z + t[0], m[3] * p.x + m[4] * p.y + m[5] * p.z + t[1],
          m[6] * p.x + m[7] * p.y + m[8] * p.z + t[2]};
}

// A scene is described by how far behind its surface a point of the colour camera's frame is, in mm along the axis,
// given the point and the pixel where it is seen. The first change of sign along a ray is what the depth camera
// measures.
using Behind = std::function<double(const Point&, glm::dvec2)>;
double measured(const Registration& r, glm::dvec2 ray, const Behind& behind) {
  const auto at = [&](double z) {
    const Point p = inColor(r, {ray.x * z, ray.y * z, z});
    return behind(p, pixelOf(r.color, p));
  };
  constexpr double kStep = 20;
  double near = 300;
  while (near < 4000 && at(near + kStep) < 0) near += kStep;
  double far = near + kStep;
  for (int i = 0; i < 40; ++i) {
    const double middle = (near + far) / 2;
    (at(middle) < 0 ? near : far) = middle;
  }
  return near;
}
Frame pictureOf(const Registration& r, const Behind& behind) {
  return test::makeGrayFrame(kDepthCols, kDepthRows, 16, {}, [&](int c, int row) {
    const glm::dvec2 seen{(c - r.depth.center_x) / r.depth.focal_x, (row - r.depth.center_y) / r.depth.focal_y};
    return std::lround(measured(r, TrueLens{r.depth.distortion}.ray(seen), behind) / kUnitMm);
  });
}
Registration withoutLenses() {
  Registration bare = rig();
  bare.depth.distortion = bare.color.distortion = {};
  return bare;
}

double distanceAt(const Frame& frame, int c, int r) {
  return codeAt(frame.components[0], frame.planes[0].data + r * frame.planes[0].stride_bytes + 2 * c) * kUnitMm;
}

// ---- edges: a card in front of a wall, both facing the colour camera ----

constexpr double kCardMm = 700, kWallMm = 1400;
constexpr double kLeft = 70.5, kRight = 240.5, kTop = 40.5, kBottom = 170.5;  // pixels of a 320 x 216 picture

double behindCard(const Point& p, glm::dvec2 pixel) {
  const bool on_card = pixel.x > kLeft && pixel.x < kRight && pixel.y > kTop && pixel.y < kBottom;
  const double wall = p.z - kWallMm;
  return on_card ? p.z - kCardMm : wall;
}

// How far the card's edges are from the true ones: the largest distance in pixels of the colour picture.
double edgeError(const Frame& there) {
  const double scale = static_cast<double>(kCols) / there.width;
  const auto isCard = [&](int c, int r) {
    const double mm = distanceAt(there, c, r);
    return mm > 0 && mm < (kCardMm + kWallMm) / 2;
  };
  double worst = 0;
  const auto note = [&](int pixel, double edge) {  // the edge lies between pixel - 1 and pixel
    const double place = (pixel - 0.5 + 0.5) * scale - 0.5;
    worst = std::max(worst, std::abs(place - edge));
  };
  for (int r = 0; r < there.height; ++r) {
    const double v = (r + 0.5) * scale - 0.5;
    if (v < kTop + 3 || v > kBottom - 3) continue;
    int first = 0, last = there.width;
    while (first < there.width && !isCard(first, r)) ++first;
    while (last > 0 && !isCard(last - 1, r)) --last;
    note(first, kLeft);
    note(last, kRight);
  }
  for (int c = 0; c < there.width; ++c) {
    const double u = (c + 0.5) * scale - 0.5;
    if (u < kLeft + 3 || u > kRight - 3) continue;
    int first = 0, last = there.height;
    while (first < there.height && !isCard(c, first)) ++first;
    while (last > 0 && !isCard(c, last - 1)) --last;
    note(first, kTop);
    note(last, kBottom);
  }
  return worst;
}

TEST(RegisteredTouch, EdgesLieWithinAPixelAndAPinholeAloneDoesNot) {
  const Frame depth = pictureOf(rig(), behindCard);
  const double with = edgeError(Registrar(rig()).registered(depth).value());
  const double without = edgeError(Registrar(withoutLenses()).registered(depth).value());
  RecordProperty("edge_pixels", std::to_string(with));
  RecordProperty("edge_pixels_pinhole", std::to_string(without));
  EXPECT_LE(with, 1.0);
  EXPECT_GT(without, 2.0);
}

// ---- touch: a smooth surface whose picture is the colour camera's ----

constexpr double kNearMm = 700, kFarMm = 1100;
constexpr double kStiffness = 0.5, kDepthMm = 3;
const DisplayVolume kVolume = TrueSurface::kVolume;

double behindSurface(const TrueSurface& surface, const Point& p, glm::dvec2 pixel) {
  const double x = ((pixel.x + 0.5) / kCols - 0.5) * kVolume.width_mm;
  const double y = (0.5 - (pixel.y + 0.5) / kRows) * kVolume.height_mm;
  const double inside_x = std::clamp(x, -kVolume.width_mm, kVolume.width_mm);
  const double inside_y = std::clamp(y, -kVolume.height_mm, kVolume.height_mm);
  const double height = std::clamp(surface.height(inside_x, inside_y, 0), 0.0, kVolume.depth_mm);
  return p.z - (kFarMm - (kFarMm - kNearMm) * height / kVolume.depth_mm);
}

struct Felt {
  double largest = 0, mean = 0;  // difference of the forces over the oracle's mean force
  double holes = 0;
};
// A finger is swept over the middle of the picture, as deep as `kDepthMm` under the surface.
Felt sweep(const TrueSurface& surface, const Frame& there) {
  const DepthCalibration calibration{.polarity = DepthPolarity::NearIsLow,
                                     .bits = 16,
                                     .invalid = CodeSet::parse("0").value(),
                                     .unit_mm = kUnitMm,
                                     .near_mm = kNearMm,
                                     .far_mm = kFarMm};
  const SurfaceWindow window = test::makeWindow(std::span(&there, 1), kVolume, calibration);
  RelievoMethod method({.stiffness_n_per_mm = kStiffness});
  Oracle oracle(surface);
  Felt felt;
  double true_force = 0;
  int ticks = 0;
  for (int i = 0; i < 4000; ++i) {
    const double t = i * 0.001, x = -50 + 25 * t, y = 25 * std::sin(2 * t);
    const double depth = kDepthMm * std::min(1.0, t / 0.3) - 0.5;
    const Point hip{x, y, surface.height(x, y, 0) - depth};
    const glm::dvec3 force = method.update(hip, window, mediaTime(t)).force_n;
    method.upkeep(window, mediaTime(t));
    const TrueTouch touch = oracle.update(hip, t);
    if (t < 0.5) continue;
    const glm::dvec3 truth = kStiffness * (touch.proxy_mm - hip);
    const double error = glm::length(force - truth);
    felt.largest = std::max(felt.largest, error);
    felt.mean += error;
    true_force += glm::length(truth);
    ++ticks;
  }
  felt.largest /= true_force / ticks;
  felt.mean /= true_force;
  for (int r = 0; r < there.height; ++r) {
    for (int c = 0; c < there.width; ++c) felt.holes += distanceAt(there, c, r) == 0 ? 1 : 0;
  }
  felt.holes /= there.width * there.height;
  return felt;
}

// The picture that a depth camera in the colour camera's place would take.
Frame truePicture(const TrueSurface& surface, int cols, int rows) {
  return test::makeGrayFrame(cols, rows, 16, {}, [&](int c, int r) {
    const double x = ((c + 0.5) / cols - 0.5) * kVolume.width_mm, y = (0.5 - (r + 0.5) / rows) * kVolume.height_mm;
    return std::lround((kFarMm - (kFarMm - kNearMm) * surface.height(x, y, 0) / kVolume.depth_mm) / kUnitMm);
  });
}

TEST(RegisteredTouch, ForcesAreWithinAPercentOfTheOracleAndAPinholesAreNot) {
  const auto surface = makeTrueSurface("face");
  const Frame depth =
      pictureOf(rig(), [&](const Point& p, glm::dvec2 pixel) { return behindSurface(*surface, p, pixel); });
  const Frame there = Registrar(rig()).registered(depth).value();
  const Felt with = sweep(*surface, there);
  const Felt without = sweep(*surface, Registrar(withoutLenses()).registered(depth).value());
  const Felt unmoved = sweep(*surface, truePicture(*surface, there.width, there.height));
  RecordProperty("force_error", std::to_string(with.mean));
  RecordProperty("force_error_pinhole", std::to_string(without.mean));
  RecordProperty("force_error_true_picture", std::to_string(unmoved.mean));
  EXPECT_LE(with.mean, 0.01);
  EXPECT_GT(without.mean, 0.03);
  EXPECT_LE(with.holes, 0.001);
}

}  // namespace
}  // namespace relievo
