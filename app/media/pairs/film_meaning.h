// SPDX-License-Identifier: Apache-2.0
// Finds out, while a film is opened, what its pictures hold and what its depth means.
#pragma once

#include <deque>
#include <optional>

#include "app/media/pairs/film_plan.h"
#include "app/media/pairs/film_scout.h"
#include "app/media/pairs/open_film.h"
#include "app/media/pairs/stored_form.h"
#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/picture_look.h"

namespace relievo {

// Writes what it finds into FilmInfo: packing, calibration, reading, material and the depth's size. `color` is the
// colour's stream; pictures are those that were read first, as they are stored.
class FilmMeaning {
 public:
  FilmMeaning(OpenFilm& film, const FilmScout& scout) : film_(film), scout_(scout) {}

  // Collects what the user has stated, and what the recording's folder and files show; the colour's source is open.
  void begin();
  // The folder and files of the recording, as `begin` has seen them.
  [[nodiscard]] const RecordingPlace& place() const noexcept { return clues_.place; }
  // Why these tracks were chosen.
  void take(const FilmPlan& plan);

  // Looks for depth or a second view in the colour's picture itself; true if there is depth, whose meaning is then
  // read.
  [[nodiscard]] Result<bool> readPicture(const StreamInfo& color, const std::deque<Frame>& pictures);
  // The size of the colour beside packed depth, when a film is opened again.
  [[nodiscard]] Result<void> measureHalves(const Frame& picture);

  // Depth that has a stream of its own. A recording of two cameras may contain their relative position.
  void lookForRegistration(const StreamInfo& color);
  // Finds the order of the samples, which may show only in the first picture. Returns that picture as it is stored if
  // it must be put in another order than it was.
  [[nodiscard]] Result<std::optional<Frame>> findOrder(const Frame& first);
  // `first`: the depth's, in order; `color`: the colour's.
  [[nodiscard]] Result<void> readTrack(const Frame& first, const Frame& color);
  // The pictures of the two tracks show that the second is the colour: open the film again, exchanged.
  [[nodiscard]] bool wantsExchange() const noexcept { return wants_exchange_; }

  // Two views in two tracks.
  void takeViewTracks();
  // Checks two views that the user has stated, and takes them for the depth if that is wished.
  void readViews(const StreamInfo& color, const std::deque<Frame>& pictures);

  // Reports, once, a picture that lies beyond near and far if these were guessed.
  void checkReach(const Frame& depth);
  [[nodiscard]] StoredForm& form() noexcept { return form_; }
  void close() noexcept;

 private:
  void takeCode(DepthCode code, CalibrationOrigin by);
  void takeTags(const StreamInfo& stream);
  void takeExtras(const StreamInfo& stream);
  void takeMaterial(const Result<Material>& tagged);
  [[nodiscard]] Result<DepthMeaning> meaningOf(const Frame& look, const StreamInfo& stream);
  [[nodiscard]] Result<void> describe(const Frame& first, const Frame& look, const Frame& color,
                                      const StreamInfo& stream);
  [[nodiscard]] Result<std::optional<Frame>> statedOrder(const Frame& first);
  // In meaning_halves.cpp.
  void lookForCode(const Frame& look);
  void lookForColors(Frame& depth);
  void lookForHalves(const StreamInfo& color, const std::deque<Frame>& pictures);
  void takeHalves(FoundPacking found, const Frame& look);
  [[nodiscard]] Result<void> describeAlone(const StreamInfo& track, const Frame& picture);
  [[nodiscard]] Result<void> describeHalves(const StreamInfo& color, const Frame& picture);
  // In meaning_views.cpp.
  [[nodiscard]] bool takeLayers(const StreamInfo& color, const std::deque<Frame>& pictures);
  [[nodiscard]] bool takeSaidViews(const StreamInfo& color, const Frame& look, const std::deque<Frame>& pictures);
  void lookForViews(const Frame& look);
  [[nodiscard]] bool lookForAlpha(const StreamInfo& color, const Frame& look);
  void showViews(Packing packing, const char* by);
  void checkViews(const StreamInfo& color, const Frame& picture);
  void takeDepthFromViews();

  OpenFilm& film_;
  const FilmScout& scout_;
  DepthClues clues_;  // of the depth, as far as they were looked at
  StoredForm form_;
  const KnownKind* kind_ = nullptr;  // that the picture showed before it was put in order
  bool views_disproved_ = false;     // the user declared two views, but the pictures do not show one scene
  bool wants_exchange_ = false;
  bool reach_open_ = false;  // near and far come from a few pictures, and nothing beyond them was reported yet
};

}  // namespace relievo
