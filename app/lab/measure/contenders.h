// SPDX-License-Identifier: Apache-2.0
// The contenders of the measurements: methods and the parts that they are made of, with their names on the charts.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "app/lab/film/film_run.h"

namespace relievo {

// The parts of a contender on a film. The widths are those of relievo's smooth surface; for depth smoothed per frame
// the width is `wide_mm`.
struct ContenderParts {
  const char* space = "";
  const char* time = "";  // of the wide level
  double narrow_mm = std::numeric_limits<double>::quiet_NaN(), wide_mm = narrow_mm;
  int look_ahead_frames = 0;
};

struct Contender {
  const char* label;  // on a chart
  const char* method;
  MethodConfig config;        // without the jump threshold: the guard would hide what is measured
  bool planned = false;       // uses the widths that the plan picks for the film, as the player does
  bool fixed_choice = false;  // one part swapped
  bool smoothed = false;      // on depth smoothed per frame (FilmViews)

  // `film` is the unsmoothed film, also for a contender that feels a smoothed one.
  [[nodiscard]] std::unique_ptr<TouchMethod> make(const MemoryFilm& film) const;
  [[nodiscard]] ContenderParts parts(const MemoryFilm& film) const;
};

// A film and the same with every frame smoothed by the width that suits it best (blurWidthMm, smoothedFilm), which
// takes a while.
class FilmViews {
 public:
  explicit FilmViews(const MemoryFilm& film);
  [[nodiscard]] const MemoryFilm& raw() const { return raw_; }
  [[nodiscard]] const MemoryFilm& of(const Contender& who) const { return who.smoothed ? smoothed_ : raw_; }
  [[nodiscard]] double sigmaMm() const { return sigma_mm_; }

 private:
  MemoryFilm raw_;
  double sigma_mm_;
  MemoryFilm smoothed_;
};

// Plays one contender along a whole path.
[[nodiscard]] std::vector<PlayedTick> playPath(const FilmViews& film, const Contender& who,
                                               std::span<const HipTick> path, std::span<const TrueTouch> truth);

// The methods as they are, `relievo` first; then the same with one part swapped. Those on Bullet's height field are
// missing if relievo-lab was built without that library.
[[nodiscard]] std::span<const Contender> contenders();
// Null for an unknown label.
[[nodiscard]] const Contender* contender(std::string_view label);

}  // namespace relievo
