// SPDX-License-Identifier: Apache-2.0
// Gives found pictures their times and pairs depth with colour.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/pictures/folder.h"
#include "platform/clock.h"

namespace relievo::pictures {

struct TimedPicture {
  std::string path;
  Duration time{0};
};

struct Recording {
  std::vector<TimedPicture> color, depth;         // in order; times from the first colour picture, else the first depth
  Duration period{0};                             // the usual step of the leading series; 0 for a single picture
  std::optional<Duration> start;                  // of time 0, as the names say
  bool numbered = false;                          // the times come from a rate
  bool views = false;                             // `depth` is the right view
  std::map<std::string, std::string> depth_tags;  // layouts.h
  std::vector<std::string> notes;
};

// Times are those that names or lists say, exactly; numbers and ranks are counted at `frames_per_s`, by default 30.
// Colour and depth whose names do not count them (they have nothing in common, or numbers that are usually more than
// 100 apart) are photos, one in 5 s. A number that is absent leaves a gap in time.
//
// Depth belongs to the colour picture with its number, or, of times, to the nearest one within 20 ms, each used once,
// the nearest pairs first (as TUM's associate.py); it gets that picture's time. Other depth pictures keep their own
// time; those before the first colour picture are left out. Depth whose names give neither belongs to the colour
// picture of its name (keyOf in roles.h) and is left out without one, or, if no names are shared, to the picture of its
// rank.
[[nodiscard]] Recording recordingOf(const FoundPictures& found, std::optional<double> frames_per_s);

}  // namespace relievo::pictures
