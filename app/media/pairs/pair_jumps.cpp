// SPDX-License-Identifier: Apache-2.0
// Seeks in a film, and resumes it after its source was lost.
#include <utility>

#include "app/media/pairs/pair_film.h"

namespace relievo {

// Drops the colour pictures before the target, and reads the depth along so that its packets do not pile up. Returns
// the last of them.
Result<std::optional<Frame>> PairReader::Impl::passTo(MediaTime target) {
  std::optional<Frame> last;
  for (;;) {
    auto color = nextColor();
    if (!color) return std::unexpected(color.error());
    if (!*color) return last;
    if ((*color)->pts >= target) {
      color_ahead.push_front(std::move(**color));
      return last;
    }
    if (auto passed = depthAt((*color)->pts); !passed) return std::unexpected(passed.error());
    static_cast<void>(materialAt((*color)->pts));
    last = std::move(*color);
  }
}

// Whether the picture before the target is the one to show there: the next is far, or only sound is left.
bool PairReader::Impl::isGap(MediaTime target) const {
  if (key_step != Duration(0)) return false;
  if (color_ahead.empty()) return target < MediaTime(info.duration);
  return color_ahead.front().pts > target + info.frame_period * 5 / 4;  // containers round their timestamps
}

// Call after the colour was sought, and with it a depth track of the same source.
Result<void> PairReader::Impl::seekDepth(MediaTime target) {
  material.restart();
  if (!depth) return {};
  depth->restart();
  own.lost = false;
  if (!sources.depth()) return {};
  const auto sought = sources.depth()->seek(target - own.shift, key_step);
  if (sought) return {};
  if (sought.error().code == ErrorCode::Cancelled) return failOn(depthUrl(), sought.error());
  loseDepth(sought.error());
  return {};
}

// Resumes with the picture after the last one; a separate depth source has kept its position.
Result<void> PairReader::Impl::goOn() {
  const MediaTime target = goes_on_at - info.frame_period / 2;  // containers round their timestamps
  if (auto sought = sources.color()->seek(target, key_step); !sought) return failOn(options.url, sought.error());
  color_ahead.clear();
  if (depth_beside.track) depth->restart();
  material.restart();
  if (auto passed = passTo(target); !passed) return std::unexpected(passed.error());
  return {};
}

// Closes the colour source but keeps its counters.
void PairReader::Impl::leaveColor() {
  counters.damaged += sources.color()->damaged();
  counters.deinterlaced += sources.color()->deinterlaced();
  counters.jumps += sources.color()->source().jumps();
  counters.missed_pictures += sources.color()->source().missedPictures();
  color_ahead.clear();
}

Result<void> PairReader::seek(MediaTime target, Duration key_step) {
  if (!impl_->sources.color()) return fail(ErrorCode::InvalidState, Impl::kNotOpen);
  if (auto sought = impl_->sources.color()->seek(target, key_step); !sought) {
    return impl_->failOn(impl_->options.url, sought.error());
  }
  impl_->goes_on_at = target;  // if it is lost before the next pair
  impl_->color_ahead.clear();
  impl_->left_out.jump();
  impl_->key_step = key_step;
  if (auto sought = impl_->seekDepth(target); !sought) return sought;
  auto passed = impl_->passTo(target);
  if (!passed) return std::unexpected(passed.error());
  if (*passed && impl_->isGap(target)) impl_->color_ahead.push_front(std::move(**passed));
  return {};
}

Result<void> PairReader::reopen() {
  Impl& film = *impl_;
  if (!film.sources.color()) return fail(ErrorCode::InvalidState, Impl::kNotOpen);
  film.leaveColor();
  film.color_shift = Duration(0);
  if (auto opened = film.openFilm(); !opened) return opened;
  ++film.counters.reconnects;
  if (!film.live) return film.goOn();
  film.color_shift = film.goes_on_at - film.color_ahead.front().pts;
  for (Frame& frame : film.color_ahead) frame.pts += film.color_shift;
  film.own.session.reset();  // because the colour's shift has changed
  return {};
}

}  // namespace relievo
