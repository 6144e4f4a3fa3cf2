// SPDX-License-Identifier: Apache-2.0
// A film of two views of a true surface, painted, and the depth that a matcher's disparities mean in it.
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
  // In widths of a view, of a height; and the other way round.
  [[nodiscard]] double disparityOf(double height_mm) const;
  [[nodiscard]] double heightOf(double disparity) const;
};

// 4:2:0 pictures whose right view is that of the exact disparity of each pixel; each eye's camera has a grain of its
// own, which changes from picture to picture. The paint stays where it is in the left view: a surface that moves to the
// viewer alone moves with it.
struct ViewFilm {
  std::vector<Frame> left, right;

  [[nodiscard]] static Result<ViewFilm> make(const TrueSurface& surface, const ViewFilmFormat& format, int count);
};

// 16 bits, linear, near high, full range, of the volume; `disparity(i)` of the pixel i, in widths of a view.
[[nodiscard]] Frame depthOfDisparity(const ViewFilmFormat& format, int cols, int rows, MediaTime time,
                                     const std::function<double(std::size_t i)>& disparity);

}  // namespace relievo
