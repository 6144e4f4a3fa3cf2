// SPDX-License-Identifier: Apache-2.0
// Reads the pictures of an open film in order and pairs them.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "app/media/depth_follower.h"
#include "app/media/pairs/left_out_pictures.h"
#include "app/media/pairs/material_pictures.h"
#include "app/media/pairs/open_film.h"
#include "app/media/pairs/stored_form.h"

namespace relievo {

// `form`: how the pictures hold their depth; it may change until the first pair.
class PairSupply {
 public:
  PairSupply(OpenFilm& film, StoredForm& form) : film_(film), form_(form) {}

  // While the film is opened, for the first time or again. The first two pictures, whose timestamps give the frame
  // period; `color`: their stream.
  [[nodiscard]] Result<void> readFirst(const StreamInfo& color);
  // Read, not yet delivered.
  [[nodiscard]] const std::deque<Frame>& pictures() const noexcept { return color_ahead_; }
  // The material track; null if there is none.
  void selectMaterial(const StreamInfo* track) {
    material_.select(*film_.sources.color(), track ? std::optional(film_.asTold(*track)) : std::nullopt, color_shift_);
  }
  [[nodiscard]] const MaterialPictures& material() const noexcept { return material_; }
  // The depth has a stream of its own.
  void followDepth();
  // Two files with as many pictures each are paired by their numbers, although their rates differ. Before the depth is
  // followed.
  void pairByCount(const StreamInfo& color);
  [[nodiscard]] bool followsDepth() const noexcept { return depth_.has_value(); }
  void goOnWithDepth() noexcept;  // after the film was opened again
  void dropDepth() noexcept;
  // The next depth picture, not consumed; null if there is none.
  [[nodiscard]] Result<const Frame*> firstDepth() { return depth_->peek(); }
  // Begins again with this picture, as it is stored: the order of its samples is known only now.
  void beginAgainWith(Frame depth);
  // Depth that is there, but cannot be read from here on: told once.
  void loseDepth(const Error& error);

  // As PairReader's functions.
  [[nodiscard]] Result<std::optional<FramePair>> next();
  [[nodiscard]] Result<void> seek(MediaTime target, Duration key_step);
  void leaveOut(bool unreferenced, std::optional<MediaTime> until);
  [[nodiscard]] PairCounters counters() const noexcept;
  // Drops the colour pictures before the target, and reads the depth along so that its packets do not pile up. Returns
  // the last of them.
  Result<std::optional<Frame>> passTo(MediaTime target);

  // Before the lost film is opened again: keeps its counters. Afterwards the film goes on after the last picture.
  void leave();
  [[nodiscard]] Result<void> goOn();
  // Added to the session's timestamps to get the film's.
  [[nodiscard]] Duration shift() const noexcept { return color_shift_; }
  void close() noexcept;

 private:
  [[nodiscard]] Result<std::optional<Frame>> readColor();
  [[nodiscard]] Result<std::optional<Frame>> nextColor();
  [[nodiscard]] Result<DepthFollower::Supplied> supplyDepth();
  [[nodiscard]] Result<DepthFollower::Supplied> supplyOwnDepth();
  [[nodiscard]] Result<FramePair> pairFor(Frame color);
  [[nodiscard]] Result<DepthFollower::Match> depthAt(MediaTime time);
  [[nodiscard]] Frame materialAt(MediaTime time);
  // In supply_jumps.cpp: pictures left out, seeking, and going on after a loss.
  [[nodiscard]] std::optional<FramePair> depthBefore(const Frame& color);
  [[nodiscard]] bool isGap(MediaTime target) const;
  [[nodiscard]] Result<void> seekDepth(MediaTime target);
  [[nodiscard]] Result<void> goOnInFile();
  void meet(const DepthSource::Session& session, MediaTime first);
  [[nodiscard]] static MediaTime stretched(MediaTime time, double by) noexcept {
    return by == 1 ? time : mediaTime(toSeconds(time.time_since_epoch()) * by);
  }

  OpenFilm& film_;
  StoredForm& form_;
  PairCounters counters_;
  std::deque<Frame> color_ahead_;
  Duration color_shift_{0};
  MediaTime goes_on_at_;  // film time just after the last colour picture
  std::optional<DepthFollower> depth_;
  std::optional<Frame> depth_again_;  // a picture that was supplied before its order was known
  // Of `sources.depth()`, which reads `depth_url`.
  struct OwnDepth {
    double stretch = 1;                    // by which the session's timestamps are multiplied first
    Duration shift{0};                     // added to the session's timestamps to get the film's
    std::optional<std::uint32_t> session;  // the session that `shift` applies to
    bool away = false;                     // late or lost, and being retried
    bool lost = false, loss_told = false;
  };
  OwnDepth own_;
  MaterialPictures material_;
  Duration key_step_{0};  // of the last seek
  LeftOutPictures left_out_;
};

}  // namespace relievo
