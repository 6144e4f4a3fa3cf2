// SPDX-License-Identifier: Apache-2.0
// Reprojects a depth camera's picture into the view of the colour camera beside it.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "app/media/registration/lens.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// Focal lengths and principal point are in pixels of a picture of `cols` x `rows`; the centre of pixel (c, r) is at
// (c, r). A picture of another size shows the same view, scaled.
struct RigCamera {
  double cols = 0, rows = 0;
  double focal_x = 0, focal_y = 0;
  double center_x = 0, center_y = 0;
  Lens::Coefficients distortion{};  // all zero: none
};

// Maps a point p of the depth camera's frame (x right, y down, z forward, mm) to rotation x p + translation in the
// colour camera's frame.
struct Registration {
  RigCamera depth, color;
  std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  std::array<double, 3> translation_mm{0, 0, 0};
  double unit_mm = 1;  // per depth code, or per unit of floating-point depth (Frame::value_per_code); 0: not given
};

// Whether nine numbers, row by row, are a rotation, to within a thousandth.
[[nodiscard]] bool isRotation(const std::array<double, 9>& matrix) noexcept;

// Reads the TOML that app/author/README.md describes. InvalidArgument names the rule that the text breaks.
[[nodiscard]] Result<Registration> parseRegistration(std::string_view toml);

// Registers pictures. Keeps the rays of the depth camera's pixels between pictures.
class Registrar {
 public:
  explicit Registrar(const Registration& registration);

  [[nodiscard]] const Registration& registration() const noexcept { return registration_; }
  // The distances as the colour camera would see them: as wide as the depth picture, in the colour's aspect ratio, 16
  // bits, the same unit. Every sample is drawn as a small plate, tilted as its neighbours on both sides agree; where
  // several plates cover a pixel the nearest wins, and where none does there is a hole. Codes 0 and 65535 are holes.
  // Unsupported unless the picture holds whole-number codes.
  [[nodiscard]] Result<Frame> registered(const Frame& depth);

 private:
  // A pixel's ray meets the plane at distance 1 in a plate of this half size.
  struct Ray {
    double x, y;  // NaN: no ray
    double half_width, half_height;
  };
  // Where a sample is seen in the colour's picture, in pixels, how large, and its distance in codes; 0: nowhere.
  struct Seen {
    float u = 0, v = 0;
    float half_width = 0, half_height = 0;
    float code = 0;
  };
  // How the distance in codes changes from pixel to pixel of the colour's picture.
  struct Slope {
    float x = 0, y = 0;
  };
  void aim(int cols, int rows);
  void see(const Frame& depth, const RigCamera& to);
  [[nodiscard]] Slope slopeAt(std::size_t sample) const noexcept;

  Registration registration_;
  Lens depth_lens_, color_lens_;
  int cols_ = 0, rows_ = 0;  // of `rays_` and `seen_`
  std::vector<Ray> rays_;
  std::vector<Seen> seen_;
};

}  // namespace relievo
