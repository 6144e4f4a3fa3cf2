// SPDX-License-Identifier: Apache-2.0
// Reads a film's pairs, makes their depth where it is to be made, and hands them to the packager.
#include <condition_variable>
#include <mutex>
#include <thread>

#include "app/author/author.h"
#include "app/author/package/film_kind.h"
#include "app/author/package/output.h"
#include "app/author/package/packager.h"
#include "app/author/views/stereo_film.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Error kCancelled{ErrorCode::Cancelled, 0, "interrupted; nothing was written"};

// Interrupts a reader that waits for a disk or a network when the program is to stop.
class StopWatch {
 public:
  StopWatch(PairReader& reader, const std::atomic<bool>& stop)
      : thread_([&reader, &stop, this](const std::stop_token& done) {
          std::unique_lock lock(mutex_);
          while (!done.stop_requested()) {
            if (stop.load(std::memory_order_relaxed)) return reader.interrupt();
            wake_.wait_for(lock, done, std::chrono::milliseconds(50), [] { return false; });
          }
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace

Outcome<AuthorSummary> authorFilm(const SourceOptions& source, const PairReader::Backends& backends,
                                  const OutputOptions& output, const std::atomic<bool>& stop,
                                  const ProgressReport& progress) {
  if (auto ready = checkOutput(output); !ready) return failOn(output.path, ready.error());
  if (auto ready = checkPreview(output); !ready) return failOn(output.preview, ready.error());
  std::optional<StereoFilm> views;
  if (output.from_views) {
    auto surveyed = StereoFilm::survey(source, backends, *output.from_views, stop, progress);
    if (!surveyed) return std::unexpected(surveyed.error());
    views = std::move(*surveyed);
  }
  PairReader reader(backends);
  const StopWatch watch(reader, stop);
  const auto failed = [&](const std::string& thing, const Error& error) {
    if (stop.load(std::memory_order_relaxed)) return failOn(output.path, kCancelled);
    return failOn(thing, error);
  };
  if (auto opened = reader.open(views ? views->source() : source); !opened)
    return failed(reader.failedThing(), opened.error());
  FilmInfo info = views ? views->described(reader.info()) : reader.info();
  if (!info.has_depth) {
    const char* const what = isStereo(info.packing) ? "two views without depth; --depth-from stereo makes it from them"
                                                    : "no depth in this source; give --depth SOURCE";
    return failOn(source.url, {ErrorCode::NotFound, 0, what});
  }
  Packager packager(reader, backends, std::move(info), source, output);
  bool live = false;  // ends on request or when its camera is unplugged, and is complete then
  for (std::uint64_t done = 1;; ++done) {
    auto pair = reader.next();
    if (stop.load(std::memory_order_relaxed)) {
      if (live || (packager.begun() && filmKindOf(output.path) == FilmKind::Live)) break;
      return failOn(output.path, kCancelled);
    }
    if (!pair && live && reader.isSourceLost(pair.error())) {
      log(LogLevel::Warning, source.url.c_str(), "%s; the film ends there", pair.error().message);
      break;
    }
    if (!pair) return failed(reader.failedThing(), pair.error());
    if (!*pair) break;
    if (views) {
      auto made = views->withDepth(std::move(**pair));
      if (!made) return failed(source.url, made.error());
      *pair = std::move(*made);
    }
    live = (*pair)->taken.has_value();
    if (!packager.begun()) {
      if (auto begun = packager.begin(**pair); !begun) return failed(begun.error().thing, begun.error().error);
    }
    if (auto written = packager.write(**pair); !written) return failed(written.error().thing, written.error().error);
    progress(done, expectedFrames(reader.info()));
  }
  auto summary = packager.finish();
  if (summary && views) summary->notes.insert(summary->notes.begin(), views->notes().begin(), views->notes().end());
  return summary;
}

}  // namespace relievo
