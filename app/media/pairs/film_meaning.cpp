// SPDX-License-Identifier: Apache-2.0
// The steps of finding a film's meaning, and what its depth means.
#include "app/media/pairs/film_meaning.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/media/folder/film_folder.h"
#include "app/media/pairs/depth_reach.h"
#include "app/media/reading/color_map_fit.h"
#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/near_end.h"
#include "app/media/reading/stereo/stereo_pair.h"
#include "app/media/registration/own_registration.h"
#include "hal/media/media_names.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kMostlyGray = 0.9, kAllGray = 0.99;

// The place of the second source; else of the first file of a recording's depth, if the recording has any.
RecordingPlace placeOf(const MediaSource& source, const std::string& url, const std::string& depth_url) {
  const StreamInfo* const depth = depth_url.empty() ? findDepthTrack(source) : nullptr;
  if (depth == nullptr) return lookAtPlace(url, depth_url);
  const auto tag = [depth](const char* key) {
    const auto found = depth->tags.find(key);
    return found != depth->tags.end() ? found->second : "";
  };
  return lookAtPlace(url, tag(kFileTag), tag(kLayoutTag));
}

}  // namespace

void FilmMeaning::begin() {
  const SourceOptions& options = film_.options;
  const MediaSource& source = film_.sources.color()->source();
  clues_ = {.command_line = options.command_line, .side_file = options.side_file, .as = options.as, .place = {}};
  form_ = {.order = options.as != nullptr ? options.as->order : SampleOrder::AsStored,
           .registrar = std::move(form_.registrar)};
  kind_ = nullptr;
  views_disproved_ = false;
  clues_.place = lookAtTags(source.tags());
  if (clues_.place.kind == nullptr) clues_.place = placeOf(source, options.url, options.depth_url);
  film_.info.reading = {};
  if (options.depth_code) {
    takeCode(*options.depth_code, CalibrationOrigin::CommandLine);
  } else if (options.as != nullptr && options.as->code) {
    takeCode(*options.as->code, CalibrationOrigin::StatedKind);
  }
}

void FilmMeaning::take(const FilmPlan& plan) {
  clues_.packing_by = plan.packing_by;
  clues_.why.insert(clues_.why.end(), plan.why.begin(), plan.why.end());
}

void FilmMeaning::takeCode(DepthCode code, CalibrationOrigin by) {
  clues_.code = form_.code = code;
  clues_.code_by = by;
}

Result<bool> FilmMeaning::readPicture(const StreamInfo& color, const std::deque<Frame>& pictures) {
  lookForHalves(color, pictures);
  if (!film_.isPacked()) return false;
  const auto described = film_.info.packing == Packing::DepthAlone ? describeAlone(color, pictures[0])
                                                                   : describeHalves(color, pictures[0]);
  if (!described) return std::unexpected(described.error());
  return true;
}

void FilmMeaning::lookForRegistration(const StreamInfo& color) {
  if (film_.options.registration) {
    form_.registrar.emplace(*film_.options.registration);
  } else if (const auto recorded = film_.depth_beside.track ? ownRegistration(film_.sources.color()->source(), color,
                                                                              *film_.depth_beside.stream)
                                                            : std::nullopt) {
    form_.registrar.emplace(*recorded);
    clues_.why.emplace_back("the recording describes both cameras: its depth is moved to the colour's view");
  }
}

Result<std::optional<Frame>> FilmMeaning::findOrder(const Frame& first) {
  if (form_.registrar) return std::nullopt;
  if (form_.order != SampleOrder::AsStored) return statedOrder(first);
  const StreamInfo& stream = film_.depthStream();
  takeTags(stream);
  const Frame look = scout_.tellingPicture(first, film_.depthUrl(), stream.index);
  const KnownKind* const kind = kindOf(clues_, look);
  const SampleOrder order = kind != nullptr && kind->order != SampleOrder::AsStored ? kind->order : orderOf(kind, look);
  if (order == SampleOrder::AsStored) return std::nullopt;
  kind_ = kind;
  form_.order = order;
  return first;
}

// Of a stated kind, whose reader may already have put the samples in order.
Result<std::optional<Frame>> FilmMeaning::statedOrder(const Frame& first) {
  const KnownKind* const as = film_.options.as;
  if (as == nullptr || form_.order != SampleOrder::Swapped) return std::nullopt;
  auto stored = inOrder(first, SampleOrder::Swapped);  // back
  if (!stored) return std::unexpected(stored.error());
  form_.order = orderOf(*as, *stored);
  if (form_.order != SampleOrder::AsStored) return std::nullopt;
  return std::move(*stored);
}

Result<void> FilmMeaning::readTrack(const Frame& first, const Frame& color) {
  const StreamInfo& stream = film_.depthStream();
  Result<Frame> look = scout_.tellingPicture(first, film_.depthUrl(), stream.index);
  // Another picture than `first` is still as it is stored.
  if (look->planes[0].data != first.planes[0].data) look = form_.depthIn(*look, film_.info.packing);
  if (!look) return film_.failOn(film_.depthUrl(), look.error());
  const SourceOptions& options = film_.options;
  const bool guessed = !film_.sources.depth() && options.packing == Packing::Auto && !isMarkedAsDepth(stream);
  const bool colored = look->model != ColorModel::Gray && lookAt(*look).gray < kMostlyGray;
  if (guessed && options.as == nullptr && colored && areViews(color, *look)) {
    showViews(Packing::StereoTracks, "the film's two tracks are");
    return {};
  }
  lookForColors(*look);
  const bool photo = colored && clues_.code == DepthCode::Luma && packedOrder(*look) == SampleOrder::AsStored;
  if (guessed && photo && !film_.exchanged && !wants_exchange_ && lookAt(color).gray >= kAllGray) {
    wants_exchange_ = true;
    return {};
  }
  return describe(first, *look, color, stream);
}

// Reads the tags of the depth's track and container.
void FilmMeaning::takeTags(const StreamInfo& stream) {
  clues_.tags = stream.tags;  // the track's tags override the container's
  const DepthSource* const depth = film_.sources.depth();
  const auto& container_tags = depth != nullptr ? depth->tags() : film_.sources.color()->source().tags();
  clues_.tags.insert(container_tags.begin(), container_tags.end());
  const auto file = stream.tags.find(kFileTag);
  clues_.path = file != stream.tags.end() ? file->second : film_.depthUrl();
}

// What else is told of the depth.
void FilmMeaning::takeExtras(const StreamInfo& stream) {
  if (form_.registrar) {
    clues_.tags.insert(
        {{"DEPTH_UNIT", print("%.9g", form_.registrar->registration().unit_mm)}, {"DEPTH_INVALID", "0"}});
    const auto by = film_.options.registration ? CalibrationOrigin::SideFile : CalibrationOrigin::ContainerTags;
    clues_.more.push_back({"registration", "to the colour's view", by});
  }
  if (stream.rotation != 0) {
    clues_.more.push_back({"rotation", print("%d degrees", 90 * stream.rotation), CalibrationOrigin::StreamSignalling});
  }
}

void FilmMeaning::takeMaterial(const Result<Material>& tagged) {
  FilmInfo& info = film_.info;
  const Material& stated = film_.options.material;
  info.material = layered(stated, tagged.value_or(Material{}));
  if (!info.material.empty()) {
    const auto by = stated.empty() ? CalibrationOrigin::ContainerTags : CalibrationOrigin::CommandLine;
    clues_.more.push_back({"material", materialText(info.material), by});
  }
  if (!info.material_scale.empty()) {
    clues_.more.push_back(
        {"full codes of its material track", materialText(info.material_scale), CalibrationOrigin::ContainerTags});
  }
}

// By the first pictures; if these leave near and far open, by later ones too.
Result<DepthMeaning> FilmMeaning::meaningOf(const Frame& look, const StreamInfo& stream) {
  const KnownKind* kind = kind_ != nullptr ? kind_ : kindOf(clues_, look);
  auto meaning = readMeaning(clues_, kind, look);
  if (!meaning) return meaning;
  reach_open_ = isReachSeen(meaning->calibration);
  if (!reach_open_) return meaning;
  const auto depth_in = [this](const Frame& stored) { return form_.depthIn(stored, film_.info.packing); };
  const std::vector<Frame> later = scout_.laterPictures(look.pts, stream.index, depth_in);
  if (later.empty()) return meaning;
  if (kind_ == nullptr) kind = kindOf(clues_, look, later);
  return readMeaning(clues_, kind, look, later);
}

Result<void> FilmMeaning::describe(const Frame& first, const Frame& look, const Frame& color,
                                   const StreamInfo& stream) {
  FilmInfo& info = film_.info;
  clues_.packing = info.packing;
  clues_.live = !isFile(film_.depthUrl());
  clues_.codec = stream.codec;
  clues_.single = isStill(stream);
  takeTags(stream);
  takeExtras(stream);
  const auto tagged = materialFromTags(clues_.tags);
  takeMaterial(tagged);
  auto meaning = meaningOf(look, stream);
  if (!meaning) return film_.failOn("calibration", meaning.error());
  info.calibration = std::move(meaning->calibration);
  info.reading = std::move(meaning->reading);
  const bool by_author = clues_.tags.contains(kReadAsTag);
  auto doubts = doubtsOf(look, info.calibration.calibration, color.empty() ? nullptr : &color, by_author);
  std::ranges::move(doubts, std::back_inserter(info.reading.doubts));
  if (!tagged) info.reading.doubts.push_back(print("its tag %s is left out: %s", kMaterialTag, tagged.error().message));
  info.has_depth = true;
  info.depth_width = first.width;
  info.depth_height = first.height;
  info.depth_codec = stream.codec;
  info.depth_decoder = film_.isPacked()        ? info.color_decoder
                       : film_.sources.depth() ? film_.sources.depth()->decoder()
                                               : film_.sources.color()->decoder(*film_.depth_beside.track);
  return {};
}

void FilmMeaning::checkReach(const Frame& depth) {
  if (!reach_open_ || depth.empty()) return;
  const auto beyond = beyondReach(depth, film_.info.calibration.calibration);
  if (!beyond) return;
  reach_open_ = false;
  log(LogLevel::Warning, "media",
      "%s: at %.1f s %.0f %% of the depth is outside the range of the first pictures, and is flat%s%s",
      film_.depthUrl().c_str(), toSeconds(depth.pts.time_since_epoch()), beyond->percent,
      beyond->option.empty() ? "" : ": ", beyond->option.c_str());
}

void FilmMeaning::close() noexcept {
  form_ = {};
  kind_ = nullptr;
  wants_exchange_ = reach_open_ = false;
}

}  // namespace relievo
