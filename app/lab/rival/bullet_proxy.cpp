// SPDX-License-Identifier: Apache-2.0
// Rays against the terrain, and planes between them.
#include "app/lab/rival/bullet_proxy.h"

// Without the library this method does not exist.
#if !__has_include(<BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>)
std::unique_ptr<relievo::TouchMethod> relievo::makeBulletProxy(double /*stiffness_n_per_mm*/) {
  return nullptr;
}
#else

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <utility>

#include "app/haptics/baseline/surface_in_time.h"

namespace relievo {
namespace {

constexpr int kMostRays = 32;     // of a tick
constexpr double kLiftMm = 5e-4;  // the proxy rests so far above the surface: more than single precision rounds
constexpr double kArrivedMm = 1e-3;

struct Plane {
  glm::dvec3 normal{0, 0, 1};
  double offset_mm = 0;  // normal . x, of the plane on which the proxy rests

  [[nodiscard]] bool allows(const glm::dvec3& place) const { return glm::dot(normal, place) >= offset_mm - 1e-6; }
};

struct Hit {
  glm::dvec3 place_mm{0};  // lifted
  Plane plane;
};

// The terrain's frame is the scene's, except that the height counts from the middle of the volume; its rows go up. A
// sample outside the picture is a hole, which no ray hits.
class Terrain final : public btHeightfieldTerrainShape {
 public:
  explicit Terrain(const HeightField& like)
      : btHeightfieldTerrainShape(like.cols(), like.rows(), &kNothing, 0, static_cast<float>(like.depthMm()), 2,
                                  false) {
    setLocalScaling({static_cast<float>(1 / like.grid().u_per_mm), static_cast<float>(-1 / like.grid().v_per_mm), 1});
  }
  void show(const SurfaceInTime& surface) { surface_ = &surface; }
  [[nodiscard]] bool fits(const SurfaceInTime& surface) const {
    return m_heightStickWidth == surface.cols() && m_heightStickLength == surface.rows();
  }
  [[nodiscard]] double middleMm() const { return 0.5 * static_cast<double>(m_maxHeight); }

 protected:
  [[nodiscard]] btScalar getRawHeightFieldValue(int x, int y) const override {
    const int row = m_heightStickLength - 1 - y;
    if (x < 0 || row < 0 || x >= m_heightStickWidth || y < 0) return std::nanf("");
    return static_cast<btScalar>(surface_->vertexHeight(x, row));
  }

 private:
  static constexpr float kNothing = 0;
  const SurfaceInTime* surface_ = nullptr;
};

// The first triangle that a ray meets from above.
class FirstHit final : public btTriangleRaycastCallback {
 public:
  FirstHit(const btVector3& from, const btVector3& to) : btTriangleRaycastCallback(from, to) {}
  btScalar reportHit(const btVector3& normal, btScalar fraction, int /*part*/, int /*triangle*/) override {
    if (normal.z() <= 0) return m_hitFraction;
    normal_ = normal;
    return fraction;
  }
  [[nodiscard]] bool met() const { return m_hitFraction < 1; }
  [[nodiscard]] glm::dvec3 normal() const { return glm::normalize(glm::dvec3(normal_.x(), normal_.y(), normal_.z())); }

 private:
  btVector3 normal_{0, 0, 1};
};

// The point on all of these planes that is closest to the finger; nullopt if they have no point in common.
std::optional<glm::dvec3> closestOn(std::span<const Plane> planes, const glm::dvec3& hip) {
  constexpr double kParallel = 1e-7;
  const auto off = [&](const Plane& p) { return p.offset_mm - glm::dot(p.normal, hip); };
  if (planes.size() == 1) return hip + off(planes[0]) * planes[0].normal;
  const glm::dvec3 &a = planes[0].normal, &b = planes[1].normal;
  if (planes.size() == 2) {
    const double ab = glm::dot(a, b), square = 1 - ab * ab;
    if (square < kParallel) return std::nullopt;
    const double da = off(planes[0]), db = off(planes[1]);
    return hip + ((da - ab * db) * a + (db - ab * da) * b) / square;
  }
  const glm::dvec3& c = planes[2].normal;
  const double volume = glm::dot(a, glm::cross(b, c));
  if (std::abs(volume) < kParallel) return std::nullopt;
  return (planes[0].offset_mm * glm::cross(b, c) + planes[1].offset_mm * glm::cross(c, a) +
          planes[2].offset_mm * glm::cross(a, b)) /
         volume;
}

// The planes that hold the proxy, the newest first.
class Constraints {
 public:
  explicit Constraints(const Plane& first) : planes_{first} {}

  // Keeps, of the earlier planes, only those needed for a goal that all of them allow.
  glm::dvec3 goalWith(const Plane& newest, const glm::dvec3& hip) {
    const auto before = planes_;
    const auto [one, two] = std::pair(before[0], before[1]);
    const int held = count_;
    const std::array<std::array<Plane, 3>, 4> sets{
        {{newest, {}, {}}, {newest, one, {}}, {newest, two, {}}, {newest, one, two}}};
    constexpr std::array<int, 4> kSizes{1, 2, 2, 3}, kNeeds{0, 1, 2, 2};
    for (std::size_t i = 0; i < sets.size(); ++i) {
      if (held < kNeeds[i]) continue;
      const auto goal = closestOn({sets[i].data(), static_cast<std::size_t>(kSizes[i])}, hip);
      if (!goal || !(held < 1 || one.allows(*goal)) || !(held < 2 || two.allows(*goal))) continue;
      planes_ = sets[i];
      count_ = kSizes[i];
      return *goal;
    }
    *this = Constraints(newest);
    return *closestOn({&newest, 1}, hip);
  }

  [[nodiscard]] bool hold(const Plane& plane) const {
    return std::any_of(planes_.begin(), planes_.begin() + count_,
                       [&](const Plane& p) { return glm::dot(p.normal, plane.normal) > 1 - 1e-10; });
  }

 private:
  std::array<Plane, 3> planes_;
  int count_ = 1;
};

class BulletProxy final : public TouchMethod {
 public:
  explicit BulletProxy(double stiffness) : stiffness_(stiffness) {}

  [[nodiscard]] Touch update(const glm::dvec3& hip, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override {
    if (!primed_ || window.epoch != epoch_) {
      primed_ = true;
      epoch_ = window.epoch;
      last_ = {.proxy_mm = hip};
      height_mm_ = HeightField::kHole;
    }
    const SurfaceInTime surface(window, now, TimeLaw::Linear);
    if (surface.empty()) return last_ = {.proxy_mm = hip};
    if (!terrain_ || !terrain_->fits(surface)) terrain_.emplace(window.frames[0].field);
    terrain_->show(surface);
    last_ = follow(carried(surface), hip);
    height_mm_ = surfaceHeight(surface, last_.proxy_mm.x, last_.proxy_mm.y);
    return last_;
  }
  void reset() RELIEVO_RT override { primed_ = false; }

 private:
  [[nodiscard]] std::optional<Hit> ray(const glm::dvec3& from, const glm::dvec3& to) const {
    const double middle = terrain_->middleMm();
    const auto local = [&](const glm::dvec3& p) {
      return btVector3(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z - middle));
    };
    FirstHit hit(local(from), local(to));
    terrain_->performRaycast(&hit, hit.m_from, hit.m_to);
    if (!hit.met()) return std::nullopt;
    const glm::dvec3 normal = hit.normal();
    const glm::dvec3 place = from + static_cast<double>(hit.m_hitFraction) * (to - from) + kLiftMm * normal;
    return Hit{place, {normal, glm::dot(normal, place)}};
  }
  // A proxy that is held never begins below the surface. A hole in either tick compares false.
  [[nodiscard]] glm::dvec3 carried(const SurfaceInTime& surface) const {
    const glm::dvec3& proxy = last_.proxy_mm;
    const double ground = surfaceHeight(surface, proxy.x, proxy.y), risen = ground - height_mm_;
    double z = proxy.z + (risen > 0 ? risen : 0);
    if (last_.contact && z < ground + kLiftMm) z = ground + kLiftMm;
    return {proxy.x, proxy.y, z};
  }
  // A ray's cost grows with the cells that it crosses, and the surface is usually near.
  [[nodiscard]] std::optional<Hit> rayTowards(const glm::dvec3& from, const glm::dvec3& hip) const {
    constexpr double kNearMm = 0.3;
    const double length = glm::distance(from, hip);
    if (length > 2 * kNearMm) {
      if (const auto hit = ray(from, from + kNearMm / length * (hip - from))) return hit;
    }
    return ray(from, hip);
  }
  // Each round moves to the goal that the planes allow, and casts a ray from there to the finger.
  [[nodiscard]] Touch follow(const glm::dvec3& from, const glm::dvec3& hip) const {
    auto hit = rayTowards(from, hip);
    if (!hit) return {.proxy_mm = hip};
    glm::dvec3 proxy = hit->place_mm;
    Constraints constraints(hit->plane);
    Hit last = *hit, earlier = last;
    for (int rays = 1; rays < kMostRays; ++rays) {
      const glm::dvec3 goal = constraints.goalWith(hit->plane, hip);
      hit = ray(proxy, goal);
      if (hit) {
        proxy = hit->place_mm;
        continue;
      }
      proxy = goal;
      hit = rayTowards(proxy, hip);
      // Arrived: the surface below is the triangle that set the goal, or the point where the round began.
      if (!hit || isAt(*hit, constraints.hold(hit->plane) ? goal : last.place_mm)) break;
      // Alternates across a ridge: the proxy belongs on the line that both planes share.
      if (isAt(*hit, earlier.place_mm)) {
        const auto ridge = closestOn(std::array{last.plane, hit->plane}, hip);
        if (ridge && !ray(proxy, *ridge)) proxy = *ridge;
        break;
      }
      proxy = hit->place_mm;
      constraints = Constraints(hit->plane);
      earlier = std::exchange(last, *hit);
    }
    return {.proxy_mm = proxy, .force_n = stiffness_ * (proxy - hip), .contact = true};
  }
  [[nodiscard]] static bool isAt(const Hit& hit, const glm::dvec3& place) {
    return glm::distance(hit.place_mm, place) < kArrivedMm;
  }

  double stiffness_;
  std::optional<Terrain> terrain_;
  bool primed_ = false;
  std::uint32_t epoch_ = 0;
  Touch last_;
  double height_mm_ = HeightField::kHole;  // of the surface under the proxy, in the tick before
};

}  // namespace

std::unique_ptr<TouchMethod> makeBulletProxy(double stiffness_n_per_mm) {
  return std::make_unique<BulletProxy>(stiffness_n_per_mm);
}

}  // namespace relievo

#endif
