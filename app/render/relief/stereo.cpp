// SPDX-License-Identifier: Apache-2.0
// Positions of the eyes, their view windows, and their areas of the surface.
#include "app/render/relief/stereo.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace relievo {
namespace {

// Parts outside the volume, such as a force arrow, are drawn down to this depth below it and, in front, up to a tenth
// of the viewing distance before the eyes.
constexpr double kBelowMm = 100.0;
constexpr double kNearestOfDistance = 0.1;

// HDMI 1.4a, frame packing of 1080p and 720p: two pictures, one above the other, separated by the lines of a blanking
// interval. Some cards take the two side by side and pack them.
struct Packed {
  int width, height;  // of a picture
  int gap;
};
constexpr Packed kPacked[] = {{1920, 1080, 45}, {1280, 720, 30}};

constexpr int kLeastTilePixels = 16;

struct Window {
  double half_width_mm;
  double half_height_mm;
};

Window letterbox(const DisplayVolume& volume, double aspect, const StereoSettings& settings) noexcept {
  const double picture_aspect = settings.stretch * volume.width_mm / volume.height_mm;
  const double width = volume.width_mm * std::max(1.0, aspect / picture_aspect) / settings.zoom;
  return {0.5 * width, 0.5 * width * settings.stretch / aspect};
}

// An eye at (eye_x, 0, screen_z + distance), looking straight at the screen plane. The sides of the frustum pass
// through the window there; glm wants them on the near plane, scaled by near/distance.
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

// Both eyes' areas of such a surface; none of another.
std::vector<PixelArea> packedAreas(int width, int height) {
  for (const Packed& each : kPacked) {
    if (width == each.width && height == 2 * each.height + each.gap) {
      return {{0, height - each.height, width, each.height}, {0, 0, width, each.height}};
    }
    if (width == 2 * each.width && height == each.height) {
      return {{0, 0, each.width, height}, {each.width, 0, each.width, height}};
    }
  }
  return {};
}

// Part `index` of `count` equal parts of a length; together they cover it exactly.
struct Part {
  int first, length;
};
Part partOf(int whole, int index, int count) noexcept {
  const int first = whole * index / count;
  return {first, whole * (index + 1) / count - first};
}

std::vector<PixelArea> areasOf(const StereoSettings& settings, int width, int height) {
  const PixelArea whole{0, 0, width, height};
  switch (settings.layout) {
    case StereoLayout::Mono:
      return {whole};
    case StereoLayout::SideBySide: {
      const Part left = partOf(width, 0, 2), right = partOf(width, 1, 2);
      return {{left.first, 0, left.length, height}, {right.first, 0, right.length, height}};
    }
    case StereoLayout::TopBottom: {
      const Part low = partOf(height, 0, 2), top = partOf(height, 1, 2);
      return {{0, top.first, width, top.length}, {0, low.first, width, low.length}};
    }
    case StereoLayout::FramePacking: {
      auto eyes = packedAreas(width, height);
      return eyes.empty() ? std::vector{whole, whole} : eyes;
    }
    case StereoLayout::Quilt: {
      std::vector<PixelArea> tiles;
      for (int r = 0; r < settings.quilt_rows; ++r) {
        for (int c = 0; c < settings.quilt_cols; ++c) {
          const Part across = partOf(width, c, settings.quilt_cols), up = partOf(height, r, settings.quilt_rows);
          tiles.push_back({across.first, up.first, across.length, up.length});
        }
      }
      return tiles;
    }
    case StereoLayout::Rows:
    case StereoLayout::Columns:
    case StereoLayout::Anaglyph:
      return {whole, whole};
  }
  return {whole};
}

// The aspect ratio that the viewer sees: a squeezed half is displayed as wide as the whole, and each tile of a quilt is
// stretched over the panel.
double aspectOf(const StereoSettings& settings, const PixelArea& area, int width, int height) noexcept {
  const bool halves = settings.layout == StereoLayout::SideBySide || settings.layout == StereoLayout::TopBottom;
  const bool own = (halves && settings.full) || settings.layout == StereoLayout::FramePacking;
  return own ? static_cast<double>(area.width) / area.height : static_cast<double>(width) / height;
}

int marginOf(int pixels, double picture_mm, double window_mm) noexcept {
  return static_cast<int>(std::lround(0.5 * pixels * (1 - picture_mm / window_mm)));
}

}  // namespace

const char* name(StereoLayout layout) noexcept {
  switch (layout) {
    case StereoLayout::Mono:
      return "mono";
    case StereoLayout::SideBySide:
      return "sbs";
    case StereoLayout::TopBottom:
      return "tab";
    case StereoLayout::Rows:
      return "rows";
    case StereoLayout::Columns:
      return "columns";
    case StereoLayout::Anaglyph:
      return "anaglyph";
    case StereoLayout::FramePacking:
      return "frame-packing";
    case StereoLayout::Quilt:
      return "quilt";
  }
  return "";
}

EyeViews eyeViews(const StereoSettings& settings, const DisplayVolume& volume, int width, int height) {
  EyeViews result;
  result.mixed = settings.layout == StereoLayout::Rows || settings.layout == StereoLayout::Columns ||
                 settings.layout == StereoLayout::Anaglyph;
  const std::vector<PixelArea> areas = areasOf(settings, width, height);
  const double between = (settings.swap_eyes ? -1 : 1) * settings.strength * settings.eye_distance_mm;
  // A lenticular panel is viewed within a cone: the outermost views are four eye distances apart, 24 degrees.
  const double spread = settings.layout == StereoLayout::Quilt ? 4.0 * between : between;
  const auto last = static_cast<double>(areas.size() - 1);
  for (std::size_t i = 0; i < areas.size(); ++i) {
    result.aspect = aspectOf(settings, areas[i], width, height);
    const Window window = letterbox(volume, result.aspect, settings);
    const double eye_x = last > 0 ? spread * (static_cast<double>(i) / last - 0.5) : 0.0;
    result.views.push_back(
        {offAxis(eye_x, window, settings), areas[i], eye_x, window.half_width_mm, window.half_height_mm});
    result.pixels_per_mm = areas[i].width / (2 * window.half_width_mm);
    result.margin_x = marginOf(areas[i].width, volume.width_mm, 2 * window.half_width_mm);
    result.margin_y = marginOf(areas[i].height, volume.height_mm, 2 * window.half_height_mm);
  }
  return result;
}

SceneViews sceneViews(const StereoSettings& settings, const DisplayVolume& volume, int width, int height) {
  SceneViews result{.views = {},
                    .screen_z_mm = settings.screen_z_mm,
                    .viewing_distance_mm = settings.viewing_distance_mm,
                    .depth_mm = volume.depth_mm};
  const EyeViews eyes = eyeViews(settings, volume, width, height);
  for (const EyeView& view : eyes.views) {
    const PixelArea& area = view.area;
    result.views.push_back({.left = static_cast<double>(area.x) / width,
                            .top = 1 - static_cast<double>(area.y + area.height) / height,
                            .right = static_cast<double>(area.x + area.width) / width,
                            .bottom = 1 - static_cast<double>(area.y) / height,
                            .eye_x_mm = eyes.mixed ? 0 : view.eye_x_mm,
                            .half_width_mm = view.half_width_mm,
                            .half_height_mm = view.half_height_mm});
    if (eyes.mixed) break;  // both cover the whole surface
  }
  return result;
}

const char* refusal(const StereoSettings& settings, int width, int height) noexcept {
  switch (settings.layout) {
    case StereoLayout::FramePacking:
      if (!packedAreas(width, height).empty()) return nullptr;
      return "frame packing needs a surface of 1920x2205 or 1280x1470, or of both eyes side by side in full; choose "
             "such "
             "a screen mode";
    case StereoLayout::Quilt:
      if (settings.quilt_cols > 0 && settings.quilt_rows > 0 && width / settings.quilt_cols >= kLeastTilePixels &&
          height / settings.quilt_rows >= kLeastTilePixels) {
        return nullptr;
      }
      return "the surface is too small for so many views; ask for fewer of them or for a larger surface";
    default:
      if (width > 1 && height > 1) return nullptr;
      return settings.layout == StereoLayout::Mono ? nullptr : "two eyes do not fit on one pixel";
  }
}

// The derivative of e h / (d - h) is e d / (d - h)^2, largest at the nearest point. With no distance between the eyes,
// the similar shift against the picture's edge is used instead.
double heightOfPixelMm(const StereoSettings& settings, const DisplayVolume& volume, double pixels_per_mm) noexcept {
  constexpr double kLeastEyes = 63.0;
  const double eyes = std::max(kLeastEyes, std::abs(settings.strength * settings.eye_distance_mm));
  const double distance = settings.viewing_distance_mm;
  const double left = std::max(distance - (volume.depth_mm - settings.screen_z_mm), kNearestOfDistance * distance);
  return left * left / (eyes * distance * pixels_per_mm);
}

}  // namespace relievo
