// SPDX-License-Identifier: Apache-2.0
// Leaves out pictures that this machine cannot decode in time, and keeps the depth between them.
#include <cmath>
#include <utility>

#include "app/media/pairs/pair_film.h"
#include "app/media/pair_reader.h"

namespace relievo {
namespace {

constexpr Duration kStall = std::chrono::milliseconds(300);  // a file's read that takes longer is not the machine's
constexpr double kGap = 1.5;                                 // of the frame period, from which on a picture is missing

}  // namespace

void PairReader::leaveOut(bool unreferenced, std::optional<MediaTime> until) {
  Impl& film = *impl_;
  if (!film.color_reader || film.live || film.key_step != Duration(0)) return;
  film.leaves_out = film.leaves_out || unreferenced || until;
  film.color_reader->leaveOutUnreferenced(unreferenced);
  // What fails here fails again when the next picture is read.
  if (until) static_cast<void>(film.color_reader->hurryTo(*until - film.color_shift));
}

// A file is read by a thread of its own, which waits for a processor as any other does.
bool PairReader::waitsForSource() const noexcept {
  const std::scoped_lock lock(impl_->readers_mutex);
  const bool waits = impl_->color_reader && impl_->color_reader->waitsForSource();
  if (impl_->remote || impl_->backends.clock == nullptr) return waits;
  const MonotonicTime now = impl_->backends.clock->now();
  if (!waits) impl_->waits_since.reset();
  else if (!impl_->waits_since) impl_->waits_since = now;
  return waits && now >= *impl_->waits_since + kStall;
}

// The depth of a time between the last colour picture and this one, where pictures between them were left out.
std::optional<FramePair> PairReader::Impl::depthBefore(const Frame& color) {
  if (!leaves_out || !last_color || !depth || info.packing != Packing::Tracks || own.lost) return std::nullopt;
  const Duration period = info.frame_period;
  if (toSeconds(color.pts - *last_color) < kGap * toSeconds(period)) return std::nullopt;
  const auto next = depth->peek();
  if (!next || *next == nullptr) return std::nullopt;
  const MediaTime time = (*next)->pts;
  if (time <= last_pair.value_or(*last_color) || time > color.pts - period / 2) return std::nullopt;
  auto match = depthAt(time);
  if (!match || match->depth.empty()) return std::nullopt;
  FramePair pair;
  pair.color.pts = time;
  pair.depth = std::move(match->depth);
  pair.stands = true;
  return pair;
}

void PairReader::Impl::countLeftOut(const FramePair& pair) noexcept {
  last_pair = pair.color.pts;
  if (pair.stands) return;
  if (leaves_out && last_color && info.frame_period > Duration(0)) {
    const double steps = toSeconds(pair.color.pts - *last_color) / toSeconds(info.frame_period);
    if (steps > kGap) counters.left_out += static_cast<std::uint64_t>(std::lround(steps) - 1);
  }
  last_color = pair.color.pts;
}

}  // namespace relievo
