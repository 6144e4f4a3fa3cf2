// SPDX-License-Identifier: Apache-2.0
// Follows the finger in short straight pieces on a sheet, and exactly from event to event on a step.
#include "app/lab/truth/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/lab/truth/slide_to_closest.h"
#include "app/lab/truth/step_section.h"

namespace relievo {
namespace {

// A longer motion of the finger or the surface is divided into steps of this length, which is far smaller than the
// narrowest shape.
constexpr double kPieceMm = 0.05;
constexpr double kOnTheWayMm = 1e-6;  // the proxy's tolerance within a tick
constexpr double kAtTheEndMm = 1e-13;

}  // namespace

TrueTouch Oracle::update(const glm::dvec3& hip_mm, double t_s) {
  const auto before = surface_.wallAt(t_), now = surface_.wallAt(t_s);
  if (state_ == State::New || surface_.shotAt(t_s) != surface_.shotAt(t_)) {
    state_ = outside(hip_mm, t_s) ? State::Free : State::Buried;
  } else if (before && now) {
    followStep(hip_mm, *before, *now);
  } else {
    followSheet(hip_mm, t_s);
  }
  hip_ = hip_mm;
  t_ = t_s;
  if (state_ != State::Contact) return {hip_mm, false};
  if (now) {
    const glm::dvec2 plan = glm::dvec2(hip_mm) + now->normal * (section_.x - now->distance(hip_mm.x, hip_mm.y));
    return {{plan, section_.y}, true};
  }
  return {{proxy_, surface_.height(proxy_.x, proxy_.y, t_s)}, true};
}

void Oracle::followSheet(const glm::dvec3& hip, double t) {
  const glm::dvec3 from = hip_;
  const double begin = t_;
  const double way = std::max(glm::distance(hip, from), surface_.traits().max_speed_mm_per_s * (t - begin));
  const int pieces = std::max(1, static_cast<int>(std::ceil(way / kPieceMm)));
  for (int i = 1; i < pieces; ++i) {
    const double s = static_cast<double>(i) / pieces;
    passSheet(glm::mix(from, hip, s), begin + s * (t - begin), kOnTheWayMm);
  }
  passSheet(hip, t, kAtTheEndMm);
}

// One piece, from (hip_, t_) to (hip, t).
void Oracle::passSheet(const glm::dvec3& hip, double t, double tolerance_mm) {
  const glm::dvec3 from = hip_;
  const double begin = t_;
  hip_ = hip;
  t_ = t;
  if (outside(hip, t)) {
    state_ = State::Free;
    return;
  }
  if (state_ == State::Buried) return;
  if (state_ == State::Free) {
    // Outside at its beginning, inside at its end: the crossing, by halves down to rounding.
    double out = 0, in = 1;
    for (;;) {
      const double middle = 0.5 * (out + in);
      if (middle <= out || middle >= in) break;
      (outside(glm::mix(from, hip, middle), begin + middle * (t - begin)) ? out : in) = middle;
    }
    proxy_ = glm::dvec2(glm::mix(from, hip, in));
    state_ = State::Contact;
  }
  proxy_ = slideToClosest(surface_, t, hip, proxy_, tolerance_mm);
}

// In section and relative to the wall the finger's way is straight. It is cut where it meets the floors' heights and
// the wall's plane: between two such events it is inside or outside all the time.
void Oracle::followStep(const glm::dvec3& hip, const StepWall& before, const StepWall& now) {
  const StepSection section{now.high_mm, now.low_mm};
  const glm::dvec2 from(before.distance(hip_.x, hip_.y), hip_.z), to(now.distance(hip.x, hip.y), hip.z);
  const auto event = [](double a, double b, double level) {
    return (a - level) * (b - level) < 0 ? (level - a) / (b - a) : 1.0;
  };
  std::array<double, 5> events{0.0, event(from.x, to.x, 0.0), event(from.y, to.y, section.high_mm),
                               event(from.y, to.y, section.low_mm), 1.0};
  std::sort(events.begin(), events.end());
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    if (events[i] >= events[i + 1]) continue;
    if (!section.inside(glm::mix(from, to, 0.5 * (events[i] + events[i + 1])))) {
      state_ = State::Free;
      continue;
    }
    if (state_ == State::Buried) continue;
    if (state_ == State::Free) section_ = section.nearest(glm::mix(from, to, events[i]));
    state_ = State::Contact;
    section_ = section.slide(section_, glm::mix(from, to, events[i + 1]));
  }
  if (!section.inside(to)) state_ = State::Free;
}

}  // namespace relievo
