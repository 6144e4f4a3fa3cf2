// SPDX-License-Identifier: Apache-2.0
// The private state of a PairReader: its parts, and the steps in which they open a film.
#pragma once

#include "app/media/pairs/film_inputs.h"
#include "app/media/pairs/film_meaning.h"
#include "app/media/pairs/film_scout.h"
#include "app/media/pairs/open_film.h"
#include "app/media/pairs/pair_supply.h"
#include "app/media/pairs/sound_and_words.h"

namespace relievo {

// The parts share the OpenFilm. What the meaning finds, the supply reads: the form of the pictures.
struct PairReader::Impl {
  explicit Impl(Backends backends) : film(std::move(backends)) {}

  // For the first time or again. In the second case a separate depth source has continued meanwhile, and what one
  // picture holds beside its colour stays: its first picture may be dark now, and its tags may come later.
  [[nodiscard]] Result<void> openFilm();
  void close() noexcept;

  OpenFilm film;
  FilmScout scout{film};
  FilmInputs inputs{film};
  FilmMeaning meaning{film, scout};
  PairSupply supply{film, meaning.form()};
  SoundAndWords words{film};

 private:
  [[nodiscard]] Result<void> openDepth(const StreamInfo& color);
  [[nodiscard]] Result<void> openOwnDepth(const StreamInfo& color);
  [[nodiscard]] Result<const Frame*> firstDepth();
};

}  // namespace relievo
