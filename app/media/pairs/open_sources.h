// SPDX-License-Identifier: Apache-2.0
// The sources of an open film: used by one thread, interrupted by any.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "app/media/depth_source.h"
#include "app/media/tracks/track_reader.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

class OpenSources {
 public:
  // Null if there is none. `depth` is depth from a source of its own.
  [[nodiscard]] TrackReader* color() const noexcept { return color_.get(); }
  [[nodiscard]] DepthSource* depth() const noexcept { return depth_.get(); }

  // Takes over a source that is not open yet, so that opening it can be interrupted. Cancelled, without taking it, if
  // an interrupt has come since `allow`.
  [[nodiscard]] Result<void> take(std::unique_ptr<TrackReader> color);
  [[nodiscard]] Result<void> take(std::unique_ptr<DepthSource> depth);
  void allow() noexcept;
  void dropDepth() noexcept;
  void close() noexcept;

  // Any thread: makes blocked calls of the sources, and of those to come, return Cancelled.
  void interrupt() noexcept;
  // Any thread: true if interrupted since `allow`. For work outside the sources.
  [[nodiscard]] bool interrupted() noexcept;
  // Any thread: true while the colour's source is waited for. Pass `file_clock` for a file: then only a long wait
  // counts, since the thread that reads a file may just be waiting for a processor.
  [[nodiscard]] bool waitsForColor(const Clock* file_clock) noexcept;

 private:
  std::mutex mutex_;  // guards what follows against the other threads
  bool interrupted_ = false;
  std::unique_ptr<TrackReader> color_;
  std::unique_ptr<DepthSource> depth_;
  std::optional<MonotonicTime> waits_since_;
};

}  // namespace relievo
