// SPDX-License-Identifier: Apache-2.0
// Combines all that is known about a film's depth into its reading: options, files, tags, names and pictures.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "app/media/reading/film_reading.h"
#include "app/media/reading/known_kind.h"
#include "app/media/reading/recording_place.h"
#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

struct DepthClues {
  CalibrationSettings command_line, side_file;
  const KnownKind* as = nullptr;  // --as
  RecordingPlace place;
  std::map<std::string, std::string> tags;  // of track and container
  std::string codec, path;                  // of the depth
  Packing packing = Packing::Tracks;
  CalibrationOrigin packing_by = CalibrationOrigin::StreamSignalling;
  DepthCode code = DepthCode::Luma;
  CalibrationOrigin code_by = CalibrationOrigin::Default;
  CalibrationSettings pictures;       // what the pictures have shown so far
  std::vector<std::string> why;       // likewise, in words
  bool live = false;                  // a camera or a network: what comes next may be nearer than the first picture
  bool single = false;                // one picture, or photos of different things: no film (isStill)
  std::vector<CalibrationPart> more;  // registration, rotation
};

struct DepthMeaning {
  CalibrationChoice calibration;
  FilmReading reading;  // of its doubts, those about the near end
};

// The recording's kind: stated by the user; else by its file names, if its pictures have that kind's form; else
// recognised from the picture, whose samples are as stored, and from `later` ones. Null if none is known, or if the
// codes' meaning was stated.
[[nodiscard]] const KnownKind* kindOf(const DepthClues& clues, const Frame& stored, std::span<const Frame> later = {});

// `kind`: what kindOf returned. `look`: a depth picture that is not blank, with its samples in the order of `kind`.
// `later`: further depth pictures; near and far cover them too. Fails with the errors of chooseCalibration.
[[nodiscard]] Result<DepthMeaning> readMeaning(const DepthClues& clues, const KnownKind* kind, const Frame& look,
                                               std::span<const Frame> later = {});
// True if near, far or the range of codes come from the pictures examined, so that later pictures may lie beyond them.
[[nodiscard]] bool isReachSeen(const CalibrationChoice& choice);

}  // namespace relievo
