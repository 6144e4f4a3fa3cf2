// SPDX-License-Identifier: Apache-2.0
// The second scene of the sample film: a rocking bowl of fruit and a rolling ball on a cloth that waves.
#pragma once

#include "app/author/sample/implicit.h"
#include "app/author/sample/sample_look.h"

namespace relievo::sample {

using lanes::Vec3;

// Stage millimetres. Table coordinates: x as on the stage, y away from the viewer along the table, z up from it.
template <class T>
class StillLife {
 public:
  static constexpr double kFront = 62;  // nothing is in front of this
  [[nodiscard]] double front() const { return kFront; }

  explicit StillLife(double t_s) : t_(t_s) {
    const double rock = 0.07 * std::sin(2.6 * t_s);
    rock_c_ = T(std::cos(rock));
    rock_s_ = T(std::sin(rock));
    roll_ = 11.0 * std::sin(1.5 * t_s);
  }

  [[nodiscard]] Parts partsNear(const Box2& piece) const {
    Parts parts = 0;
    const auto ball = [&](Parts part, const Vec3<double>& table, double radius) {
      const double y = table.y * kUpZ + table.z * kUpY;
      if (Box2{table.x - radius, table.x + radius, y - radius, y + radius}.touches(piece)) parts |= part;
    };
    ball(kBowl, {kBowlX, kBowlY, 12}, 36);
    ball(kFruit, {kBowlX, kBowlY, 12}, 34);
    ball(kBall, {kBallX + roll_, kBallY, kBallRadius}, kBallRadius + 6);
    ball(kLemons, {33, -31, 6}, 20);
    return parts;
  }

  [[nodiscard]] T ground(T x, T y) const {
    using lanes::sine;
    const T ripple = sine(x * T(0.085) + y * T(0.045) - T(1.9 * t_)) * T(1.25) +
                     sine(x * T(0.047) - y * T(0.115) + T(1.3 * t_)) * T(0.95);
    return T(kTableZ) - y * T(kUpY / kUpZ) + ripple;
  }

  [[nodiscard]] T solids(const Vec3<T>& p, Parts parts) const {
    const Vec3<T> q = toTable(p);
    T d = T(1e3);
    if (parts & kBowl) d = lanes::min(d, bowl(inBowl(q)));
    if (parts & kFruit) d = lanes::min(d, fruit(inBowl(q)));
    if (parts & kBall) d = lanes::min(d, ball(q));
    if (parts & kLemons) d = lanes::min(d, lemons(q));
    return d;
  }
  [[nodiscard]] T shade(const Vec3<T>& p) const { return solids(p, kAllParts); }

  [[nodiscard]] Look<T> solidLook(const Vec3<T>& p, Parts parts) const {
    const Vec3<T> q = toTable(p);
    const Vec3<T> b = inBowl(q);
    T d = T(1e3);
    Look<T> look = plain<T>(0, 0, 0, 0);
    if (parts & kBowl) nearest(look, d, bowl(b), bowlLook(b));
    if (parts & kFruit) nearest(look, d, fruit(b), fruitLook(b));
    if (parts & kBall) nearest(look, d, ball(q), ballLook(q));
    if (parts & kLemons) nearest(look, d, lemons(q), peel(q, 0.86, 0.62, 0.06));
    return look;
  }

  [[nodiscard]] Look<T> groundLook(T x, T y) const {
    using namespace lanes;
    // Gingham: two crossing sets of stripes on linen.
    Look<T> look = plain<T>(0.66, 0.62, 0.54, 0.04);
    const T thread = sine(x * T(4.6)) * sine(y * T(4.6));
    const T down = smoothStep(sine((x + y * T(0.12)) * T(0.50)), -0.12, 0.12);
    const T across = smoothStep(sine((y - x * T(0.12)) * T(0.50)), -0.12, 0.12);
    look.albedo = mix(look.albedo, {T(0.15), T(0.28), T(0.38)}, (down + across) * T(0.43));
    look.albedo = look.albedo * (T(0.93) + thread * T(0.12));
    return look;
  }

 private:
  enum Part : Parts { kBowl = 1, kFruit = 2, kBall = 4, kLemons = 8 };
  static constexpr double kTableZ = 24.5, kUpY = 0.36, kUpZ = 0.932952;  // the table's upward direction on the stage
  static constexpr double kBowlX = -27, kBowlY = 4, kBowlRadius = 28;
  static constexpr double kBallX = 37, kBallY = 17, kBallRadius = 15;

  [[nodiscard]] static Vec3<T> at(double x, double y, double z) { return {T(x), T(y), T(z)}; }
  [[nodiscard]] static Vec3<T> toTable(const Vec3<T>& p) {
    const T z = p.z - T(kTableZ);
    return {p.x, p.y * T(kUpZ) - z * T(kUpY), p.y * T(kUpY) + z * T(kUpZ)};
  }
  // Bowl coordinates: origin at the centre of the sphere that the bowl is cut from.
  [[nodiscard]] Vec3<T> inBowl(const Vec3<T>& q) const {
    const T x = q.x - T(kBowlX), z = q.z - T(kBowlRadius - 1.0);
    return {x * rock_c_ - z * rock_s_, q.y - T(kBowlY), x * rock_s_ + z * rock_c_};
  }
  [[nodiscard]] static T bowl(const Vec3<T>& b) {
    using namespace lanes;
    const T r = length(b);
    const T shell = abs(r - T(kBowlRadius - 1.3)) - T(1.3);
    const T rim_r = sqrt(b.x * b.x + b.y * b.y) - T(25.6), rim_z = b.z + T(9.5);
    const T lip = sqrt(rim_r * rim_r + rim_z * rim_z) - T(1.9);
    return blend(common(shell, b.z + T(9.5), 0.6), lip, 1.0);
  }
  [[nodiscard]] static T fruit(const Vec3<T>& b) {
    using namespace lanes;
    T d = orange(b, -9.5, -6.0, -14.2);
    d = min(d, orange(b, 9.8, -4.0, -14.2));
    d = min(d, orange(b, 0.5, 10.5, -14.2));
    return min(d, orange(b, 0.5, -1.5, 0.0));
  }
  [[nodiscard, gnu::always_inline]] static T orange(const Vec3<T>& b, double x, double y, double z) {
    return lanes::ellipsoid(b, at(x, y, z), {10.2, 10.2, 9.7});
  }
  [[nodiscard]] T ball(const Vec3<T>& q) const {
    return lanes::sphere(q, at(kBallX + roll_, kBallY, kBallRadius - 0.6), kBallRadius);
  }
  [[nodiscard]] static T lemon(const Vec3<T>& q, double x, double y, double c, double s) {
    using namespace lanes;
    const Vec3<T> d = q - at(x, y, 6.4);
    const Vec3<T> l = {d.x * T(c) + d.y * T(s), d.y * T(c) - d.x * T(s), d.z};
    const T body = ellipsoid(l, at(0, 0, 0), {9.6, 7.4, 7.4});
    return blend(body, ellipsoid(l, at(9.0, 0, 0), {3.2, 2.4, 2.4}), 2.4);
  }
  [[nodiscard]] static T lemons(const Vec3<T>& q) {
    return lanes::min(lemon(q, 25, -29, 0.83, 0.56), lemon(q, 43, -33, -0.37, 0.93));
  }

  [[nodiscard]] static Look<T> peel(const Vec3<T>& q, double r, double g, double b) {
    using lanes::sine;
    Look<T> look = plain<T>(r, g, b, 0.5, 0.5);
    const T pores =
        sine(q.x * T(4.1) + sine(q.y * T(2.3))) * sine(q.y * T(4.3) + sine(q.z * T(2.9))) * sine(q.z * T(4.0));
    look.albedo = look.albedo * (T(0.95) + pores * T(0.10));
    return look;
  }
  [[nodiscard]] static Look<T> bowlLook(const Vec3<T>& b) {
    using namespace lanes;
    Look<T> look = plain<T>(0.74, 0.70, 0.62, 0.9);
    // Bands of glaze around it, inside and out.
    const T band = smoothStep(abs(b.z + T(13.0)), 0.9, 1.2);
    paint(look, T(1.0) - band, 0.06, 0.15, 0.34);
    paint(look, smoothStep(b.z, -10.6, -10.0), 0.06, 0.15, 0.34);
    paint(look,
          (T(1.0) - smoothStep(abs(b.z + T(17.5)), 2.0, 2.3)) *
              smoothStep(sine(b.x * T(0.8)) * sine(b.y * T(0.8)), -0.05, 0.05),
          0.50, 0.13, 0.07);
    return look;
  }
  [[nodiscard]] static Look<T> fruitLook(const Vec3<T>& b) { return peel(b, 0.88, 0.30, 0.03); }
  [[nodiscard]] Look<T> ballLook(const Vec3<T>& q) const {
    using namespace lanes;
    // It rolls without slipping: the rotation angle is the distance over the radius.
    const double turn = roll_ / kBallRadius;
    const Vec3<T> d = q - at(kBallX + roll_, kBallY, kBallRadius - 0.6);
    const T u = d.x * T(std::cos(turn)) - d.z * T(std::sin(turn));
    const T w = d.x * T(std::sin(turn)) + d.z * T(std::cos(turn));
    Look<T> look = plain<T>(0.60, 0.045, 0.05, 1.4);
    const T axis = u * T(0.55) + d.y * T(0.62) + w * T(0.56);
    paint(look, T(1.0) - smoothStep(abs(axis), 3.6, 3.9), 0.80, 0.76, 0.68);
    paint(look, T(1.0) - smoothStep(abs(axis), 1.2, 1.5), 0.05, 0.20, 0.36);
    return look;
  }

  double t_, roll_ = 0;
  T rock_c_, rock_s_;
};

}  // namespace relievo::sample
