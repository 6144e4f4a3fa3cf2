// SPDX-License-Identifier: Apache-2.0
// A lens that bends straight lines: Brown-Conrady's model with a rational radial term.
#pragma once

#include <array>
#include <optional>

namespace relievo {

// Maps the point where a ray meets the plane at distance 1 to the point where the lens shows it, with r^2 = x^2 + y^2:
//   f = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
//   x f + 2 p1 x y + p2 (r^2 + 2 x^2),  y f + p1 (r^2 + 2 y^2) + 2 p2 x y
// valid up to the radius where the radial part stops growing.
class Lens {
 public:
  // k1, k2, p1, p2, k3, k4, k5, k6, the order of OpenCV and ROS.
  using Coefficients = std::array<double, 8>;
  struct Point {
    double x = 0, y = 0;
  };
  explicit Lens(const Coefficients& coefficients) noexcept;

  [[nodiscard]] bool bends() const noexcept { return bends_; }
  // Where a ray is seen, and how much larger things are there than in the middle, along x and y. Nullopt beyond the
  // valid radius.
  struct Seen {
    Point point;
    double scale_x = 1, scale_y = 1;
  };
  [[nodiscard]] std::optional<Seen> see(Point ray) const noexcept;
  // The ray that is seen at a point; nullopt if there is none.
  [[nodiscard]] std::optional<Point> rayAt(Point seen) const noexcept;

 private:
  struct Radial {
    double factor, slope;  // f, and df/d(r^2)
  };
  struct Bent {
    Point point;
    double dxx, dxy, dyy;  // the derivatives: a symmetric matrix
  };
  [[nodiscard]] Radial radial(double r2) const noexcept;
  [[nodiscard]] Bent bend(Point ray) const noexcept;

  Coefficients c_;
  bool bends_ = false;
  double largest_r2_;
};

}  // namespace relievo
