// SPDX-License-Identifier: Apache-2.0
// A finger in the picture, with its shadow and the glow of its contact on the relief.
#pragma once

#include <glm/mat4x4.hpp>

#include "app/render/gl/finger_model.h"
#include "app/render/gl/surface_mark.h"
#include "app/scene/height_field.h"
#include "platform/error.h"

namespace relievo {

class FingerScene {
 public:
  [[nodiscard]] static Result<FingerScene> create();

  // `field` must be the relief that is in the depth buffer; null: there is none, and so neither shadow nor glow.
  void draw(const glm::dmat4& view_projection, const HeightField* field, const FingerMark& mark,
            const FingerPaint& paint);

 private:
  SurfaceMark on_surface_;
  FingerModel finger_;
};

}  // namespace relievo
