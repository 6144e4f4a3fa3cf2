// SPDX-License-Identifier: Apache-2.0
// Opens a film step by step, and aligns the clocks of two sources.
#include <algorithm>
#include <utility>

#include "app/media/frame_rate.h"
#include "app/media/pairs/pair_film.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kSameClock = std::chrono::seconds(20);   // two streams of one sender differ by less than this
constexpr Duration kLongestWait = std::chrono::seconds(5);  // for the depth of a live film to begin
// Pictures whose names are from one clock or one count keep their distance if most of the shorter series lies within
// the other; else the two begin together.
Duration distanceByName(const MediaSource& color, const DepthSource::Session& depth) {
  const bool known = color.namedStart() && depth.named_start && color.duration() > Duration(0);
  if (!known || depth.duration == Duration(0)) return Duration(0);
  const Duration distance = *depth.named_start - *color.namedStart();
  const Duration common = std::min(color.duration(), distance + depth.duration) - std::max(Duration(0), distance);
  return 2 * common >= std::min(color.duration(), depth.duration) ? distance : Duration(0);
}

}  // namespace

// Opens for the first time or again. In the second case a separate depth source has continued meanwhile, and what one
// picture holds beside its colour stays: its first picture may be dark now, and its tags may come later.
Result<void> PairReader::Impl::openFilm() {
  if (auto opened = inputs.open(); !opened) return opened;
  const bool known = depth || isInOnePicture();
  if (!known) meaning.begin();
  const auto plan = planFilm(*this, scout, meaning.place());
  if (!plan) return failOn(options.url, plan.error());
  meaning.take(*plan);
  if (!known || info.packing == Packing::Tracks) info.packing = plan->tracks.packing;
  if (auto selected = inputs.select(plan->tracks); !selected) return selected;
  if (depth_beside.refused) loseDepth(*depth_beside.refused);
  const StreamInfo& color = *plan->tracks.color;
  const StreamInfo* const of_places = plan->tracks.material;
  material.select(*sources.color(), of_places ? std::optional(asTold(*of_places)) : std::nullopt, color_shift);
  if (!known || info.has_depth) info.material_scale = withoutThoseOf(options.material, material.scale());
  words.openSound();
  words.openWords();
  if (auto opened = openColor(color); !opened) return opened;
  if (known && isInOnePicture()) return meaning.measureHalves(color_ahead[0]);
  if (auto opened = openDepth(color); !opened) return opened;
  if (!known && info.has_depth && material.refused() != nullptr) {
    info.reading.doubts.push_back(print("its material track is left out: %s", material.refused()));
  }
  meaning.readViews(color, color_ahead);
  if (!info.has_depth) info.material_scale = {};
  return {};
}

// Decodes two pictures, whose timestamps give the frame period.
Result<void> PairReader::Impl::openColor(const StreamInfo& color) {
  while (color_ahead.size() < 2) {
    auto frame = readColor();
    if (!frame) return failOn(options.url, frame.error());
    if (!*frame) break;
    color_ahead.push_back(std::move(**frame));
  }
  if (color_ahead.empty()) return failOn(options.url, kNoPicture);
  info.color_width = color_ahead[0].width;
  info.color_height = color_ahead[0].height;
  info.color_stream = color.index;
  info.color_codec = color.codec;
  info.color_decoder = sources.color()->decoder(kColorTrack);
  if (color_ahead.size() == 2) info.frame_period = framePeriod(color_ahead[1].pts - color_ahead[0].pts, color);
  info.interlaced = sources.color()->deinterlaced() > 0;
  info.color_primaries = color_ahead[0].primaries;
  info.color_transfer = color_ahead[0].transfer;
  const bool depth_is_counted = sources.depth() && sources.depth()->stream().counted;
  if (options.frames_per_s && !color.counted && !depth_is_counted) {
    info.notes.emplace_back("--fps has no effect: the pictures have times of their own");
  }
  return {};
}

Result<void> PairReader::Impl::openDepth(const StreamInfo& color) {
  const auto in_picture = meaning.readPicture(color, color_ahead);
  if (!in_picture) return std::unexpected(in_picture.error());
  if (*in_picture) return {};
  if (!depth_beside.track && !sources.depth()) return {};
  if (depth) {  // already known from the first opening
    depth->restart();
    own.lost = false;
    return {};
  }
  if (info.packing == Packing::StereoTracks) {
    depth.emplace([this] { return supplyDepth(); });
    meaning.takeViewTracks();
    return {};
  }
  meaning.lookForRegistration(color);
  depth.emplace([this] { return supplyDepth(); });
  const auto first = firstDepth();
  if (first && *first != nullptr) {
    if (!sources.depth()) return meaning.readTrack(**first, color_ahead[0]);
    const MediaTime begins = (*first)->pts;
    auto described = meaning.readTrack(**first, color_ahead[0]);
    // With two live sources the second opens later; pictures of the first from before that are dropped.
    const bool later = described && live && begins > MediaTime{} && begins < MediaTime(kLongestWait);
    if (!later) return described;
    if (auto passed = passTo(begins); !passed) return std::unexpected(passed.error());
    return {};
  }
  const Error missing = first ? kNoPicture : first.error();
  if (isDepthRequired() || missing.code == ErrorCode::Cancelled) return failOn(depthUrl(), missing);
  loseDepth(missing);
  depth_beside.track.reset();
  depth.reset();
  return {};
}

// The next depth picture with its samples in order; the order may be found only from the picture itself.
Result<const Frame*> PairReader::Impl::firstDepth() {
  auto first = depth->peek();
  if (!first || *first == nullptr) return first;
  auto stored = meaning.findOrder(**first);
  if (!stored) return std::unexpected(stored.error());
  if (!*stored) return first;
  depth_again = std::move(**stored);
  depth.emplace([this] { return supplyDepth(); });
  return depth->peek();
}

// Computes the shift that aligns a new session of the depth source with the colour.
void PairReader::Impl::meet(const DepthSource::Session& session, MediaTime first) {
  if (own.session) depth->restart();
  own.session = session.number;
  const MediaSource& color = sources.color()->source();
  own.shift = session.live ? Duration(0) : distanceByName(color, session);
  if (!session.live) return;
  if (!color.live()) {  // align what arrives now with what is shown now
    own.shift = goes_on_at - first;
    return;
  }
  const Duration by_arrival = session.arrival - color.arrival();
  Duration distance = by_arrival;
  if (session.sender_start && color.senderStart()) {
    const Duration by_sender = *session.sender_start - *color.senderStart();
    if (std::chrono::abs(by_sender - by_arrival) < kSameClock) distance = by_sender;
  }
  own.shift = distance + color_shift;
}

}  // namespace relievo
