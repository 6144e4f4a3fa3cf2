// SPDX-License-Identifier: Apache-2.0
// How the pictures of a film hold its depth or its second view, as the reader has found it. Pure.
#pragma once

#include <optional>

#include "app/media/pair_reader.h"
#include "app/media/reading/known_kind.h"
#include "app/media/reading/packing.h"
#include "app/media/registration/registration.h"

namespace relievo {

struct StoredForm {
  // Colour and depth of a packed picture, the depth's samples in order.
  [[nodiscard]] Result<Halves> halvesOf(const Frame& stored, Packing packing) const;
  // The depth of a picture of depth alone, its samples in order, registered to the colour's view.
  [[nodiscard]] Result<Frame> ownDepth(const Frame& stored);
  // The depth in a picture of either kind, as its meaning is read from it.
  [[nodiscard]] Result<Frame> depthIn(const Frame& stored, Packing packing);
  // The pair in one picture, which is used up; nullopt if its depth or second view is not in it.
  [[nodiscard]] Result<std::optional<FramePair>> pairIn(Frame& color, const FilmInfo& info) const;

  // Gives depth in colours that states no matrix the one that was found.
  void stateMatrix(Frame& depth) const noexcept;

  DepthCode code = DepthCode::Luma;
  ColorMatrix matrix = ColorMatrix::Unspecified;  // of depth in colours
  // Depth that is packed into the colour's picture.
  GrayFrom gray = GrayFrom::Luma;
  int seam = 0;  // columns of a margin between the halves
  // Two views in one picture.
  bool right_first = false;
  std::optional<bool> squeezed;  // if the film says it
  // Depth of its own.
  SampleOrder order = SampleOrder::AsStored;
  std::optional<Registrar> registrar;  // the user's, or the film's own
};

}  // namespace relievo
