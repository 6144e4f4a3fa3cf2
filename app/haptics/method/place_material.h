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

// What the last `read` has found; before the first, and without a track, the whole film's. Reads two pictures, the
// present one and the next of its shot, and mixes them by the time. `read` may be called for the next tick, while this
// one's force is out; that saves the tick the reading.
class MaterialReader {
 public:
  MaterialReader(const PlaceMaterial& whole, const HeldScale& scale) noexcept;

  // Whether places differ.
  [[nodiscard]] bool exists() const RELIEVO_RT { return exists_; }
  [[nodiscard]] const PlaceMaterial& found() const RELIEVO_RT { return found_; }
  // The place and the moment are so near to those of the last `read` that another would find the same.
  [[nodiscard]] bool isNear(MediaTime now, double x_mm, double y_mm) const RELIEVO_RT;
  void read(const SurfaceWindow& window, MediaTime now, double x_mm, double y_mm) RELIEVO_RT;

 private:
  [[nodiscard]] PlaceMaterial madeOf(const MaterialMap::Shares& shares) const RELIEVO_RT;

  PlaceMaterial whole_, found_;
  struct Scale {
    double stiffness = 0;  // here and below: less than 0 if the track has no such part
    double most_stiffness = 0;
    double still = 0, moving = 0;
    double amplitude = 0, most_ripple_n = 0;
  };
  Scale scale_;
  bool exists_;
  MediaTime read_for_;
  double x_mm_ = std::numeric_limits<double>::infinity(), y_mm_ = 0;
};

// The spring between finger and surface where the stiffness changes on the way. A stiffer place would give a finger
// that came in at a softer one more than it has put in: F = k d is a spring only while k stands still. So what the
// spring stores stays the same when k changes, and the spring is shorter than the finger's depth d where it does not
// suffice for k d^2/2; what a softer place stores less is kept for the next stiffer one. On the way from k1 to k2 > k1
// the force rises by sqrt(k2/k1); from then on it grows by k2 for each mm.
class PlaceSpring {
 public:
  // The share of `depth_mm`, from the finger to the spring's end, by which the spring is stretched, 0 to 1.
  [[nodiscard]] double share(double depth_mm, double stiffness_n_per_mm) RELIEVO_RT;
  // Contact begins anew, with at most this force at first.
  void release(double most_n = std::numeric_limits<double>::infinity()) RELIEVO_RT {
    holds_ = false;
    most_n_ = most_n;
  }

 private:
  bool holds_ = false;
  double most_n_ = std::numeric_limits<double>::infinity();
  double depth_mm_ = 0, length_mm_ = 0, stiffness_ = 0;
  double owned_mj_ = 0;  // what the finger has put in and not been given back
};

}  // namespace relievo
