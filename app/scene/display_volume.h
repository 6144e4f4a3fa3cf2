// SPDX-License-Identifier: Apache-2.0
// The box in front of the viewer that the film occupies, and the position of pixels in it.
#pragma once

namespace relievo {

// Scene frame, mm, right-handed: x right, y up, z toward the viewer, origin at the centre of the far plane.
struct DisplayVolume {
  static constexpr double kDefaultWidthMm = 160.0;
  static constexpr double kDefaultDepthMm = 40.0;

  double width_mm = kDefaultWidthMm;
  double height_mm = 108.0;
  double depth_mm = kDefaultDepthMm;

  // The default width and depth, and the height that keeps the picture's aspect ratio.
  [[nodiscard]] static constexpr DisplayVolume forPicture(int cols, int rows, double sample_aspect = 1.0) noexcept {
    return {kDefaultWidthMm, kDefaultWidthMm * rows / (cols * sample_aspect), kDefaultDepthMm};
  }
};

// Depth pixel (c, r) of a cols x rows image lies at x = ((c + 1/2)/cols - 1/2) W, y = (1/2 - (r + 1/2)/rows) H. This
// maps between scene millimetres and grid units, in which sample (c, r) is at u = c, v = r.
struct GridMapping {
  double u_per_mm = 1, u_origin = 0;   // u = u_origin + u_per_mm x
  double v_per_mm = -1, v_origin = 0;  // v = v_origin + v_per_mm y, v_per_mm < 0: rows go down

  GridMapping() = default;
  bool operator==(const GridMapping&) const = default;
  constexpr GridMapping(const DisplayVolume& volume, int cols, int rows) noexcept
      : u_per_mm(cols / volume.width_mm),
        u_origin(0.5 * cols - 0.5),
        v_per_mm(-rows / volume.height_mm),
        v_origin(0.5 * rows - 0.5) {}

  [[nodiscard]] constexpr double u(double x_mm) const noexcept { return u_origin + u_per_mm * x_mm; }
  [[nodiscard]] constexpr double v(double y_mm) const noexcept { return v_origin + v_per_mm * y_mm; }
  [[nodiscard]] constexpr double x(double u) const noexcept { return (u - u_origin) / u_per_mm; }
  [[nodiscard]] constexpr double y(double v) const noexcept { return (v - v_origin) / v_per_mm; }
};

}  // namespace relievo
