// SPDX-License-Identifier: Apache-2.0
// The bust of the sample film: a head that turns and nods on a neck, hair in a bun, shoulders in a jumper.
#pragma once

#include "app/author/sample/implicit.h"
#include "app/author/sample/sample_look.h"

namespace relievo::sample {

using lanes::Vec3;

// The head's pose at one time: rotation about its upright axis, nod and sideways tilt, in radians.
struct HeadPose {
  double turn = 0, nod = 0, tilt = 0;
  double eyes_closed = 0;         // 0 open .. 1 shut
  Vec3<double> gaze = {0, 0, 1};  // direction of gaze in head coordinates, unit length
};

// Stage millimetres (see sample_scene.h). Head coordinates: origin between the eyes inside the skull, z out of the
// face.
template <class T>
class Bust {
 public:
  enum Part : Parts {
    kSkull = 1,
    kEyes = 2,
    kNose = 4,
    kMouth = 8,
    kEars = 16,
    kHair = 32,
    kNeck = 64,
    kJumper = 128,
    kChin = 256,
    kCheeks = 512,
    kBustParts = 1023
  };
  static constexpr double kFront = 50;  // nothing is in front of this

  explicit Bust(const HeadPose& pose) {
    const double cy = std::cos(pose.turn), sy = std::sin(pose.turn);
    const double cx = std::cos(pose.nod), sx = std::sin(pose.nod);
    const double cz = std::cos(pose.tilt), sz = std::sin(pose.tilt);
    // Columns of Ry(turn) Rx(nod) Rz(tilt), which are the head's axes on the stage; a positive nod lowers the chin.
    head_axes_[0] = {cy * cz + sy * sx * sz, cx * sz, -sy * cz + cy * sx * sz};
    head_axes_[1] = {-cy * sz + sy * sx * cz, cx * cz, sy * sz + cy * sx * cz};
    head_axes_[2] = {sy * cx, -sx, cy * cx};
    for (int i = 0; i < 3; ++i) axis_[i] = {T(head_axes_[i].x), T(head_axes_[i].y), T(head_axes_[i].z)};
    lid_ = T(pose.eyes_closed);
    gaze_ = {T(pose.gaze.x), T(pose.gaze.y), T(pose.gaze.z)};
  }

  [[nodiscard]] Parts partsNear(const Box2& piece) const {
    Parts parts = 0;
    const auto ball = [&](Parts part, const Vec3<double>& c, double radius) {
      const Vec3<double> s = toStage(c);
      if (Box2{s.x - radius, s.x + radius, s.y - radius, s.y + radius}.touches(piece)) parts |= part;
    };
    ball(kSkull, {0, 0, -2}, 43);
    ball(kChin, {0, -26.5, 13.5}, 22);
    for (const double side : {-1.0, 1.0}) {
      ball(kCheeks, {side * 10.5, -10.5, 13}, 19);
      ball(kHair, {side * 21, 6, -12}, 20);
      ball(kEyes, {side * 9.8, 2.5, 19}, 14);
      ball(kEars, {side * 26, -3, -4}, 17);
    }
    ball(kNose, {0, -5, 25}, 14);
    ball(kMouth, {0, -19, 22}, 13);
    ball(kHair, {0, 24, 0}, 23);
    if (Box2{-20, 20, -70, -7}.touches(piece)) parts |= kNeck;
    if (Box2{-90, 90, -90, -33}.touches(piece)) parts |= kJumper;
    return parts;
  }

  [[nodiscard]] T distance(const Vec3<T>& p, Parts parts) const {
    const Vec3<T> h = toHead(p);
    const Vec3<T> m = mirrored(h);
    T d = skin(p, h, m, parts);
    if (parts & kEyes) d = lanes::min(d, eye(m));
    if (parts & kHair) d = lanes::blend(d, hair(h, m), 1.2);
    if (parts & kJumper) d = lanes::blend(d, jumper(p), 1.0);
    return d;
  }

  // The solid that casts shadows: slightly smaller than the bust, so that flat areas do not shadow themselves.
  [[nodiscard]] T shade(const Vec3<T>& p) const {
    using namespace lanes;
    const Vec3<T> h = toHead(p);
    T d = ellipsoid(h, at(0, 8, -6), {24.5, 25, 27});
    d = min(d, ellipsoid(h, at(0, -10.5, 3), {18.5, 21, 19}));
    d = min(d, rod(h, at(0, 0, 19), at(0, -9.2, 26), 1.2, 2.4));
    d = min(d, sphere(h, at(kBun.x, kBun.y, kBun.z), 8));
    return min(d, ellipsoid(p, at(0, -84, -9), {54, 43, 22}));
  }

  [[nodiscard]] Look<T> look(const Vec3<T>& p, Parts parts) const {
    const Vec3<T> h = toHead(p);
    const Vec3<T> m = mirrored(h);
    T d = skin(p, h, m, parts);
    Look<T> look = skinLook(h, m, parts);
    if (parts & kEyes) nearest(look, d, eye(m), eyeLook(h));
    if (parts & kHair) nearest(look, d, hair(h, m), hairLook(h));
    if (parts & kJumper) nearest(look, d, jumper(p), jumperLook(p));
    return look;
  }

 private:
  // The joint that the head rotates about, in stage and in head coordinates.
  static constexpr Vec3<double> kJoint = {0, -14, -1}, kHeadJoint = {0, -18, -8};
  static constexpr Vec3<double> kBun = {0, 33.5, 2};
  static constexpr double kEyeX = 9.8, kEyeZ = 15.6, kEyeRadius = 6.8;

  [[nodiscard]] Vec3<double> toStage(const Vec3<double>& h) const {
    const Vec3<double> d = h - kHeadJoint;
    return head_axes_[0] * d.x + head_axes_[1] * d.y + head_axes_[2] * d.z + kJoint;
  }
  [[nodiscard]] Vec3<T> toHead(const Vec3<T>& p) const {
    const Vec3<T> d = p - at(kJoint.x, kJoint.y, kJoint.z);
    return Vec3<T>{dot(axis_[0], d), dot(axis_[1], d), dot(axis_[2], d)} + at(kHeadJoint.x, kHeadJoint.y, kHeadJoint.z);
  }
  // Mirrors one half of the face; rounded in the middle, where a plain mirror would leave a crease.
  [[nodiscard]] static Vec3<T> mirrored(const Vec3<T>& h) { return {lanes::sqrt(h.x * h.x + T(1.2)), h.y, h.z}; }
  [[nodiscard]] static Vec3<T> at(double x, double y, double z) { return {T(x), T(y), T(z)}; }

  [[nodiscard]] T skin(const Vec3<T>& p, const Vec3<T>& h, const Vec3<T>& m, Parts parts) const {
    using namespace lanes;
    T d = T(1e3);
    if (parts & kSkull) {
      d = ellipsoid(h, at(0, 8, -5), {25.5, 26, 28.5});
      d = blend(d, ellipsoid(h, at(0, -10.5, 3.5), {20.2, 22, 20}), 9.0);  // face
    }
    if (parts & kChin) d = blend(d, ellipsoid(h, at(0, -26.5, 13.5), {7, 6.5, 7}), 9.0);
    if (parts & kCheeks) d = blend(d, ellipsoid(m, at(10.5, -10.5, 13), {8.5, 8, 8}), 7.0);
    if (parts & kEyes) {
      d = blend(d, rod(m, at(5, 7.2, 21.6), at(15, 6.6, 16.5), 1.8, 1.6), 5.0);  // brow
      d = carve(d, ellipsoid(m, at(10, 0.2, 26.0), {7.6, 5.2, 5.2}), 5.0);       // socket
      d = blend(d, lids(m), 1.6);
    }
    if (parts & kNose) {
      d = blend(d, rod(h, at(0, 1.5, 20.5), at(0, -8.2, 25.6), 1.7, 2.5), 4.5);  // bridge
      d = blend(d, sphere(h, at(0, -9.2, 26.6), 3.1), 2.0);                      // tip
      d = blend(d, ellipsoid(m, at(3.3, -10.2, 23.6), {2.4, 2.2, 2.9}), 2.0);    // wing
    }
    if (parts & kMouth) d = lips(d, m);
    if (parts & kEars) d = blend(d, ear(m), 2.0);
    if (parts & kNeck) d = blend(d, rod(p, at(0, -26, -1), at(0, -56, -1), 10.5, 12.0), 7.0);
    return d;
  }

  [[nodiscard]] T eye(const Vec3<T>& m) const { return lanes::sphere(m, at(kEyeX, 0, kEyeZ), kEyeRadius); }

  // How far a point of the lids lies above the opening's upper edge, or below its lower edge.
  [[nodiscard]] T aboveUpperLid(const Vec3<T>& e) const {
    return e.y - e.z * (T(0.40) - T(0.72) * lid_) + e.x * e.x * T(0.03);
  }
  [[nodiscard]] T belowLowerLid(const Vec3<T>& e) const { return -e.y - e.z * T(0.42) + e.x * e.x * T(0.02); }

  [[nodiscard]] T lids(const Vec3<T>& m) const {
    const Vec3<T> e = m - at(kEyeX, 0, kEyeZ);
    return lanes::common(length(e) - T(kEyeRadius + 0.7), -lanes::max(aboveUpperLid(e), belowLowerLid(e)) * T(0.9),
                         0.5);
  }

  [[nodiscard]] static Vec3<T> smiling(const Vec3<T>& m) {
    return {m.x, m.y - m.x * m.x * T(0.031),
            m.z + m.x * m.x * T(0.032)};  // corners of the mouth raised and bent around the jaw
  }
  [[nodiscard]] static T upperLip(const Vec3<T>& s) {
    return lanes::ellipsoid(s, at(2.6, -17.2, 22.2), {4.7, 1.8, 2.3});
  }
  [[nodiscard]] static T lowerLip(const Vec3<T>& s) { return lanes::ellipsoid(s, at(0, -20.6, 21.6), {6.2, 2.2, 2.9}); }
  [[nodiscard]] static T mouthLine(const Vec3<T>& s) {
    return lanes::ellipsoid(s, at(0, -18.8, 24.1), {5.4, 0.5, 1.8});
  }
  [[nodiscard]] T lips(T face, const Vec3<T>& m) const {
    const Vec3<T> s = smiling(m);
    return lanes::carve(lanes::blend(lanes::blend(face, upperLip(s), 1.2), lowerLip(s), 1.2), mouthLine(s), 0.7);
  }

  [[nodiscard]] T ear(const Vec3<T>& m) const {
    using namespace lanes;
    const Vec3<T> e = {m.x + (m.z + T(4.0)) * T(0.8), m.y, m.z};  // the shell stands off towards its back
    const T d = ellipsoid(e, at(26.2, -3, -4), {2.6, 8.4, 5.4});
    // The shear makes the field steeper by up to 1.5.
    return carve(d, ellipsoid(e, at(29.2, -2.2, -3.4), {2.9, 5.8, 3.4}), 1.2) * T(1 / 1.5);
  }

  [[nodiscard]] T hair(const Vec3<T>& h, const Vec3<T>& m) const {
    using namespace lanes;
    const T cap = ellipsoid(h, at(0, 9.5, -6.5), {27.4, 27.5, 29.6});
    // Cut off in front of a plane that leans back from the forehead to behind the ears.
    const T front = h.z * T(0.72) - (h.y - T(18.0)) * T(0.69) + m.x * T(0.08) - T(11.0);
    return blend(common(cap, front, 2.4), ellipsoid(h, at(kBun.x, kBun.y, kBun.z), {9.5, 8.5, 9.5}), 2.0);  // and a bun
  }

  [[nodiscard]] T jumper(const Vec3<T>& p) const {
    using namespace lanes;
    const Vec3<T> m = mirrored(p);
    T d = ellipsoid(p, at(0, -78, -4), {56, 40, 26});
    d = blend(d, rod(m, at(13, -50, -3), at(56, -62, -6), 13.0, 15.0), 12.0);
    const T ring = sqrt(p.x * p.x + p.z * p.z) - T(14.0);  // a rolled collar
    const T height = p.y + T(39.0) + p.z * T(0.15);
    return blend(d, sqrt(ring * ring + height * height) - T(4.4), 3.0);
  }

  [[nodiscard]] Look<T> skinLook(const Vec3<T>& h, const Vec3<T>& m, Parts parts) const {
    using namespace lanes;
    Look<T> look = plain<T>(0.80, 0.50, 0.36, 0.22, 1.0);
    paint(look, T(0.45) * (T(1.0) - smoothStep(length(m - at(13, -8.5, 17)), 1.0, 9.0)), 0.86, 0.30, 0.24);  // blush
    paint(look, T(0.35) * (T(1.0) - smoothStep(length(h - at(0, -9.5, 29)), 1.0, 6.0)), 0.86, 0.34, 0.26);
    if (parts & kEars) paint(look, T(0.40) * smoothStep(m.x, 22.5, 25.5), 0.86, 0.32, 0.24);
    const T front = smoothStep(h.z, 13, 15);
    if (parts & kMouth) {
      const Vec3<T> s = smiling(m);
      paint(look, front * (T(1.0) - smoothStep(min(upperLip(s), lowerLip(s)), 0.05, 0.5)), 0.66, 0.15, 0.15);
      paint(look, front * (T(1.0) - smoothStep(mouthLine(s), 0.0, 0.5)), 0.22, 0.03, 0.03);
    }
    const T nostril = length((m - at(2.0, -11.9, 25.2)) * at(1.0, 1.3, 0.5));
    if (parts & kNose) paint(look, T(0.75) * (T(1.0) - smoothStep(nostril, 0.5, 1.3)), 0.30, 0.07, 0.05);
    if (!(parts & kEyes)) return look;
    // A brow: a stroke that thins outwards, in the plane of the face.
    const T along = clamp<T>((m.x - T(4.6)) / T(11.0), T(0.0), T(1.0));
    const T arch = m.y - T(8.3) - along * (T(1.0) - along) * T(4.2) - along * T(0.1);
    const T beyond = max(abs(m.x - T(10.1)) - T(5.5), T(0.0));
    const T stroke = sqrt(arch * arch + beyond * beyond) + along * T(0.7);
    paint(look, front * (T(1.0) - smoothStep(stroke, 0.9, 1.7)) * T(0.9), 0.10, 0.05, 0.03);
    // Lashes along the edge of the upper lid.
    const Vec3<T> e = m - at(kEyeX, 0, kEyeZ);
    const T on_lid = T(1.0) - smoothStep(abs(length(e) - T(kEyeRadius + 0.7)), 0.5, 0.9);
    const T edge = aboveUpperLid(e);
    const T lash = smoothStep(edge, -0.6, 0.0) * (T(1.0) - smoothStep(edge, 0.5, 1.1));
    paint(look, on_lid * front * lash, 0.05, 0.02, 0.02);
    return look;
  }

  [[nodiscard]] Look<T> eyeLook(const Vec3<T>& h) const {
    using namespace lanes;
    const T side = select(h.x > T(0.0), T(1.0), T(-1.0));
    const Vec3<T> e = (h - Vec3<T>{side * T(kEyeX), T(0.0), T(kEyeZ)}) * T(1.0 / kEyeRadius);
    const Vec3<T> off = e - gaze_;
    const T r = sqrt(dot(off, off));
    Look<T> look = plain<T>(0.82, 0.80, 0.78, 1.6);
    paint(look, T(1.0) - smoothStep(r, 0.44, 0.50), 0.03, 0.06, 0.05);
    const T rays = T(0.75) + T(0.25) * sine(off.x * T(31.0)) * sine(off.y * T(29.0) + T(1.0));
    Look<T> iris = plain<T>(0.10, 0.26, 0.20, 1.6);
    iris.albedo = iris.albedo * (rays * (T(0.6) + r * T(1.6)));
    look.albedo = mix(look.albedo, iris.albedo, T(1.0) - smoothStep(r, 0.36, 0.44));
    paint(look, T(1.0) - smoothStep(r, 0.17, 0.21), 0.005, 0.005, 0.005);
    const T lid = aboveUpperLid(e * T(kEyeRadius));  // the lid and its lashes cast a shadow
    look.albedo = look.albedo * (T(1.0) - T(0.55) * smoothStep(lid, -2.0, 0.0));
    // The lamp's reflection in the eye: where the surface faces half way between lamp and viewer.
    const Vec3<T> half = at(-0.26, 0.32, 0.91);
    const Vec3<T> glint = e - Vec3<T>{dot(axis_[0], half), dot(axis_[1], half), dot(axis_[2], half)};
    paint(look, T(1.0) - smoothStep(length(glint), 0.09, 0.15), 1.6, 1.6, 1.6);
    return look;
  }

  [[nodiscard]] Look<T> hairLook(const Vec3<T>& h) const {
    using namespace lanes;
    // Combed up to the bun: strands run along meridians of an axis through it.
    const T around = h.x / (abs(h.z + T(10.0)) + abs(h.x) + T(4.0));
    const T strands =
        sine(around * T(70.0)) + sine(around * T(113.0) + h.y * T(0.12)) + sine(around * T(171.0) - h.y * T(0.2));
    Look<T> look = plain<T>(0.115, 0.050, 0.026, 0.55);
    look.albedo = look.albedo * (T(1.0) + strands * T(0.16));
    return look;
  }

  [[nodiscard]] Look<T> jumperLook(const Vec3<T>& p) const {
    using namespace lanes;
    // Rows of stitches: zig-zags across, ribs down.
    const T stitch = sine(p.x * T(3.6)) * sine(p.y * T(2.4) + abs(sine(p.x * T(1.8))) * T(2.0));
    Look<T> look = plain<T>(0.62, 0.31, 0.045, 0.05);
    paint(look, smoothStep(sine(p.y * T(0.78) + T(0.5)), 0.80, 0.90) * smoothStep(-p.y, 50, 51), 0.70, 0.64, 0.52);
    look.albedo = look.albedo * (T(0.86) + stitch * T(0.14));
    return look;
  }

  Vec3<double> head_axes_[3];
  Vec3<T> axis_[3];
  Vec3<T> gaze_;
  T lid_;
};

}  // namespace relievo::sample
