// SPDX-License-Identifier: Apache-2.0
#include "app/media/pairs/stored_form.h"

#include <utility>

#include "app/media/depth_picture.h"
#include "app/media/reading/code_count.h"
#include "app/media/reading/stereo/stereo_pair.h"

namespace relievo {

Result<Halves> StoredForm::halvesOf(const Frame& stored, Packing packing) const {
  const bool bytes = order != SampleOrder::AsStored && stored.model == ColorModel::Rgb;
  auto halves = splitPacked(stored, packing, bytes ? DepthCode::Hue : code, gray, seam);
  if (halves) stateMatrix(halves->depth);
  if (!halves || !bytes) return halves;
  auto ordered = inOrder(halves->depth, order);
  if (!ordered) return std::unexpected(ordered.error());
  halves->depth = std::move(*ordered);
  return halves;
}

Result<Frame> StoredForm::ownDepth(const Frame& stored) {
  auto ordered = inOrder(stored, order);
  if (ordered) stateMatrix(*ordered);
  return ordered && registrar ? registrar->registered(*ordered) : std::move(ordered);
}

void StoredForm::stateMatrix(Frame& depth) const noexcept {
  if (depth.model == ColorModel::Yuv && depth.matrix == ColorMatrix::Unspecified) depth.matrix = matrix;
}

Result<Frame> StoredForm::depthIn(const Frame& stored, Packing packing) {
  if (!isPacked(packing) || packing == Packing::DepthAlone) return ownDepth(stored);
  const bool in_yuv = stored.model == ColorModel::Yuv && gray == GrayFrom::Luma;
  auto halves = in_yuv ? splitPacked(stored, packing, DepthCode::Hue, GrayFrom::Luma, seam) : halvesOf(stored, packing);
  if (!halves) return std::unexpected(halves.error());
  stateMatrix(halves->depth);
  return std::move(halves->depth);
}

Result<std::optional<FramePair>> StoredForm::pairIn(Frame& color, const FilmInfo& info) const {
  if (info.packing == Packing::DepthAlone) {
    auto ordered = inOrder(color, order);
    if (!ordered) return std::unexpected(ordered.error());
    stateMatrix(*ordered);
    Frame shown = depthPicture(*ordered, info.calibration.calibration);
    return FramePair{std::move(shown), std::move(*ordered), true, {}, {}};
  }
  if (isPacked(info.packing)) {
    auto halves = halvesOf(color, info.packing);
    if (!halves) return std::unexpected(halves.error());
    return FramePair{std::move(halves->color), std::move(halves->depth), true, {}, {}};
  }
  if (isStereo(info.packing)) {
    auto both = viewsOf(color, info.packing, right_first, squeezed);
    if (both) return FramePair{std::move(both->left), {}, true, {}, std::move(both->right)};
  }
  if (info.packing == Packing::StereoLayers) {
    Frame right = color.right ? *color.right : Frame{};
    right.pts = color.pts;
    color.right.reset();
    return FramePair{std::move(color), {}, true, {}, std::move(right)};
  }
  return std::nullopt;
}

}  // namespace relievo
