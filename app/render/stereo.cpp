// SPDX-License-Identifier: Apache-2.0
// Where the eyes stand and through which window they look.
#include "app/render/stereo.h"

#include <algorithm>
#include <cstddef>
#include <glm/gtc/matrix_transform.hpp>

namespace relievo {
namespace {

// What stands out of the volume, a force arrow for instance, is still drawn this far below and, in front, up to a tenth
// of the way before the eyes.
constexpr double kBelowMm = 100.0;
constexpr double kNearestOfDistance = 0.1;

struct Window {
  double half_width_mm;
  double half_height_mm;
};

Window letterbox(const DisplayVolume& volume, double surface_aspect) noexcept {
  const double picture_aspect = volume.width_mm / volume.height_mm;
  const double width = volume.width_mm * std::max(1.0, surface_aspect / picture_aspect);
  return {0.5 * width, 0.5 * width / surface_aspect};
}

// An eye at (eye_x, 0, screen_z + distance), looking straight down on the screen plane. The frustum's sides pass
// through the window there; glm wants them on the near plane, where they are smaller by near/distance.
glm::dmat4 offAxis(double eye_x_mm, const Window& window, const StereoSettings& settings) {
  const double distance = settings.viewing_distance_mm;
  const double nearest = kNearestOfDistance * distance;
  const double farthest = distance + std::max(settings.screen_z_mm, 0.0) + kBelowMm;
  const double scale = nearest / distance;
  const glm::dmat4 projection =
      glm::frustum(scale * (-window.half_width_mm - eye_x_mm), scale * (window.half_width_mm - eye_x_mm),
                   -scale * window.half_height_mm, scale * window.half_height_mm, nearest, farthest);
  return glm::translate(projection, glm::dvec3(-eye_x_mm, 0.0, -(settings.screen_z_mm + distance)));
}

}  // namespace

const char* name(StereoLayout layout) noexcept {
  switch (layout) {
    case StereoLayout::Mono:
      return "mono";
    case StereoLayout::SideBySide:
      return "sbs";
    case StereoLayout::Anaglyph:
      return "anaglyph";
  }
  return "";
}

EyeViews eyeViews(const StereoSettings& settings, const DisplayVolume& volume, double surface_aspect) {
  const Window window = letterbox(volume, surface_aspect);
  EyeViews result;
  if (settings.layout == StereoLayout::Mono) {
    result.views[0].view_projection = offAxis(0.0, window, settings);
    return result;
  }
  result.count = 2;
  const double left_eye_mm = (settings.swap_eyes ? 0.5 : -0.5) * settings.eye_distance_mm;
  for (std::size_t i = 0; i < 2; ++i) {
    EyeView& view = result.views[i];
    view.view_projection = offAxis(i == 0 ? left_eye_mm : -left_eye_mm, window, settings);
    if (settings.layout == StereoLayout::SideBySide) {
      view.x = 0.5 * static_cast<double>(i);
      view.width = 0.5;
    } else {
      view.channels = i == 0 ? std::array{true, false, false} : std::array{false, true, true};
    }
  }
  return result;
}

}  // namespace relievo
