// SPDX-License-Identifier: Apache-2.0
// The depth at which subtitles are shown: just in front of the relief behind them. Pure arithmetic.
#pragma once

#include <cstdint>
#include <span>

#include "app/render/relief/coarse_relief.h"
#include "app/render/relief/stereo.h"
#include "app/render/relief/textured_vertex.h"

namespace relievo {

// A rectangle in the screen plane, scene frame, mm.
struct WordsBox {
  double left = 0, bottom = 0, right = 0, top = 0;
  bool operator==(const WordsBox&) const = default;
};

// Disparities are in pixels of a view: the left eye's position of a point minus the right eye's, positive in front of
// the screen.
//
// The subtitles follow the nearest relief under their box, and start moving before it arrives: their disparity changes
// by at most kStep a picture if the coming relief is known early enough. It is known
// - where the pictures after the present one are read ahead (ReliefAhead): n of them leave room for n + 1 steps;
// - where an object is seen beside the box: its height counts less the farther away it is, so that an object that comes
// from the side at up to kFastest of the width a picture (kFastestBlind without pictures ahead) raises the subtitles in
// time.
// An object that rises higher than that, or enters the picture right beside the subtitles, moves them faster than
// kStep, in equal steps over the remaining pictures, since words behind an object that they cover hurt the eyes;
// `lifted` counts those pictures.
class WordsPlace {
 public:
  static constexpr double kStep = 1.0;               // px a picture
  static constexpr double kSink = 0.25;              // px a picture, back towards the relief
  static constexpr double kFastest = 1.0 / 5;        // the picture's width per picture
  static constexpr double kFastestBlind = 1.0 / 40;  // without pictures ahead
  static constexpr double kInFront = 0.002;  // of the picture's width: the disparity from the relief to the words

  // Call for other words, or a cut: the subtitles may start anywhere.
  void begin() noexcept { begins_ = true; }
  // Call for the next picture. `indices`: three for each triangle of the surface. `ahead`: the coming reliefs.
  void follow(std::span<const TexturedVertex> vertices, std::span<const std::uint32_t> indices, const WordsBox& box,
              const StereoSettings& stereo, double width_px, double pixels_per_mm, const ReliefAhead& ahead = {});
  // Call if the picture is flat.
  void stayInScreen() noexcept { disparity_ = behind_ = 0; }

  [[nodiscard]] double disparity() const noexcept { return disparity_; }
  // The disparity of the nearest relief behind the subtitles, in the last picture.
  [[nodiscard]] double behind() const noexcept { return behind_; }
  [[nodiscard]] std::uint64_t lifted() const noexcept { return lifted_; }
  // How far to the right the subtitles are shifted in the view of the eye at `eye_x_mm`.
  [[nodiscard]] double shiftPx(double eye_x_mm, const StereoSettings& stereo) const noexcept;

 private:
  struct Needs;
  void move(const Needs& needs) noexcept;

  double disparity_ = 0, behind_ = 0;
  bool begins_ = true;
  std::uint64_t lifted_ = 0;
};

}  // namespace relievo
