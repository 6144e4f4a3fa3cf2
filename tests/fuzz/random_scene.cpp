// SPDX-License-Identifier: Apache-2.0
// Draws the pictures and moves the finger.
#include "tests/fuzz/random_scene.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

namespace relievo {

RandomFilm::RandomFilm(Random& random) : random_(random) {
  cols_ = 32 + random.below(40);
  rows_ = 24 + random.below(30);
  const double pitch = random.chance(0.7) ? 160.0 / 720 : random.within(0.04, 1.2);
  volume_ = {cols_ * pitch, rows_ * pitch, 40};
  bits_ = random.chance(0.5) ? 8 : 16;
  period_s_ = 1 / random.within(10, 120);
  newScene();
}

void RandomFilm::newScene() {
  for (Wave& w : waves_) {
    w = {random_.within(-8, 8), random_.within(-1.5, 1.5), random_.within(-1.5, 1.5), random_.within(0, 6),
         random_.within(-60, 60)};
  }
  level_ = random_.within(5, 35);
  slope_x_ = random_.within(-0.5, 0.5);
  slope_y_ = random_.within(-0.5, 0.5);
  const double speeds[] = {0, 0, 50, 300, 3000};
  const double most = speeds[random_.below(5)];
  speed_ = random_.within(-most, most);
  noise_ = random_.chance(0.5) ? 0 : std::pow(10, random_.within(-3, -0.5));
  holes_ = random_.chance(0.6) ? 0 : random_.within(0, 0.4);
  spikes_ = random_.chance(0.6) ? 0 : random_.within(0, 0.02);
  block_ = random_.chance(0.5);
  white_ = random_.chance(0.05);
  still_ = 0;
}

double RandomFilm::height(double x, double y, double t_s) {
  double z = level_ + slope_x_ * x + slope_y_ * y;
  for (const Wave& w : waves_) z += w.size * std::sin(w.kx * x + w.ky * y + w.phase + w.rate * t_s);
  return noise_ > 0 ? z + 40 * noise_ * (random_.within(-2, 2)) : z;
}

void RandomFilm::draw(double t_s) {
  const GridMapping grid(volume_, cols_, rows_);
  const double full = std::exp2(bits_) - 1;
  const int bytes = bits_ > 8 ? 2 : 1;
  picture_.resize(static_cast<std::size_t>(cols_) * rows_ * bytes);
  std::uint8_t* out = picture_.data();
  const int block_c = random_.below(cols_), block_r = random_.below(rows_), block_z = random_.below(65536);
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < cols_; ++c) {
      const double share = std::clamp(height(grid.x(c), grid.y(r), t_s) / volume_.depth_mm, 0.0, 1.0);
      auto code = static_cast<std::uint32_t>(std::lround(share * full));
      if (block_ && c > block_c && r > block_r) code = static_cast<std::uint32_t>(block_z) >> (16 - bits_);
      if (white_ || (spikes_ > 0 && random_.chance(spikes_)))
        code = static_cast<std::uint32_t>(random_.bits()) >> (32 - bits_);
      if (holes_ > 0 && random_.chance(holes_)) code = 0;
      *out++ = static_cast<std::uint8_t>(code & 0xff);
      if (bytes == 2) *out++ = static_cast<std::uint8_t>(code >> 8);
    }
  }
}

TimedSurface RandomFilm::next(double t_s) {
  if (random_.chance(0.02)) newScene();
  if (random_.chance(0.1)) speed_ = -speed_;
  if (random_.chance(0.03)) still_ = random_.below(15);
  if (still_ > 0 && !picture_.empty()) {
    --still_;
  } else {
    level_ = std::clamp(level_ + speed_ * period_s_, -10.0, 50.0);
    draw(t_s);
  }
  const int bytes = bits_ > 8 ? 2 : 1;
  const auto samples = std::make_shared<std::vector<std::uint8_t>>(picture_);
  Frame frame;
  frame.pts = mediaTime(t_s);
  frame.width = cols_;
  frame.height = rows_;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(bytes), .bits = static_cast<std::uint8_t>(bits_)};
  frame.planes[0] = {samples->data(), static_cast<std::ptrdiff_t>(cols_) * bytes};
  TimedSurface surface{.time = frame.pts, .owner = samples};
  const DepthCalibration calibration{.bits = bits_, .invalid = 0};
  if (const auto field = HeightField::make(frame, calibration, volume_)) surface.field = *field;
  return surface;
}

glm::dvec3 RandomFinger::next(double tick_s) {
  if (left_-- <= 0) {
    left_ = random_.below(120);
    const double speeds[] = {0, 20, 100, 500, 2000, 5000};
    speed_ = speeds[random_.below(6)];
    target_ = {random_.within(-0.6, 0.6) * volume_.width_mm, random_.within(-0.6, 0.6) * volume_.height_mm,
               random_.within(-5, 50)};
    if (random_.chance(0.4)) target_.z = at_.z;
  }
  const glm::dvec3 way = target_ - at_;
  const double length = glm::length(way), step = speed_ * tick_s;
  if (length > 0) at_ += way * std::min(1.0, step / length);
  if (random_.chance(2e-4)) return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  if (random_.chance(5e-4))
    return at_ + glm::dvec3(random_.within(-50, 50), random_.within(-50, 50), random_.within(-50, 50));
  if (tick_++ % ticks_of_reading_ == 0) reading_ = at_;
  return reading_;
}

}  // namespace relievo
