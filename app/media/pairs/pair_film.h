// SPDX-License-Identifier: Apache-2.0
// The private state of a PairReader, and its parts with the file that each is in.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/media/depth_follower.h"
#include "app/media/pairs/film_inputs.h"
#include "app/media/pairs/film_meaning.h"
#include "app/media/pairs/left_out_pictures.h"
#include "app/media/pairs/material_pictures.h"
#include "app/media/pairs/open_film.h"
#include "app/media/pairs/sound_and_words.h"
#include "app/media/tracks/track_reader.h"

namespace relievo {

struct PairReader::Impl : OpenFilm {
  static constexpr const char* kNotOpen = "no film is open; open one first";

  using OpenFilm::OpenFilm;

  // In pair_opening.cpp.
  Result<void> openFilm();
  Result<void> openColor(const StreamInfo& color);
  Result<void> openDepth(const StreamInfo& color);
  Result<const Frame*> firstDepth();
  void meet(const DepthSource::Session& session, MediaTime first);
  // In pair_reader.cpp: the next pair.
  Result<std::optional<Frame>> readColor();
  Result<std::optional<Frame>> nextColor();
  Result<DepthFollower::Supplied> supplyDepth();
  Result<DepthFollower::Supplied> supplyOwnDepth();
  Result<FramePair> pairFor(Frame color);
  Result<DepthFollower::Match> depthAt(MediaTime time);
  [[nodiscard]] Frame materialAt(MediaTime time);
  void loseDepth(const Error& error);
  // In pair_late.cpp: pictures that are left out for lack of time.
  [[nodiscard]] std::optional<FramePair> depthBefore(const Frame& color);
  // In pair_jumps.cpp: seeking, and going on after a loss.
  Result<std::optional<Frame>> passTo(MediaTime target);
  [[nodiscard]] bool isGap(MediaTime target) const;
  Result<void> seekDepth(MediaTime target);
  Result<void> goOn();
  void leaveColor();

  PairCounters counters;
  FilmScout scout{*this};
  FilmMeaning meaning{*this, scout};
  FilmInputs inputs{*this};
  SoundAndWords words{*this};
  std::deque<Frame> color_ahead;  // read, not yet delivered
  Duration color_shift{0};        // added to the session's timestamps to get the film's
  MediaTime goes_on_at;           // film time just after the last colour picture
  std::optional<DepthFollower> depth;
  std::optional<Frame> depth_again;  // a picture that was supplied before its order was known
  MaterialPictures material;
  struct OwnDepth {
    Duration shift{0};                     // added to the session's timestamps to get the film's
    std::optional<std::uint32_t> session;  // the session that `shift` applies to
    bool away = false;                     // late or lost, and being retried
    bool lost = false, loss_told = false;
  };
  OwnDepth own;          // of `sources.depth()`, which reads `depth_url`
  Duration key_step{0};  // of the last seek
  LeftOutPictures left_out;
};

}  // namespace relievo
