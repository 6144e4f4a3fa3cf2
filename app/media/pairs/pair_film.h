// SPDX-License-Identifier: Apache-2.0
// The private state of a PairReader, and its parts with the file that each is in.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "app/media/depth_follower.h"
#include "app/media/pairs/film_inputs.h"
#include "app/media/pairs/film_plan.h"
#include "app/media/pairs/left_out_pictures.h"
#include "app/media/pairs/material_pictures.h"
#include "app/media/pairs/open_film.h"
#include "app/media/pairs/sound_and_words.h"
#include "app/media/reading/depth_meaning.h"
#include "app/media/tracks/track_reader.h"

namespace relievo {

struct PairReader::Impl : OpenFilm {
  static constexpr const char* kNotOpen = "no film is open; open one first";

  using OpenFilm::OpenFilm;

  // In pair_opening.cpp.
  Result<void> openFilm();
  Result<void> openColor(const StreamInfo& color);
  void lookForRegistration(const StreamInfo& color);
  Result<void> openDepth(const StreamInfo& color);
  void meet(const DepthSource::Session& session, MediaTime first);
  // In pair_reading.cpp: where the depth is.
  void lookAround();
  void lookForHalves(const StreamInfo& color);
  Result<const Frame*> firstDepth();
  Result<const Frame*> firstAsStated(const Frame& first);
  // In pair_views.cpp: what one picture holds beside its colour.
  [[nodiscard]] bool takeLayers(const StreamInfo& color);
  [[nodiscard]] bool takeSaidViews(const StreamInfo& color, const Frame& look);
  void lookForViews(const Frame& look);
  [[nodiscard]] bool lookForAlpha(const StreamInfo& color, const Frame& look);
  void showViews(Packing packing, const char* by);
  void checkViews(const StreamInfo& color);
  void takeDepthFromViews();
  // In pair_describing.cpp: what the depth means.
  [[nodiscard]] Result<Frame> depthIn(const Frame& stored);
  void checkReach(const Frame& picture);
  [[nodiscard]] Result<Halves> halvesOf(const Frame& stored) const;
  void lookForCode(const Frame& first);
  Result<void> describeAlone(const StreamInfo& track);
  Result<void> describeHalves(const StreamInfo& color);
  Result<void> measureHalves();
  Result<void> describeTrack(const Frame& first);
  void takeTags(const StreamInfo& stream);
  Result<void> describe(const Frame& first, const Frame& look, const Frame& color, const StreamInfo& stream);
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
  FilmInputs inputs{*this};
  SoundAndWords words{*this};
  std::deque<Frame> color_ahead;  // read, not yet delivered
  DepthClues clues;               // of the depth, as far as they were looked at
  // Depth that is packed into the colour's picture.
  struct PackedDepth {
    GrayFrom gray = GrayFrom::Luma;
    int seam = 0;  // columns of a margin between the halves
  };
  PackedDepth packed;
  // Two views in one picture.
  struct Views {
    bool right_first = false;
    std::optional<bool> squeezed;     // if the film says it
    bool are_other_pictures = false;  // what was said to be two views is not
  };
  Views views;
  // Depth of its own whose samples are put in another order.
  struct Reordering {
    SampleOrder order = SampleOrder::AsStored;
    const KnownKind* kind = nullptr;  // that the picture showed before it was put in order
    std::optional<Frame> again;       // a picture that was supplied before the order was known
  };
  Reordering reordering;
  Duration color_shift{0};  // added to the session's timestamps to get the film's
  MediaTime goes_on_at;     // film time just after the last colour picture
  std::optional<DepthFollower> depth;
  MaterialPictures material;
  std::optional<Registrar> registrar;  // the user's, or the film's own
  struct OwnDepth {
    Duration shift{0};                     // added to the session's timestamps to get the film's
    std::optional<std::uint32_t> session;  // the session that `shift` applies to
    bool away = false;                     // late or lost, and being retried
    bool lost = false, loss_told = false;
  };
  OwnDepth own;          // of `sources.depth()`, which reads `depth_url`
  Duration key_step{0};  // of the last seek
  LeftOutPictures left_out;
  bool wants_exchange = false;  // the pictures of two tracks show that the second is the colour
  bool reach_open = false;      // near and far come from a few pictures, and nothing beyond them was reported yet
};

}  // namespace relievo
