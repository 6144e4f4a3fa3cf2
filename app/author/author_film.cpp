// SPDX-License-Identifier: Apache-2.0
// Reads the pairs of a film, makes their depth if they have none, and hands them to the packager.
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "app/author/author.h"
#include "app/author/package/film_kind.h"
#include "app/author/package/output.h"
#include "app/author/package/packager.h"
#include "app/author/views/estimated_film.h"
#include "app/author/views/stereo_film.h"
#include "app/media/pairs/long_wait.h"
#include "app/media/photo_list.h"
#include "platform/files/file_system_answer.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Error kOtherSize{ErrorCode::Unsupported, 0, "the picture size changes; split the film there"};
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

Error withoutDepth(const SourceOptions& source, Packing packing, const PairReader::Backends& backends) {
  const char* line =
      "no depth in this source; give --depth SOURCE, --packing depth-alone if the picture is depth, or let "
      "--depth-from guess it";
  if (photosIn(source, backends.make_source))
    line = "these are photos that hold their depth or two views each; name one of them";
  else if (hasTwoViews(packing)) line = "two views without depth; --depth-from stereo makes it from them";
  return {ErrorCode::NotFound, 0, line};
}

// Where a film's pairs come from: the reader, with the depth made on the way where the film has none.
class FilmSupply {
 public:
  [[nodiscard]] Outcome<void> open(const SourceOptions& source, const PairReader::Backends& backends,
                                   const OutputOptions& output, const std::atomic<bool>& stop,
                                   const ProgressReport& progress) {
    if (output.from_views) {
      auto surveyed = StereoFilm::survey(source, backends, *output.from_views, stop, progress);
      if (!surveyed) return std::unexpected(surveyed.error());
      views_ = std::move(*surveyed);
    }
    const SourceOptions& told = views_ ? views_->source() : source;
    if (auto opened = openTelling(reader_, told); !opened) return failOn(reader_.failedThing(), opened.error());
    const FilmInfo& info = reader_.info();
    if (output.from_one_view) {
      auto estimated = EstimatedFilm::of(source, info, *output.from_one_view, stop);
      if (!estimated) return std::unexpected(estimated.error());
      estimated_ = std::move(*estimated);
    } else if (!views_ && !info.has_depth) {
      return failOn(source.url, withoutDepth(source, info.packing, backends));
    }
    return {};
  }
  [[nodiscard]] Outcome<std::optional<FramePair>> next() {
    if (estimated_) return estimated_->next([this] { return read(); });
    auto pair = read();
    while (views_ && pair && *pair && (*pair)->right.empty()) pair = read();  // a view is lost: left out
    if (!views_ || !pair || !*pair) return pair;
    auto made = views_->withDepth(std::move(**pair));
    if (!made) return failOn(views_->source().url, made.error());
    return std::move(*made);
  }
  [[nodiscard]] FilmInfo infoWith(const FramePair& first) const {
    if (estimated_) return EstimatedFilm::described(reader_.info(), first);
    return views_ ? views_->described(reader_.info()) : reader_.info();
  }
  [[nodiscard]] std::vector<std::string> notes() const {
    if (estimated_) return estimated_->notes();
    return views_ ? views_->notes() : std::vector<std::string>{};
  }
  explicit FilmSupply(const PairReader::Backends& backends) : reader_(backends) {}
  [[nodiscard]] PairReader& reader() noexcept { return reader_; }

 private:
  // A live film ends where the size of its pictures changes.
  [[nodiscard]] Outcome<std::optional<FramePair>> read() {
    auto pair = reader_.next();
    if (!pair) return failOn(reader_.failedThing(), pair.error());
    if (!*pair) return std::nullopt;
    const Frame &color = (*pair)->color, &depth = (*pair)->depth;
    const std::pair size(color.width, color.height);
    if (!size_) size_ = size;
    const FilmInfo& info = reader_.info();
    const bool depth_changes = !depth.empty() && (depth.width != info.depth_width || depth.height != info.depth_height);
    if (size == *size_ && !depth_changes) return std::move(*pair);
    const char* const track = depth_changes ? "depth" : "colour";
    if (!(*pair)->taken) return failOn(track, kOtherSize);
    log(LogLevel::Warning, track, "the film ends there: %s", kOtherSize.message);
    return std::nullopt;
  }

  PairReader reader_;
  std::optional<std::pair<int, int>> size_;  // of the colour
  std::optional<StereoFilm> views_;
  std::optional<EstimatedFilm> estimated_;
};

}  // namespace

Outcome<AuthorSummary> authorFilm(const SourceOptions& source, const PairReader::Backends& backends,
                                  const OutputOptions& output, const std::atomic<bool>& stop,
                                  const ProgressReport& progress) {
  if (auto ready = checkOutput(output); !ready) return failOn(output.path, ready.error());
  if (auto ready = checkPreview(output); !ready) return failOn(output.preview, ready.error());
  FilmSupply supply(backends);
  PairReader& reader = supply.reader();
  const StopWatch watch(reader, stop);
  const auto failed = [&](const Failure& failure) {
    if (stop.load(std::memory_order_relaxed)) return failOn(output.path, kCancelled);
    return failOn(failure.thing, failure.error);
  };
  if (auto opened = supply.open(source, backends, output, stop, progress); !opened) return failed(opened.error());
  std::optional<Packager> packager;
  bool live = false;  // ends on request, when its camera is unplugged or its pictures change, and is complete then
  bool whole = true;
  std::optional<CancelsAnswers> kept;
  for (std::uint64_t done = 1;; ++done) {
    auto pair = supply.next();
    if (stop.load(std::memory_order_relaxed)) {
      const bool ends = live || (packager && filmKindOf(output.path) == FilmKind::Live);
      if (!ends) return failOn(output.path, kCancelled);
      kept.emplace(nullptr);  // the request ends the film and not its writing
      whole = false;
      break;
    }
    if (!pair && live && reader.isSourceLost(pair.error().error)) {
      log(LogLevel::Warning, source.url.c_str(), "the film ends there: %s", pair.error().error.message);
      break;
    }
    if (!pair) return failed(pair.error());
    if (!*pair) break;
    live = (*pair)->taken.has_value();
    if (!packager) {
      if (live) kept.emplace(nullptr);  // a request ends the film and not its writing
      packager.emplace(reader, backends, supply.infoWith(**pair), source, output);
      if (auto begun = packager->begin(**pair); !begun) return failed(begun.error());
    }
    auto written = packager->write(**pair);
    if (!written) return failed(written.error());
    progress(done, expectedFrames(reader.info()));
  }
  if (!packager) return failOn(source.url, {ErrorCode::Corrupt, 0, "holds no pictures"});
  auto summary = packager->finish(whole);
  if (!summary) return summary;
  if (live) summary->lost.clear();  // a camera announces nothing
  const std::vector<std::string> notes = supply.notes();
  summary->notes.insert(summary->notes.begin(), notes.begin(), notes.end());
  return summary;
}

}  // namespace relievo
