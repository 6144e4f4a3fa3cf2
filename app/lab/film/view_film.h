// SPDX-License-Identifier: Apache-2.0
// Renders a stereo film of a textured true surface, and converts a matcher's disparities in it to depth.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "app/lab/truth/true_surface.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

struct ViewFilmFormat {
  int cols = 640;  // of a view, even; its rows follow from the volume's shape
  double frames_per_s = 30;
  double reach = 0.028;         // disparity from the far plane to the near one, in widths of a view
  bool rich = true;             // else few, faint and soft marks
  std::optional<int> crf = 18;  // of H.264, both views side by side; none: as rendered

  static constexpr double kBehind = 1.0 / 3;  // of the reach: the far plane lies behind the screen

  [[nodiscard]] int rows() const;
  // The disparity of a height, in widths of a view, and its inverse.
  [[nodiscard]] double disparityOf(double height_mm) const;
  [[nodiscard]] double heightOf(double disparity) const;
};

// 4:2:0 pictures; the right view is rendered with the exact disparity of each pixel. Each eye's camera has a noise of
// its own, which changes from picture to picture. The texture is fixed to the left view, so it moves with the surface
// only if that moves straight toward the viewer.
struct ViewFilm {
  std::vector<Frame> left, right;

  [[nodiscard]] static Result<ViewFilm> make(const TrueSurface& surface, const ViewFilmFormat& format, int count);
};

// 16 bits, linear, near high, full range, in the volume; `disparity(i)` is that of pixel i, in widths of a view.
[[nodiscard]] Frame depthOfDisparity(const ViewFilmFormat& format, int cols, int rows, MediaTime time,
                                     const std::function<double(std::size_t i)>& disparity);

}  // namespace relievo
