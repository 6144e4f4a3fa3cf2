// SPDX-License-Identifier: Apache-2.0
// Shapes that move, steps and cuts; and their names.
#include "app/lab/truth/true_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "app/lab/truth/true_shapes.h"

namespace relievo {
namespace {

// A shape without turning: slide is along x, heave along z, both sines; rise is along z and steady.
struct Motion {
  double slide_mm = 0, slide_hz = 0;
  double heave_mm = 0, heave_hz = 0;
  double rise_mm_per_s = 0;

  static constexpr double kTurn = 2 * std::numbers::pi;
  [[nodiscard]] double x(double t) const { return slide_mm * std::sin(kTurn * slide_hz * t); }
  [[nodiscard]] double z(double t) const { return heave_mm * std::sin(kTurn * heave_hz * t) + rise_mm_per_s * t; }
  [[nodiscard]] double maxSpeedX() const { return kTurn * slide_hz * slide_mm; }
  [[nodiscard]] double maxSpeedZ() const { return kTurn * heave_hz * heave_mm + std::abs(rise_mm_per_s); }
  [[nodiscard]] double speedX(double t) const { return maxSpeedX() * std::cos(kTurn * slide_hz * t); }
  [[nodiscard]] double speedZ(double t) const {
    return kTurn * heave_hz * heave_mm * std::cos(kTurn * heave_hz * t) + rise_mm_per_s;
  }
};

template <class Shape>
double steepestAcross(const Shape& shape) {
  constexpr int kPerMm = 2, kRimMm = 4;  // the rim becomes visible when the shape slides
  constexpr int kEndX = (static_cast<int>(TrueSurface::kVolume.width_mm) / 2 + kRimMm) * kPerMm;
  constexpr int kEndY = static_cast<int>(TrueSurface::kVolume.height_mm) / 2 * kPerMm;
  double steepest = 0;
  for (int r = -kEndY; r <= kEndY; ++r) {
    for (int c = -kEndX; c <= kEndX; ++c) {
      const double x = static_cast<double>(c) / kPerMm, y = static_cast<double>(r) / kPerMm;
      steepest = std::max(steepest, std::abs(shape(Jet(x, 1, 0), Jet(y, 0, 1)).x));
    }
  }
  return steepest;
}

template <class Shape>
class MovingShape final : public TrueSurface {
 public:
  MovingShape(const Shape& shape, const Motion& motion, Traits traits)
      : TrueSurface(withSpeed(shape, motion, traits)), shape_(shape), motion_(motion) {}

  [[nodiscard]] double height(double x, double y, double t) const override {
    return shape_(x - motion_.x(t), y) + motion_.z(t);
  }
  void heights(std::span<const double> x, double y, double t, std::span<double> out) const override {
    const double slid = motion_.x(t), raised = motion_.z(t);
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = shape_(x[i] - slid, y) + raised;
  }
  [[nodiscard]] SurfaceJet jet(double x, double y, double t) const override {
    const Jet s = shape_(Jet(x - motion_.x(t), 1, 0), Jet(y, 0, 1));
    return {s.v + motion_.z(t), s.x, s.y, s.xx, s.xy, s.yy, motion_.speedZ(t) - s.x * motion_.speedX(t)};
  }

 private:
  static Traits withSpeed(const Shape& shape, const Motion& motion, Traits traits) {
    const double sideways = motion.slide_mm != 0 ? motion.maxSpeedX() * steepestAcross(shape) : 0;
    traits.max_speed_mm_per_s = sideways + motion.maxSpeedZ();
    return traits;
  }

  Shape shape_;
  Motion motion_;
};

class Step final : public TrueSurface {
 public:
  // The edge is x = start + kSlant y + speed t.
  Step(double start_mm, double speed_mm_per_s, double duration_s)
      : TrueSurface({false, std::abs(speed_mm_per_s) / kLength, duration_s}),
        start_mm_(start_mm),
        speed_mm_per_s_(speed_mm_per_s) {}

  [[nodiscard]] double height(double x, double y, double t) const override { return levelOf(wall(t), x, y); }
  void heights(std::span<const double> x, double y, double t, std::span<double> out) const override {
    const StepWall now = wall(t);
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = levelOf(now, x[i], y);
  }
  [[nodiscard]] SurfaceJet jet(double x, double y, double t) const override { return {.z = height(x, y, t)}; }
  [[nodiscard]] std::optional<StepWall> wallAt(double t) const override { return wall(t); }

 private:
  static constexpr double kSlant = 0.3, kHighMm = 27.5, kLowMm = 12.5;
  static constexpr double kLength = 1.0440306508910550;  // sqrt(1 + kSlant^2)

  [[nodiscard]] StepWall wall(double t) const {
    return {{1 / kLength, -kSlant / kLength}, (start_mm_ + speed_mm_per_s_ * t) / kLength, kHighMm, kLowMm};
  }
  static double levelOf(const StepWall& now, double x, double y) {
    return now.distance(x, y) < 0 ? now.high_mm : now.low_mm;
  }

  double start_mm_, speed_mm_per_s_;
};

class Cut final : public TrueSurface {
 public:
  Cut(std::unique_ptr<TrueSurface> before, std::unique_ptr<TrueSurface> after, double cut_s)
      : TrueSurface({false, std::max(before->traits().max_speed_mm_per_s, after->traits().max_speed_mm_per_s)}),
        before_(std::move(before)),
        after_(std::move(after)),
        cut_s_(cut_s) {}

  [[nodiscard]] double height(double x, double y, double t) const override { return at(t).height(x, y, t); }
  void heights(std::span<const double> x, double y, double t, std::span<double> out) const override {
    at(t).heights(x, y, t, out);
  }
  [[nodiscard]] SurfaceJet jet(double x, double y, double t) const override { return at(t).jet(x, y, t); }
  [[nodiscard]] std::optional<StepWall> wallAt(double t) const override { return at(t).wallAt(t); }
  [[nodiscard]] int shotAt(double t) const override { return t < cut_s_ ? 0 : 1; }

 private:
  [[nodiscard]] const TrueSurface& at(double t) const { return t < cut_s_ ? *before_ : *after_; }

  std::unique_ptr<TrueSurface> before_, after_;
  double cut_s_;
};

template <class Shape>
std::unique_ptr<TrueSurface> moving(const Shape& shape, const Motion& motion = {}, const TrueSurface::Traits& t = {}) {
  return std::make_unique<MovingShape<Shape>>(shape, motion, t);
}

constexpr Motion kSliding{.slide_mm = 4, .slide_hz = 0.53};
constexpr Motion kHeaving{.heave_mm = 2, .heave_hz = 0.67};
constexpr Motion kNodding{.slide_mm = 4, .slide_hz = 0.53, .heave_mm = 3, .heave_hz = 0.71};
constexpr shapes::Plane kTilted{20, 0.15, 0.08};
constexpr shapes::Plane kShallow{20, 0.031, 0.0113};
constexpr shapes::SphereCap kSphere{};
constexpr shapes::Face kFace{};

std::unique_ptr<TrueSurface> makeRise(const SceneOptions& o) {
  constexpr double kFromMm = 8, kWayMm = 24;  // the corners are 5.6 mm off the middle
  const double start = o.speed_mm_per_s < 0 ? kFromMm + kWayMm : kFromMm;
  return moving(shapes::Plane{start, 0.05, 0.03}, {.rise_mm_per_s = o.speed_mm_per_s},
                {.duration_s = kWayMm / std::abs(o.speed_mm_per_s)});
}

std::unique_ptr<TrueSurface> makeMovingStep(const SceneOptions& o) {
  constexpr double kFromMm = 40.37;
  const double start = o.speed_mm_per_s < 0 ? kFromMm : -kFromMm;
  return std::make_unique<Step>(start, o.speed_mm_per_s, 2 * kFromMm / std::abs(o.speed_mm_per_s));
}

std::unique_ptr<TrueSurface> makePlaneCut(double from_mm, double to_mm, const SceneOptions& o) {
  return std::make_unique<Cut>(moving(shapes::Plane{from_mm, 0.05, 0.03}), moving(shapes::Plane{to_mm, -0.04, 0.05}),
                               o.cut_s);
}

struct Entry {
  std::string_view name;
  std::unique_ptr<TrueSurface> (*make)(const SceneOptions&);
};
constexpr TrueSurface::Traits kRough{.smooth = false};

constexpr std::array kScenes{
    Entry{"plane", [](const SceneOptions&) { return moving(kTilted); }},
    Entry{"plane-sliding", [](const SceneOptions&) { return moving(kTilted, kSliding); }},
    Entry{"plane-heaving", [](const SceneOptions&) { return moving(kTilted, kHeaving); }},
    Entry{"shallow-plane", [](const SceneOptions&) { return moving(kShallow); }},
    Entry{"sphere", [](const SceneOptions&) { return moving(kSphere); }},
    Entry{"sphere-sliding", [](const SceneOptions&) { return moving(kSphere, kSliding); }},
    Entry{"sphere-heaving", [](const SceneOptions&) { return moving(kSphere, kHeaving); }},
    Entry{"face", [](const SceneOptions&) { return moving(kFace); }},
    Entry{"face-sliding", [](const SceneOptions&) { return moving(kFace, kSliding); }},
    Entry{"face-heaving", [](const SceneOptions&) { return moving(kFace, kHeaving); }},
    Entry{"face-nodding", [](const SceneOptions&) { return moving(kFace, kNodding); }},
    Entry{"ridge", [](const SceneOptions&) { return moving(shapes::Fold{4}, {}, kRough); }},
    Entry{"groove", [](const SceneOptions&) { return moving(shapes::Fold{-4}, {}, kRough); }},
    Entry{"step",
          [](const SceneOptions&) -> std::unique_ptr<TrueSurface> {
            return std::make_unique<Step>(3.17, 0, std::numeric_limits<double>::infinity());
          }},
    Entry{"step-moving", makeMovingStep},
    Entry{"rise", makeRise},
    Entry{"cut",
          [](const SceneOptions& o) -> std::unique_ptr<TrueSurface> {
            return std::make_unique<Cut>(moving(kFace), moving(kSphere), o.cut_s);
          }},
    Entry{"cut-up", [](const SceneOptions& o) { return makePlaneCut(10, 28, o); }},
    Entry{"cut-down", [](const SceneOptions& o) { return makePlaneCut(29, 20, o); }},
};

constexpr auto kNames = [] {
  std::array<std::string_view, kScenes.size()> names;
  std::transform(kScenes.begin(), kScenes.end(), names.begin(), [](const Entry& e) { return e.name; });
  return names;
}();

}  // namespace

std::span<const std::string_view> trueSurfaceNames() {
  return kNames;
}

std::unique_ptr<TrueSurface> makeTrueSurface(std::string_view name, const SceneOptions& options) {
  const auto found = std::find_if(kScenes.begin(), kScenes.end(), [&](const Entry& e) { return e.name == name; });
  return found == kScenes.end() ? nullptr : found->make(options);
}

}  // namespace relievo
