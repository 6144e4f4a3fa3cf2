// SPDX-License-Identifier: Apache-2.0
// A scene generated from a seed: a moving relief with faulty pictures, and a finger that moves in it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "app/depth_window/surface_window.h"
#include "app/scene/display_volume.h"

namespace relievo {

// Steele, Lea and Flood 2014: any whole number is a seed, and neighbouring seeds are independent.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15 + 1) {}
  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }
  double within(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  bool chance(double p) { return within(0, 1) < p; }
  int below(int n) { return static_cast<int>(bits() % static_cast<unsigned>(n)); }

 private:
  std::uint64_t state_;
};

// Waves, steps, noise, holes, spikes; scene changes, and pictures that stand still for a while.
class RandomFilm {
 public:
  explicit RandomFilm(Random& random);

  [[nodiscard]] const DisplayVolume& volume() const { return volume_; }
  [[nodiscard]] double periodS() const { return period_s_; }
  // A cut: another scene, while the finger continues.
  void newScene();
  [[nodiscard]] TimedSurface next(double t_s);

 private:
  struct Wave {
    double size, kx, ky, phase, rate;
  };
  [[nodiscard]] double height(double x, double y, double t_s);
  void draw(double t_s);

  Random& random_;
  int cols_, rows_, bits_;
  DisplayVolume volume_;
  double period_s_;
  std::array<Wave, 2> waves_{};
  double level_ = 20, slope_x_ = 0, slope_y_ = 0, speed_ = 0, noise_ = 0, holes_ = 0, spikes_ = 0;
  bool block_ = false, white_ = false;
  int still_ = 0;  // number of coming frames that repeat the last one
  std::vector<std::uint8_t> picture_;
};

// Rests, strokes, darts, presses into the surface, and sometimes leaves the picture. Some devices have a new position
// only in every second or third tick.
class RandomFinger {
 public:
  RandomFinger(Random& random, const DisplayVolume& volume)
      : random_(random),
        volume_(volume),
        at_(0, 0, random.chance(0.9) ? 62 : random.within(0, 40)),
        ticks_of_reading_(random.chance(0.3) ? 2 + random.below(2) : 1) {}

  [[nodiscard]] glm::dvec3 next(double tick_s);

 private:
  Random& random_;
  DisplayVolume volume_;
  glm::dvec3 at_, target_{0}, reading_{0};
  double speed_ = 0;
  int left_ = 0, tick_ = 0, ticks_of_reading_;
};

}  // namespace relievo
