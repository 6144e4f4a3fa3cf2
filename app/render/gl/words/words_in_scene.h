// SPDX-License-Identifier: Apache-2.0
// Subtitles just in front of the relief that they cover.
#pragma once

#include <optional>
#include <vector>

#include "app/render/gl/words/overlay.h"
#include "app/render/relief/coarse_relief.h"
#include "app/render/relief/relief_triangles.h"
#include "app/render/relief/stereo.h"
#include "app/render/relief/words_place.h"
#include "app/render/text/text_picture.h"
#include "platform/error.h"

namespace relievo {

class WordsInScene {
 public:
  [[nodiscard]] static Result<WordsInScene> create();

  // Shown from now on.
  void set(const TextFrame& frame, const std::vector<TextPicture>& pictures);
  // The next picture does not continue the last one: the words may jump.
  void cut() noexcept { place_.begin(); }
  // Call when a new picture comes: the subtitles move on to it.
  void newPicture() noexcept { due_ = true; }
  // Finds the subtitles' place in the present picture, once, so that a redrawn picture shows them at the same place.
  // Null: the picture is flat.
  void find(const ReliefTriangles* relief, const EyeViews& eyes, const StereoSettings& stereo);
  // The reliefs after the picture that `find` gets; they must live until the next call.
  void setAhead(const ReliefAhead& ahead) noexcept { ahead_ = ahead; }
  // Into the viewport that is set, which is the view's.
  void draw(const EyeView& view, const StereoSettings& stereo) const;

  [[nodiscard]] const WordsPlace& place() const noexcept { return place_; }

 private:
  Overlay overlay_;
  std::optional<WordsBox> box_;  // in the screen plane, as shares of the view
  WordsPlace place_;
  ReliefAhead ahead_;
  bool due_ = false;
};

}  // namespace relievo
