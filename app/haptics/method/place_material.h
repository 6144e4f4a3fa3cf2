// SPDX-License-Identifier: Apache-2.0
// The material where the proxy is: the film's material track, or the whole film's material.
#pragma once

#include <limits>

#include "app/depth_window/surface_window.h"
#include "app/scene/material.h"
#include "hal/media/media_time.h"
#include "platform/realtime.h"

namespace relievo {

struct PlaceMaterial {
  double stiffness_n_per_mm = 0.5;
  Friction friction;
  double amplitude_mm = 0;  // of the texture
};

// The material that the last `read` has found; before the first, and without a track, the whole film's. Interpolates in
// time between two pictures, the present one and the next of its shot. `read` may be called for the next tick after
// this tick's force was sent, which saves the next tick the reading.
class MaterialReader {
 public:
  MaterialReader(const PlaceMaterial& whole, const HeldScale& scale) noexcept;

  // True if the film has a material track.
  [[nodiscard]] bool exists() const RELIEVO_RT { return exists_; }
  [[nodiscard]] const PlaceMaterial& found() const RELIEVO_RT { return found_; }
  // True if place and moment are so near to those of the last `read` that another would find the same.
  [[nodiscard]] bool isNear(MediaTime now, double x_mm, double y_mm) const RELIEVO_RT;
  void read(const SurfaceWindow& window, MediaTime now, double x_mm, double y_mm) RELIEVO_RT;

 private:
  [[nodiscard]] PlaceMaterial madeOf(const MaterialMap::Shares& shares) const RELIEVO_RT;

  PlaceMaterial whole_, found_;
  struct Scale {
    double stiffness = 0;  // here and below: negative if the track has no such part
    double most_stiffness = 0;
    double still = 0, moving = 0;
    double amplitude = 0, most_ripple_n = 0;
  };
  Scale scale_;
  bool exists_;
  MediaTime read_for_;
  double x_mm_ = std::numeric_limits<double>::infinity(), y_mm_ = 0;
};

// The spring between finger and surface where the stiffness changes on the way. F = k d is a conservative spring only
// while k is constant: a finger that enters at a softer place would get more energy from a stiffer one than it has put
// in. So the stored energy is kept when k changes, and the spring is shorter than the finger's depth d if it does not
// suffice for k d^2/2. What a softer place stores less is kept for the next stiffer one. On the way from k1 to k2 > k1
// the force rises by sqrt(k2/k1); from then on it grows by k2 for each mm.
class PlaceSpring {
 public:
  // The share of `depth_mm`, from the finger to the spring's end, by which the spring is stretched, 0 to 1.
  [[nodiscard]] double share(double depth_mm, double stiffness_n_per_mm) RELIEVO_RT;
  // Call when contact begins anew, with a force of at most `most_n`.
  void release(double most_n = std::numeric_limits<double>::infinity()) RELIEVO_RT {
    holds_ = false;
    most_n_ = most_n;
  }

 private:
  bool holds_ = false;
  double most_n_ = std::numeric_limits<double>::infinity();
  double depth_mm_ = 0, length_mm_ = 0, stiffness_ = 0;
  double owned_mj_ = 0;  // energy that the finger has put in and not got back
};

}  // namespace relievo
