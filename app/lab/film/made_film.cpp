// SPDX-License-Identifier: Apache-2.0
// Frames have 16 bits; a film of fewer bits uses only that many different heights.
#include "app/lab/film/made_film.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace relievo {
namespace {

TimedSurface toSurface(std::vector<std::uint16_t> codes, MediaTime time, const DepthCalibration& calibration) {
  const auto samples = std::make_shared<const std::vector<std::uint16_t>>(std::move(codes));
  const Frame frame = grayFrame(samples, MadeFormat::kCols, MadeFormat::kRows);
  TimedSurface surface{.time = time, .owner = samples};
  if (const auto field = HeightField::make(frame, calibration, MadeFormat::kVolume)) {
    surface.field = *field;
  }
  return surface;
}

}  // namespace

std::vector<TimedSurface> makeFilm(const Relief& relief, const MadeFormat& format, double duration_s,
                                   const Damage& damage) {
  const GridMapping grid(MadeFormat::kVolume, MadeFormat::kCols, MadeFormat::kRows);
  const double highest = std::exp2(format.bits) - 1, carried = 65535;
  DepthCalibration calibration{.bits = 16};
  if (format.zero_is_hole) calibration.invalid = 0;
  std::mt19937_64 random(format.seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<TimedSurface> film;
  const int last = static_cast<int>(std::ceil(duration_s * format.frames_per_s));
  for (int i = 0; i <= last; ++i) {
    const MediaTime time = mediaTime(i / format.frames_per_s);
    std::vector<std::uint16_t> codes(static_cast<std::size_t>(MadeFormat::kCols) * MadeFormat::kRows);
    std::size_t at = 0;
    for (int r = 0; r < MadeFormat::kRows; ++r) {
      for (int c = 0; c < MadeFormat::kCols; ++c) {
        double s = relief(grid.x(c), grid.y(r), toSeconds(time)) / MadeFormat::kVolume.depth_mm;
        if (format.noise_share > 0) s += format.noise_share * noise(random);
        const double code = std::floor(std::clamp(s, 0.0, 1.0) * highest + 0.5);
        codes[at++] = static_cast<std::uint16_t>(std::lround(code / highest * carried));
      }
    }
    if (damage) damage(i, codes);
    film.push_back(toSurface(std::move(codes), time, calibration));
  }
  return film;
}

const std::vector<TimedSurface>& KeptFilm::make(const Relief& relief, const MadeFormat& format, double duration_s,
                                                const Damage& damage) {
  const std::lock_guard guard(lock_);
  auto& film = by_duration_[duration_s];
  if (film.empty()) film = makeFilm(relief, format, duration_s, damage);
  return film;
}

}  // namespace relievo
