// SPDX-License-Identifier: Apache-2.0
// Leaves out pictures that this machine cannot decode in time, and keeps the depth between them.
#include <utility>

#include "app/media/pair_reader.h"
#include "app/media/pairs/pair_film.h"

namespace relievo {

void PairReader::leaveOut(bool unreferenced, std::optional<MediaTime> until) {
  Impl& film = *impl_;
  if (!film.sources.color() || film.live || film.key_step != Duration(0)) return;
  if (unreferenced || until) film.left_out.begin();
  film.sources.color()->leaveOutUnreferenced(unreferenced);
  // If this fails, reading the next picture fails as well and reports it.
  if (until) static_cast<void>(film.sources.color()->hurryTo(*until - film.color_shift));
}

bool PairReader::waitsForSource() const noexcept {
  return impl_->sources.waitsForColor(impl_->remote ? nullptr : impl_->backends.clock);
}

// Depth of a time between the last colour picture and this one, if pictures between them were left out.
std::optional<FramePair> PairReader::Impl::depthBefore(const Frame& color) {
  const Duration period = info.frame_period;
  if (!left_out.areBefore(color.pts, period)) return std::nullopt;
  if (!depth || info.packing != Packing::Tracks || own.lost) return std::nullopt;
  const auto next = depth->peek();
  if (!next || *next == nullptr) return std::nullopt;
  const MediaTime time = (*next)->pts;
  if (time <= left_out.lastPair() || time > color.pts - period / 2) return std::nullopt;
  auto match = depthAt(time);
  if (!match || match->depth.empty()) return std::nullopt;
  FramePair pair;
  pair.color.pts = time;
  pair.depth = std::move(match->depth);
  pair.stands = true;
  return pair;
}

}  // namespace relievo
