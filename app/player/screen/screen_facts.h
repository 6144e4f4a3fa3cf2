// SPDX-License-Identifier: Apache-2.0
// The player's state at one moment, for the text on the screen.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/player/control/command.h"
#include "app/player/state_table.h"
#include "app/render/relief/stereo.h"

namespace relievo {

// `across` and `up`: the finger's position from the middle of the picture, to the right and up; inside from -0.5 to
// 0.5.
struct FingerFacts {
  std::string haptic;  // the device's name; empty: none
  bool contact = false;
  double force_n = 0;
  std::optional<double> across, up;
};

struct ScreenFacts {
  std::string title;
  double position_s = 0, duration_s = 0;  // duration 0: unknown
  double buffered_s = 0;                  // pictures are decoded up to here
  PlayerState state = PlayerState::Boot;
  bool held = false;
  double rate = 1;
  bool loop = false;
  std::size_t film = 1, films = 1;  // number in the list, and the list's length
  StereoSettings stereo;
  bool has_depth = false;
  std::array<FingerFacts, 2> fingers;  // the second one is usually absent
  double volume_percent = 100;
  bool muted = false;
  std::string sound_track, subtitle_track;  // "2 of 3, jpn, Director"; "off"
  double sound_delay_s = 0, subtitle_delay_s = 0, subtitle_size = 1;
  std::string chapter;     // where the film is, or is sought: "2 of 4, The Nose"; empty: it has none
  std::string aspect;      // the shape's word
  int turned_degrees = 0;  // clockwise, by the viewer: 0, 90, 180 or 270
  bool full_screen = false;
  std::vector<PlayerVerb> buttons;               // that the bar has for a mouse; empty without one
  std::optional<double> loop_from_s, loop_to_s;  // of an A-B loop
};

}  // namespace relievo
