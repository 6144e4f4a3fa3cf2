// SPDX-License-Identifier: Apache-2.0
// The two scenes of the sample film as solids at one moment, and the intersection with a line of sight.
#pragma once

#include "app/author/sample/sample_bust.h"
#include "app/author/sample/sample_hand.h"
#include "app/author/sample/sample_room.h"
#include "app/author/sample/sample_still_life.h"

namespace relievo::sample {

// The stage is 64 mm deep and is compressed into the 40 mm of the display volume, as in a low relief: lighting uses the
// full shape, the finger feels the relief.
constexpr double kStageDepthMm = 64.0;
constexpr double kReliefMmPerStageMm = 40.0 / kStageDepthMm;

[[nodiscard]] HeadPose headPose(double t_s) noexcept;
[[nodiscard]] HandPose handPose(double t_s) noexcept;
[[nodiscard]] bool handIsIn(double t_s) noexcept;  // whether the hand or its shadow is in the picture

// A head in front of a wall; a hand passes in front of both.
template <class T>
class Portrait {
 public:
  static constexpr double kFront = kStageDepthMm;
  [[nodiscard]] double front() const { return hand_is_in_ ? kFront : Bust<T>::kFront; }
  explicit Portrait(double t_s) : bust_(headPose(t_s)), hand_(handPose(t_s)), hand_is_in_(handIsIn(t_s)) {}

  [[nodiscard]] Parts partsNear(const Box2& piece) const {
    return bust_.partsNear(piece) | (hand_is_in_ ? hand_.partsNear(piece) : 0);
  }
  [[nodiscard]] T ground(T x, T y) const { return room_.height(x, y); }
  [[nodiscard]] T solids(const Vec3<T>& p, Parts parts) const {
    T d = T(1e3);
    if (parts & kBustParts) d = bust_.distance(p, parts);
    if (hand_is_in_ && (parts & kHandParts)) d = lanes::min(d, hand_.distance(p, parts));
    return d;
  }
  [[nodiscard]] T shade(const Vec3<T>& p) const {
    const T d = bust_.shade(p);
    return hand_is_in_ ? lanes::min(d, hand_.shade(p)) : d;
  }
  [[nodiscard]] Look<T> solidLook(const Vec3<T>& p, Parts parts) const {
    if (!(parts & kHandParts)) return bust_.look(p, parts);
    Look<T> look = hand_.look(p, parts);
    T d = hand_.distance(p, parts);
    if (parts & kBustParts) nearest(look, d, bust_.distance(p, parts), bust_.look(p, parts));
    return look;
  }
  [[nodiscard]] Look<T> groundLook(T x, T y) const { return room_.look(x, y); }

 private:
  static constexpr Parts kBustParts = Bust<T>::kBustParts, kHandParts = Hand<T>::kHandParts;
  Bust<T> bust_;
  Hand<T> hand_;
  Room<T> room_;
  bool hand_is_in_;
};

// Marches a line of sight down from `z` until it is within `close` of a solid or below the ground.
template <class T, class Scene>
[[nodiscard]] T march(const Scene& scene, T x, T y, T z, T ground, T close, Parts parts) {
  constexpr int kMaxSteps = 100'000;  // a grazing line needs many
  for (int i = 0; i < kMaxSteps; ++i) {
    const T d = scene.solids({x, y, z}, parts);
    const auto open = (d > close) & (z > ground);
    if (!lanes::any(open)) break;
    z = lanes::select(open, z - d * T(0.9), z);
  }
  return z;
}

constexpr double kCloseMm = 1e-3;  // closer than this the field is nearly linear

// The same in fewer steps: extrapolates the last two values linearly, by at most `kTrust` beyond the safe step, and
// steps back after overshooting. Nothing in the film is thinner than that.
template <class T, class Scene>
[[nodiscard]] T descend(const Scene& scene, T x, T y, T z, T ground, Parts parts) {
  constexpr int kMaxSteps = 60;
  constexpr double kTrust = 0.25;
  T d = scene.solids({x, y, z}, parts);
  T per_mm = T(1.0);  // step down per millimetre of distance
  for (int i = 0; i < kMaxSteps; ++i) {
    const auto open = (lanes::abs(d) > T(kCloseMm)) & ((z > ground) | (d < T(0.0)));
    if (!lanes::any(open)) break;
    const T safe = d * T(0.9);
    const T step = lanes::select(open, lanes::clamp<T>(d * per_mm, safe - T(kTrust), safe + T(kTrust)), T(0.0));
    z = z - step;
    const T next = scene.solids({x, y, z}, parts);
    const T fall = d - next;
    // A grazing line, or one past its nearest point, hardly approaches or not at all: take the longest step.
    const auto falls = fall * step > T(0.02) * step * step;
    per_mm = lanes::select(falls, step / lanes::select(falls, fall, T(1.0)), T(50.0));
    d = next;
  }
  return lanes::select(d > T(2 * kCloseMm), ground, z);
}

// One Newton step down the line of sight, for a field of value `here` that changes by `slope` per millimetre. A grazing
// line has no root nearby and stays where it is.
template <class T>
[[nodiscard]] T polished(T z, T here, T slope) {
  const auto steep = slope > T(0.02);
  return z - lanes::select(steep, here / lanes::select(steep, slope, T(1.0)), T(0.0));
}

}  // namespace relievo::sample
