// SPDX-License-Identifier: Apache-2.0
// Caches the triangles of the present picture for the requested detail.
#pragma once

#include <optional>

#include "app/render/relief/moving_average.h"
#include "app/render/relief/relief_triangles.h"
#include "app/scene/display_volume.h"
#include "app/scene/height_field.h"
#include "platform/clock.h"

namespace relievo {

class MadeRelief {
 public:
  // Call for another picture: its triangles have to be made.
  void forgetPicture() noexcept { made_for_.reset(); }
  // Makes the triangles unless those of this picture and detail exist. True if they differ from those of the last call;
  // a picture with the same samples may have the same.
  bool make(const HeightField& field, const DisplayVolume& volume, const ReliefDetail& wanted);

  [[nodiscard]] const ReliefTriangles& triangles() const noexcept { return triangles_; }
  [[nodiscard]] Duration making() const noexcept { return making_.value(); }  // time to make one picture's

 private:
  ReliefTriangles triangles_;
  std::optional<ReliefDetail> made_for_;
  MovingAverage making_;
  MonotonicClock clock_;
};

}  // namespace relievo
