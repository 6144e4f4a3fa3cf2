// SPDX-License-Identifier: Apache-2.0
// The hand of the sample film: palm, five fingers of two bones each, an arm in a sleeve, seen from its back.
#pragma once

#include <array>

#include "app/author/sample/implicit.h"
#include "app/author/sample/sample_look.h"

namespace relievo::sample {

using lanes::Vec3;

struct HandPose {
  Vec3<double> palm = {0, 0, 0};  // the palm's centre on the stage
  double roll = 0;                // turn in the picture's plane, radians, counter-clockwise
  double swing = 0;               // turn about the arm
  double curl = 0.25;             // bend of each finger joint, radians
  double spread = 0.10;           // angle between neighbouring fingers, radians
};

// Stage millimetres. Hand coordinates: origin in the palm, y to the finger tips, z out of the back of the hand.
template <class T>
class Hand {
 public:
  enum Part : Parts {
    kPalm = 1 << 10,
    kArm = 1 << 11,
    kFinger = 1 << 12,
    kHandParts = 127 << 10
  };  // five bits from kFinger on

  explicit Hand(const HandPose& pose) : palm_(pose.palm) {
    const double cr = std::cos(pose.roll), sr = std::sin(pose.roll);
    const double cs = std::cos(pose.swing), ss = std::sin(pose.swing);
    const Vec3<double> axes[3] = {{cr * cs, sr * cs, -ss}, {-sr, cr, 0}, {cr * ss, sr * ss, cs}};
    for (std::size_t i = 0; i < 3; ++i) {
      axes_[i] = axes[i];
      axis_[i] = to(axes[i]);
    }
    center_ = to(pose.palm);
    constexpr double kRoots[4] = {-11.2, -3.8, 3.7, 10.8}, kRootY[4] = {15.5, 17.5, 16.5, 13};
    constexpr double kLengths[4] = {25, 28.5, 26.5, 20.5};
    for (std::size_t i = 0; i < 4; ++i) {
      const double lean = -(static_cast<double>(i) - 1.4) * pose.spread;
      finger(i, {kRoots[i], kRootY[i], 0.5}, lean, pose.curl * (1.0 + 0.15 * static_cast<double>(i)), kLengths[i],
             i == 3 ? 3.4 : 3.9);
    }
    finger(4, {-10.5, -9, -1.5}, 0.80 + pose.spread, pose.curl * 0.5, 26, 4.6);
  }

  [[nodiscard]] Parts partsNear(const Box2& piece) const {
    Parts parts = 0;
    const auto ball = [&](Parts part, const Vec3<double>& c, double radius) {
      const Vec3<double> s = toStage(c);
      if (Box2{s.x - radius, s.x + radius, s.y - radius, s.y + radius}.touches(piece)) parts |= part;
    };
    ball(kPalm, {0, -2, 0}, 26);
    for (std::size_t i = 0; i < kFingerCount; ++i) {
      for (const Vec3<double>& joint : joints_[i]) ball(kFinger << i, joint, 10);
      ball(kFinger << i, (joints_[i][0] + joints_[i][1]) * 0.5, 9.5);
      ball(kFinger << i, (joints_[i][1] + joints_[i][2]) * 0.5, 9.5);
    }
    for (int y = -28; y > -140; y -= 12) ball(kArm, {0, static_cast<double>(y), 0}, 19);
    return parts;
  }

  [[nodiscard]] T distance(const Vec3<T>& p, Parts parts) const {
    const Vec3<T> h = toHand(p);
    T d = skin(h, parts);
    if (parts & kArm) d = lanes::min(d, sleeve(h));
    return d;
  }

  // The solid that casts shadows: slightly smaller than the hand, so that flat areas do not shadow themselves.
  [[nodiscard]] T shade(const Vec3<T>& p) const {
    using namespace lanes;
    const Vec3<T> h = toHand(p);
    const T near_hand = length(h - at(-4, 8, -2)) - T(46.0);
    const T arm = rod(h, at(0, -8, -1), at(0, -140, -4), 6.0, 11.0);
    if (!any(near_hand < T(14.0))) return min(arm, near_hand);  // too far even for a penumbra
    T d = min(arm, ellipsoid(h, at(0, 3, -1.5), {15, 18.5, 5}));
    for (const Bone& bone : bones_) d = min(d, bone.distance(h) + T(0.3));
    return d;
  }

  [[nodiscard]] Look<T> look(const Vec3<T>& p, Parts parts) const {
    using namespace lanes;
    const Vec3<T> h = toHand(p);
    T d = skin(h, parts);
    Look<T> look = plain<T>(0.62, 0.35, 0.23, 0.22, 1.0);
    for (std::size_t i = 0; i < kFingerCount; ++i) {
      if (!(parts & (kFinger << i))) continue;
      const Bone& bone = bones_[2 * i + 1];
      const Vec3<T> tip = bone.a + bone.along;
      paint(look, T(0.30) * (T(1.0) - smoothStep(length(h - bone.a), 2.5, 5.5)), 0.64, 0.25, 0.17);  // knuckles
      // A nail: an oval on the back of the last bone, just behind its tip.
      const Vec3<T> u = bone.along * bone.inverse_length;
      const Vec3<T> q = h - (tip - u * T(0.2));
      const T along = dot(q, u);
      const T across = q.x * u.y - q.y * u.x;
      const T oval = sqrt(along * along * T(0.13) + across * across * T(0.22));
      const T nail = (T(1.0) - smoothStep(oval, 0.92, 1.05)) * smoothStep(q.z, 1.0, 1.8);
      paint(look, nail, 0.80, 0.46, 0.38);
      look.gloss = look.gloss + nail * T(0.8);
    }
    if (parts & kArm) {
      Look<T> cloth = plain<T>(0.045, 0.09, 0.15, 0.06);
      const T weave = sine((h.x + h.y) * T(3.4)) * sine((h.x - h.y) * T(3.4));
      cloth.albedo = cloth.albedo * (T(0.85) + weave * T(0.25));
      paint(cloth, smoothStep(h.y, -37, -36), 0.74, 0.72, 0.66);  // a white cuff
      nearest(look, d, sleeve(h), cloth);
    }
    return look;
  }

 private:
  static constexpr std::size_t kFingerCount = 5;
  struct Bone {
    Vec3<T> a, along;
    T inverse_square, inverse_length, radius, taper;
    [[nodiscard, gnu::always_inline]] T distance(const Vec3<T>& p) const {
      const Vec3<T> d = p - a;
      const T s = lanes::clamp<T>(dot(d, along) * inverse_square, T(0.0), T(1.0));
      return length(d - along * s) - radius - s * taper;
    }
  };

  [[nodiscard]] static Vec3<T> at(double x, double y, double z) { return {T(x), T(y), T(z)}; }
  [[nodiscard]] static Vec3<T> to(const Vec3<double>& v) { return at(v.x, v.y, v.z); }
  [[nodiscard]] Vec3<double> toStage(const Vec3<double>& h) const {
    return axes_[0] * h.x + axes_[1] * h.y + axes_[2] * h.z + palm_;
  }
  [[nodiscard]] Vec3<T> toHand(const Vec3<T>& p) const {
    const Vec3<T> d = p - center_;
    return {dot(axis_[0], d), dot(axis_[1], d), dot(axis_[2], d)};
  }

  // Two bones; the finger leaves the palm at `lean` from straight up and bends away from the viewer.
  void finger(std::size_t i, const Vec3<double>& root, double lean, double curl, double whole, double radius) {
    const auto bone = [&](std::size_t n, const Vec3<double>& a, double bend, double bone_length, double r0, double r1) {
      const Vec3<double> along = {-std::sin(lean) * std::cos(bend) * bone_length,
                                  std::cos(lean) * std::cos(bend) * bone_length, -std::sin(bend) * bone_length};
      bones_[n] = {to(a), to(along), T(1.0 / (bone_length * bone_length)), T(1.0 / bone_length), T(r0), T(r1 - r0)};
      return a + along;
    };
    const Vec3<double> knuckle = bone(2 * i, root, curl * 0.4, whole * 0.52, radius + 0.3, radius);
    const Vec3<double> tip = bone(2 * i + 1, knuckle, curl * 1.4, whole * 0.48, radius, radius - 0.7);
    joints_[i] = {root, knuckle, tip};
  }

  [[nodiscard]] T skin(const Vec3<T>& h, Parts parts) const {
    using namespace lanes;
    T d = T(1e3);
    if (parts & kPalm) {
      d = ellipsoid(h, at(0, 2, -0.5), {15.5, 18.5, 6.2});
      d = blend(d, ellipsoid(h, at(-8, -7, -2.5), {8, 12, 6}), 4.0);  // ball of the thumb
    }
    if (parts & (kPalm | kArm)) d = blend(d, rod(h, at(0, -10, -0.5), at(0, -60, -1), 7.4, 8.4), 8.0);  // wrist
    for (std::size_t i = 0; i < kFingerCount; ++i) {
      if (!(parts & (kFinger << i))) continue;
      d = blend(d, blend(bones_[2 * i].distance(h), bones_[2 * i + 1].distance(h), 1.0), 3.0);
    }
    return d;
  }

  [[nodiscard]] static T sleeve(const Vec3<T>& h) {
    using namespace lanes;
    const T tube = rod(h, at(0, -30, -0.5), at(0, -150, -4), 11.0, 15.0);
    const T cuff = common(rod(h, at(0, -28, -0.5), at(0, -44, -0.5), 11.6, 11.6), h.y + T(31.5), 1.5);
    return min(common(tube, h.y + T(36.0), 1.0), cuff);
  }

  Vec3<double> palm_;
  std::array<Vec3<double>, 3> axes_;
  std::array<Vec3<T>, 3> axis_;
  Vec3<T> center_;
  std::array<Bone, 2 * kFingerCount> bones_;
  std::array<std::array<Vec3<double>, 3>, kFingerCount> joints_;
};

}  // namespace relievo::sample
