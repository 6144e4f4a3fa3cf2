// SPDX-License-Identifier: Apache-2.0
// The reading of a film's depth, part by part: its source, and how certain it is.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"

namespace relievo {

enum class Certainty : std::uint8_t {
  Said,    // by the user, a file or the stream
  Likely,  // names or pictures show it
  Assumed  // nothing shows it
};
[[nodiscard]] const char* name(Certainty certainty) noexcept;
[[nodiscard]] Certainty certaintyOf(CalibrationOrigin origin) noexcept;

// The parts are packing, code, kind, registration and rotation, where the film has them, and the calibration's keys.
struct FilmReading {
  std::vector<CalibrationPart> parts;
  std::vector<std::string> why;     // what names, tags and pictures revealed; one line each
  std::vector<std::string> offers;  // other readings that are as likely, with the option to type; one line each
  std::vector<std::string> doubts;  // why the reading looks wrong, and the option to try; one line each
  bool near_end_is_usual = false;   // the first doubt is that nobody has stated the near end; it is taken as in most
};

// Tags that keep a guess marked as a guess when an author writes them into a film: the keys of the calibration that
// nobody has stated, as DEPTH_LIKELY=polarity,law and DEPTH_ASSUMED=near,far. A tag without keys is left out.
[[nodiscard]] std::map<std::string, std::string> certaintyTags(const FilmReading& reading);
// Marks parts as guesses if the film's tags say that they were guesses.
void markGuesses(const std::map<std::string, std::string>& tags, CalibrationChoice& choice);

// For a viewer: "depth right of the colour as brightness, near bright, no holes".
[[nodiscard]] std::string plainLine(const FilmReading& reading, const DepthCalibration& calibration);
// One line for each part: name, value, who said it, how sure that is.
[[nodiscard]] std::vector<std::string> partLines(const FilmReading& reading);

}  // namespace relievo
