// SPDX-License-Identifier: Apache-2.0
// Opens a film, step by step.
#include <utility>

#include "app/media/pairs/film_plan.h"
#include "app/media/pairs/pair_film.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kLongestWait = std::chrono::seconds(5);  // for the depth of a live film to begin

}  // namespace

Result<void> PairReader::Impl::openFilm() {
  FilmInfo& info = film.info;
  if (auto opened = inputs.open(); !opened) return opened;
  const bool known = supply.followsDepth() || film.isInOnePicture();
  if (!known) meaning.begin();
  const auto plan = planFilm(film, scout, meaning.place());
  if (!plan) return film.failOn(film.options.url, plan.error());
  meaning.take(*plan);
  if (!known || info.packing == Packing::Tracks) info.packing = plan->tracks.packing;
  if (auto selected = inputs.select(plan->tracks); !selected) return selected;
  if (film.depth_beside.refused) supply.loseDepth(*film.depth_beside.refused);
  const StreamInfo& color = *plan->tracks.color;
  supply.selectMaterial(plan->tracks.material);
  const MaterialPictures& material = supply.material();
  if (!known || info.has_depth) info.material_scale = withoutThoseOf(film.options.material, material.scale());
  words.openSound();
  words.openWords();
  if (auto opened = supply.readFirst(color); !opened) return opened;
  if (known && film.isInOnePicture()) return meaning.measureHalves(supply.pictures()[0]);
  if (auto opened = openDepth(color); !opened) return opened;
  if (!known && info.has_depth && material.refused() != nullptr) {
    info.reading.doubts.push_back(print("its material track is left out: %s", material.refused()));
  }
  meaning.readViews(color, supply.pictures());
  if (!info.has_depth) info.material_scale = {};
  return {};
}

Result<void> PairReader::Impl::openDepth(const StreamInfo& color) {
  const auto in_picture = meaning.readPicture(color, supply.pictures());
  if (!in_picture) return std::unexpected(in_picture.error());
  if (*in_picture || (!film.depth_beside.track && !film.sources.depth())) return {};
  if (supply.followsDepth()) {  // already known from the first opening
    supply.goOnWithDepth();
    return {};
  }
  if (film.info.packing == Packing::StereoTracks) {
    supply.followDepth();
    meaning.takeViewTracks();
    return {};
  }
  return openOwnDepth(color);
}

Result<void> PairReader::Impl::openOwnDepth(const StreamInfo& color) {
  meaning.lookForRegistration(color);
  supply.pairByCount(color);
  supply.followDepth();
  const auto first = firstDepth();
  if (first && *first != nullptr) {
    const MediaTime begins = (*first)->pts;
    auto described = meaning.readTrack(**first, supply.pictures()[0]);
    // With two live sources the second opens later; pictures of the first from before that are dropped.
    const bool late = film.live && begins > MediaTime{} && begins < MediaTime(kLongestWait);
    if (!described || !film.sources.depth() || !late) return described;
    if (auto passed = supply.passTo(begins); !passed) return std::unexpected(passed.error());
    return {};
  }
  const Error missing = first ? OpenFilm::kNoPicture : first.error();
  if (film.isDepthRequired() || missing.code == ErrorCode::Cancelled) return film.failOn(film.depthUrl(), missing);
  supply.loseDepth(missing);
  supply.dropDepth();
  film.depth_beside.track.reset();
  return {};
}

// The next depth picture with its samples in order; the order may be found only from the picture itself.
Result<const Frame*> PairReader::Impl::firstDepth() {
  const auto first = supply.firstDepth();
  if (!first || *first == nullptr) return first;
  auto stored = meaning.findOrder(**first);
  if (!stored) return std::unexpected(stored.error());
  if (!*stored) return first;
  supply.beginAgainWith(std::move(**stored));
  return supply.firstDepth();
}

void PairReader::Impl::close() noexcept {
  supply.close();
  meaning.close();
  words.close();
  film.close();
}

}  // namespace relievo
