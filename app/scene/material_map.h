// SPDX-License-Identifier: Apache-2.0
// The material at each place of the surface: a view of a picture of the film's material track.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "app/scene/display_volume.h"
#include "hal/media/frame.h"
#include "platform/error.h"
#include "platform/realtime.h"

namespace relievo {

// Brightness (Y) is stiffness, the blue difference (U) friction, the red one (V) texture: each a share, from code 0 to
// the full code, of what the track's tag kMaterialScaleTag says (app/scene/material.h). The picture fills the volume's
// front, whatever its size. Keeps a reference to the picture: nothing is copied.
class MaterialMap {
 public:
  struct Shares {
    double stiffness = 0, friction = 0, texture = 0;  // 0 to 1
  };

  // Unsupported unless the picture is YUV of 8 bits.
  [[nodiscard]] static Result<MaterialMap> make(const Frame& picture, const DisplayVolume& volume) noexcept;

  // Interpolates linearly between the samples and repeats the border samples. Positions in mm of the scene, finite.
  [[nodiscard]] Shares at(double x_mm, double y_mm) const RELIEVO_RT;

 private:
  struct Layer {
    const std::uint8_t* data = nullptr;
    std::ptrdiff_t stride = 0, step = 1;
    int cols = 1, rows = 1;
    GridMapping grid;
    double scale = 1.0 / 255, offset = 0;  // share = offset + scale x code

    [[nodiscard]] double at(double x_mm, double y_mm) const RELIEVO_RT;
  };
  std::array<Layer, 3> layers_;
  Frame picture_;
};

}  // namespace relievo
