// SPDX-License-Identifier: Apache-2.0
// Describes the depth of a film that is being opened: its size, its code and its calibration.
#include <algorithm>
#include <iterator>
#include <utility>

#include "app/media/pairs/depth_reach.h"
#include "app/media/pairs/pair_film.h"
#include "app/media/reading/color_map_fit.h"
#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/depth_reading.h"
#include "app/media/reading/picture_look.h"
#include "app/media/reading/stereo/stereo_pair.h"
#include "hal/media/media_names.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kMostlyGray = 0.9, kAllGray = 0.99;

}  // namespace

// Finds the depth code by the colours of a picture.
void PairReader::Impl::lookForCode(const Frame& look) {
  if (clues.code_by != CalibrationOrigin::Default || look.model == ColorModel::Gray) return;
  const PictureLook seen = lookAt(look);
  if (isRedAlone(seen) || packedOrder(look) != SampleOrder::AsStored) return;
  const auto map = bestColorMap(look);
  if (!map && !isHue(seen)) return;
  clues.code = map ? map->code : DepthCode::Hue;
  clues.code_by = CalibrationOrigin::FirstPicture;
  clues.why.push_back(clues.code == DepthCode::Hue
                          ? print("%.0f %% of the depth is pure colour: read as hue", 100 * seen.vivid)
                          : print("%.0f %% of the depth lies on the colour map %s", 100 * map->share, name(map->code)));
}

// Depth without colour; its samples are put in order as they are read (`pairFor`).
Result<void> PairReader::Impl::describeAlone(const StreamInfo& track) {
  Frame look = scout.tellingPicture(color_ahead[0], options.url, track.index);
  lookForCode(look);
  takeTags(track);
  const KnownKind* const kind = kindOf(clues, look);
  reordering.order = orderOf(kind, look);
  if (reordering.order != SampleOrder::AsStored) {
    reordering.kind = kind;
    auto ordered = inOrder(look, reordering.order);
    if (!ordered) return failOn(options.url, ordered.error());
    look = std::move(*ordered);
  }
  return describe(color_ahead[0], look, {}, track);
}

// Colour and depth of a packed picture, the depth's samples in order.
Result<Halves> PairReader::Impl::halvesOf(const Frame& stored) const {
  const bool bytes = reordering.order != SampleOrder::AsStored && stored.model == ColorModel::Rgb;
  auto halves = splitPacked(stored, info.packing, bytes ? DepthCode::Hue : clues.code, packed.gray, packed.seam);
  if (!halves || !bytes) return halves;
  auto ordered = inOrder(halves->depth, reordering.order);
  if (!ordered) return std::unexpected(ordered.error());
  halves->depth = std::move(*ordered);
  return halves;
}

// The depth in a picture as it is stored, as `describe` looks at it.
Result<Frame> PairReader::Impl::depthIn(const Frame& stored) {
  if (isPacked() && info.packing != Packing::DepthAlone) {
    const bool in_yuv = stored.model == ColorModel::Yuv && packed.gray == GrayFrom::Luma;
    auto halves =
        in_yuv ? splitPacked(stored, info.packing, DepthCode::Hue, GrayFrom::Luma, packed.seam) : halvesOf(stored);
    if (!halves) return std::unexpected(halves.error());
    return std::move(halves->depth);
  }
  auto ordered = inOrder(stored, reordering.order);
  return ordered && registrar ? registrar->registered(*ordered) : std::move(ordered);
}

Result<void> PairReader::Impl::describeHalves(const StreamInfo& color) {
  const Frame look = scout.tellingPicture(color_ahead[0], options.url, color.index);
  const bool beside = info.packing == Packing::SideBySide || info.packing == Packing::SideBySideDepthFirst;
  packed.seam = beside ? whiteSeam(look) : 0;
  if (packed.seam > 0) {
    clues.why.push_back(print("the %d white columns between the halves are left out", packed.seam));
  }
  const auto whole = splitPacked(look, info.packing, DepthCode::Hue, GrayFrom::Luma, packed.seam);
  if (whole) lookForCode(whole->depth);
  if (whole && clues.code == DepthCode::Luma && options.as == nullptr) reordering.order = packedOrder(whole->depth);
  const auto seen = halvesOf(look);
  const auto halves = halvesOf(color_ahead[0]);
  if (!halves || !seen) return failOn(options.url, halves ? seen.error() : halves.error());
  info.color_width = halves->color.width;
  info.color_height = halves->color.height;
  // A half of YUV as it is still has its signalling and its chroma.
  const bool in_yuv = whole && look.model == ColorModel::Yuv && packed.gray == GrayFrom::Luma;
  const Frame& depth_look = in_yuv ? whole->depth : seen->depth;
  return describe(halves->depth, depth_look, seen->color, color);
}

// The size of the colour beside packed depth.
Result<void> PairReader::Impl::measureHalves() {
  if (!isPacked() || info.packing == Packing::DepthAlone) return {};
  const auto halves = halvesOf(color_ahead[0]);
  if (!halves) return failOn(options.url, halves.error());
  info.color_width = halves->color.width;
  info.color_height = halves->color.height;
  return {};
}

Result<void> PairReader::Impl::describeTrack(const Frame& first) {
  const StreamInfo& stream = depthStream();
  Result<Frame> look = scout.tellingPicture(first, depthUrl(), stream.index);
  // Another picture than `first` is still as it is stored.
  if (look->planes[0].data != first.planes[0].data) look = depthIn(*look);
  if (!look) return failOn(depthUrl(), look.error());
  const bool guessed = !sources.depth() && options.packing == Packing::Auto && !isMarkedAsDepth(stream);
  const bool colored = look->model != ColorModel::Gray && lookAt(*look).gray < kMostlyGray;
  if (guessed && options.as == nullptr && colored && areViews(color_ahead[0], *look)) {
    showViews(Packing::StereoTracks, "the film's two tracks are");
    return {};
  }
  lookForCode(*look);
  const bool photo = colored && clues.code == DepthCode::Luma && packedOrder(*look) == SampleOrder::AsStored;
  if (guessed && photo && !exchanged && !wants_exchange && lookAt(color_ahead[0]).gray >= kAllGray) {
    wants_exchange = true;
    return {};
  }
  return describe(first, *look, color_ahead[0], stream);
}

// Reads the tags of the depth's track and container.
void PairReader::Impl::takeTags(const StreamInfo& stream) {
  clues.tags = stream.tags;  // the track's tags override the container's
  const auto& container_tags = sources.depth() ? sources.depth()->tags() : sources.color()->source().tags();
  clues.tags.insert(container_tags.begin(), container_tags.end());
  const auto file = stream.tags.find(kFileTag);
  clues.path = file != stream.tags.end() ? file->second : depthUrl();
}

Result<void> PairReader::Impl::describe(const Frame& first, const Frame& look, const Frame& color,
                                        const StreamInfo& stream) {
  clues.packing = info.packing;
  clues.live = !isFile(depthUrl());
  clues.codec = stream.codec;
  takeTags(stream);
  if (registrar) {
    clues.tags.insert({{"DEPTH_UNIT", print("%.9g", registrar->registration().unit_mm)}, {"DEPTH_INVALID", "0"}});
    const auto by = options.registration ? CalibrationOrigin::SideFile : CalibrationOrigin::ContainerTags;
    clues.more.push_back({"registration", "to the colour's view", by});
  }
  if (stream.rotation != 0) {
    clues.more.push_back({"rotation", print("%d degrees", 90 * stream.rotation), CalibrationOrigin::StreamSignalling});
  }
  const auto tagged = materialFromTags(clues.tags);
  info.material = layered(options.material, tagged.value_or(Material{}));
  if (!info.material.empty()) {
    const auto by = options.material.empty() ? CalibrationOrigin::ContainerTags : CalibrationOrigin::CommandLine;
    clues.more.push_back({"material", materialText(info.material), by});
  }
  if (!info.material_scale.empty()) {
    clues.more.push_back(
        {"full codes of its material track", materialText(info.material_scale), CalibrationOrigin::ContainerTags});
  }
  const KnownKind* kind = reordering.kind != nullptr ? reordering.kind : kindOf(clues, look);
  auto meaning = readMeaning(clues, kind, look);
  if (!meaning) return failOn("calibration", meaning.error());
  reach_open = isReachSeen(meaning->calibration);
  if (reach_open) {
    const std::vector<Frame> later =
        scout.laterPictures(look.pts, stream.index, [this](const Frame& stored) { return depthIn(stored); });
    if (!later.empty() && reordering.kind == nullptr) kind = kindOf(clues, look, later);
    if (!later.empty()) meaning = readMeaning(clues, kind, look, later);
    if (!meaning) return failOn("calibration", meaning.error());
  }
  info.calibration = std::move(meaning->calibration);
  info.reading = std::move(meaning->reading);
  const bool by_author = clues.tags.contains(kReadAsTag);
  auto doubts = doubtsOf(look, info.calibration.calibration, color.empty() ? nullptr : &color, by_author);
  std::ranges::move(doubts, std::back_inserter(info.reading.doubts));
  if (!tagged) info.reading.doubts.push_back(print("its tag %s is left out: %s", kMaterialTag, tagged.error().message));
  if (material.refused() != nullptr) {
    info.reading.doubts.push_back(print("its material track is left out: %s", material.refused()));
  }
  info.has_depth = true;
  info.depth_width = first.width;
  info.depth_height = first.height;
  info.depth_codec = stream.codec;
  info.depth_decoder = isPacked()        ? info.color_decoder
                       : sources.depth() ? sources.depth()->decoder()
                                         : sources.color()->decoder(*depth_beside.track);
  return {};
}

// Reports, once, a picture that lies beyond near and far if these were guessed.
void PairReader::Impl::checkReach(const Frame& picture) {
  const auto beyond = beyondReach(picture, info.calibration.calibration);
  if (!beyond) return;
  reach_open = false;
  log(LogLevel::Warning, "media",
      "%s: at %.1f s %.0f %% of the depth is outside the range of the first pictures, and is flat: "
      "--calibration %s",
      depthUrl().c_str(), toSeconds(picture.pts.time_since_epoch()), beyond->percent, beyond->option.c_str());
}

}  // namespace relievo
