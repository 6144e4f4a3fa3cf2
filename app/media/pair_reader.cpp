// SPDX-License-Identifier: Apache-2.0
// Opens a film, finds colour and depth in it and brings the two together.
#include "app/media/pair_reader.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>

#include "app/media/depth_follower.h"
#include "app/media/track_reader.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr std::size_t kColorTrack = 0;
constexpr const char* kNotOpen = "no film is open; open one first";
constexpr const char* kNoPicture = "not one picture of its video could be decoded; it is empty, damaged or unknown";

// The difference of two rounded times is off by up to a millisecond; the container's own period, if it says the same to
// within that, is not.
Duration framePeriod(Duration between, Duration nominal) noexcept {
  const bool agree = nominal > Duration(0) && std::chrono::abs(between - nominal) <= std::chrono::milliseconds(1);
  return agree ? nominal : between;
}

}  // namespace

struct PairReader::Impl {
  explicit Impl(Backends b) : backends(std::move(b)) {}

  // Where the depth pictures come from.
  struct DepthTrack {
    TrackReader* reader = nullptr;
    std::size_t number = 0;
    const StreamInfo* stream = nullptr;  // of the reader's source
    bool required = false;               // asked for by name: `open` fails without
  };

  Result<void> openReader(std::unique_ptr<TrackReader>& reader, const std::string& url);
  Result<void> openFilm();
  Result<void> openColor(const StreamInfo& color);
  Result<void> selectDepth(const TrackPlan& plan);
  Result<void> openDepth(const StreamInfo& color);
  void openSound();
  Result<void> describeDepth(const Frame& first, const StreamInfo& stream, const MediaSource& source);
  Result<std::optional<Frame>> nextColor();
  Result<FramePair> pairFor(Frame color);
  Result<DepthFollower::Match> depthAt(MediaTime time);
  Result<void> seekDepth(MediaTime target);
  Result<void> passTo(MediaTime target);
  void loseDepth(const Error& error);

  [[nodiscard]] bool isPacked() const noexcept { return info.packing != Packing::Tracks; }
  [[nodiscard]] const std::string& depthUrl() const noexcept {
    return options.depth_url.empty() ? options.url : options.depth_url;
  }
  std::unexpected<Error> failOn(const std::string& thing, const Error& error) {
    failed_thing = thing;
    return std::unexpected(error);
  }

  Backends backends;
  SourceOptions options;
  FilmInfo info;
  std::string failed_thing;
  PairCounters counters;

  std::mutex readers_mutex;  // the pointers to the readers and `interrupted`, against `interrupt`
  bool interrupted = false;
  std::unique_ptr<TrackReader> color_reader;
  std::unique_ptr<TrackReader> second_reader;  // of `depth_url`

  std::deque<Frame> color_ahead;  // read, not yet handed out
  std::optional<DepthTrack> depth_track;
  std::optional<DepthFollower> depth;
  bool depth_lost = false;
  bool loss_told = false;
  Duration key_step{0};  // of the last seek
};

Result<void> PairReader::Impl::openReader(std::unique_ptr<TrackReader>& reader, const std::string& url) {
  {
    const std::scoped_lock lock(readers_mutex);
    if (interrupted) return failOn(url, {ErrorCode::Cancelled, 0, "interrupted before it was opened"});
    reader = std::make_unique<TrackReader>(backends.make_source(), backends.make_decoder);
  }
  if (auto opened = reader->open(url); !opened) return failOn(url, opened.error());
  return {};
}

Result<void> PairReader::Impl::openFilm() {
  const bool two_sources = !options.depth_url.empty();
  if (two_sources && options.packing != Packing::Auto && options.packing != Packing::Tracks) {
    return failOn(options.depth_url, {ErrorCode::InvalidArgument, 0,
                                      "depth cannot be packed into the picture and come from a second source as well"});
  }
  if (auto opened = openReader(color_reader, options.url); !opened) return opened;
  const auto plan = planTracks(color_reader->source(), options.packing, two_sources);
  if (!plan) return failOn(options.url, plan.error());
  info.packing = plan->packing;
  info.duration = color_reader->source().duration();

  // The colour is the track that leads, so it is chosen first.
  const auto chosen = color_reader->select(*plan->color);
  if (!chosen) return failOn(options.url, chosen.error());
  if (auto selected = selectDepth(*plan); !selected) return selected;
  openSound();
  if (auto opened = openColor(*plan->color); !opened) return opened;
  return openDepth(*plan->color);
}

// Two pictures: their times tell the frame period.
Result<void> PairReader::Impl::openColor(const StreamInfo& color) {
  while (color_ahead.size() < 2) {
    auto frame = color_reader->next(kColorTrack);
    if (!frame) return failOn(options.url, frame.error());
    if (!*frame) break;
    color_ahead.push_back(std::move(**frame));
  }
  if (color_ahead.empty()) return failOn(options.url, {ErrorCode::Corrupt, 0, kNoPicture});
  info.color_width = color_ahead[0].width;
  info.color_height = color_ahead[0].height;
  info.color_codec = color.codec;
  if (color_ahead.size() == 2) {
    info.frame_period = framePeriod(color_ahead[1].pts - color_ahead[0].pts, color.frame_period);
  }
  return {};
}

Result<void> PairReader::Impl::selectDepth(const TrackPlan& plan) {
  DepthTrack track{color_reader.get(), 0, plan.depth, options.packing == Packing::Tracks};
  if (!options.depth_url.empty()) {
    if (auto opened = openReader(second_reader, options.depth_url); !opened) return opened;
    track = {second_reader.get(), 0, findDepthTrack(second_reader->source()), true};
    if (track.stream == nullptr) return failOn(depthUrl(), {ErrorCode::NotFound, 0, "there is no video in it"});
  }
  if (track.stream == nullptr) return {};
  const auto number = track.reader->select(*track.stream);
  if (number) {
    track.number = *number;
    depth_track = track;
  } else if (track.required) {
    return failOn(depthUrl(), number.error());
  } else {
    loseDepth(number.error());
  }
  return {};
}

Result<void> PairReader::Impl::openDepth(const StreamInfo& color) {
  if (isPacked()) {
    const auto halves = splitPacked(color_ahead[0], info.packing, options.depth_code);
    if (!halves) return failOn(options.url, halves.error());
    info.color_width = halves->color.width;
    info.color_height = halves->color.height;
    return describeDepth(halves->depth, color, color_reader->source());
  }
  if (!depth_track) return {};
  depth.emplace([this]() -> Result<DepthFollower::Supplied> {
    auto frame = depth_track->reader->next(depth_track->number);
    if (!frame) return std::unexpected(frame.error());
    return DepthFollower::Supplied{std::move(*frame), depth_track->reader->ended(depth_track->number)};
  });
  const auto first = depth->peek();
  if (first && *first != nullptr) return describeDepth(**first, *depth_track->stream, depth_track->reader->source());
  const Error missing = first ? Error{ErrorCode::Corrupt, 0, kNoPicture} : first.error();
  if (depth_track->required || missing.code == ErrorCode::Cancelled) return failOn(depthUrl(), missing);
  loseDepth(missing);
  depth_track.reset();
  return {};
}

void PairReader::Impl::openSound() {
  if (!options.sound || !backends.make_audio_decoder) return;
  const auto& streams = color_reader->source().streams();
  const auto first =
      std::find_if(streams.begin(), streams.end(), [](const StreamInfo& s) { return s.kind == StreamKind::Audio; });
  if (first == streams.end()) return;
  info.sound_codec = first->codec;
  const auto opened = color_reader->listen(backends.make_audio_decoder(), *first, *options.sound);
  if (!opened) info.sound_refused = opened.error().message;
}

Result<void> PairReader::Impl::describeDepth(const Frame& first, const StreamInfo& stream, const MediaSource& source) {
  auto tags = stream.tags;  // the track's word goes before the container's
  tags.insert(source.tags().begin(), source.tags().end());
  const CalibrationLayers layers{options.command_line, options.side_file, calibrationFromTags(tags)};
  auto choice = chooseCalibration(layers, first, options.depth_code);
  if (!choice) return failOn("calibration", choice.error());
  info.calibration = std::move(*choice);
  info.has_depth = true;
  info.depth_width = first.width;
  info.depth_height = first.height;
  info.depth_codec = stream.codec;
  return {};
}

Result<std::optional<Frame>> PairReader::Impl::nextColor() {
  if (!color_ahead.empty()) {
    std::optional<Frame> frame(std::move(color_ahead.front()));
    color_ahead.pop_front();
    return frame;
  }
  auto frame = color_reader->next(kColorTrack);
  if (!frame) failed_thing = options.url;
  return frame;
}

Result<FramePair> PairReader::Impl::pairFor(Frame color) {
  if (isPacked()) {
    auto halves = splitPacked(color, info.packing, options.depth_code);
    if (!halves) return failOn(options.url, halves.error());
    return FramePair{std::move(halves->color), std::move(halves->depth), true};
  }
  auto match = depthAt(color.pts);
  if (!match) return std::unexpected(match.error());
  return FramePair{std::move(color), std::move(match->depth), match->matched};
}

// An error of the depth ends the depth; only an interruption goes to the caller.
Result<DepthFollower::Match> PairReader::Impl::depthAt(MediaTime time) {
  if (!depth_track || depth_lost) return DepthFollower::Match{};
  auto match = depth->at(time);
  if (match) return match;
  if (match.error().code == ErrorCode::Cancelled) {
    return failOn(depthUrl(), match.error());
  }
  loseDepth(match.error());
  return DepthFollower::Match{};
}

void PairReader::Impl::loseDepth(const Error& error) {
  depth_lost = true;
  if (std::exchange(loss_told, true)) return;
  log(LogLevel::Warning, "media", "%s: no depth from here on: %s", depthUrl().c_str(), error.message);
}

// Drops the pictures before the target; the depth goes along, so that its packets do not pile up.
Result<void> PairReader::Impl::passTo(MediaTime target) {
  for (;;) {
    auto color = nextColor();
    if (!color) return std::unexpected(color.error());
    if (!*color) return {};
    if ((*color)->pts >= target) {
      color_ahead.push_front(std::move(**color));
      return {};
    }
    if (auto passed = depthAt((*color)->pts); !passed) return std::unexpected(passed.error());
  }
}

// Colour has been sought already, and the depth with it where both are of one source.
Result<void> PairReader::Impl::seekDepth(MediaTime target) {
  if (!depth_track) return {};
  depth->restart();
  depth_lost = false;
  if (!second_reader) return {};
  const auto sought = second_reader->seek(target, key_step);
  if (sought) return {};
  if (sought.error().code == ErrorCode::Cancelled) return failOn(depthUrl(), sought.error());
  loseDepth(sought.error());
  return {};
}

PairCounters& PairCounters::operator+=(const PairCounters& other) noexcept {
  pairs += other.pairs;
  without_depth += other.without_depth;
  mismatched += other.mismatched;
  depth_skipped += other.depth_skipped;
  damaged += other.damaged;
  missing += other.missing;
  depth_missing += other.depth_missing;
  return *this;
}

PairReader::PairReader(Backends backends) : impl_(std::make_unique<Impl>(std::move(backends))) {}
PairReader::~PairReader() = default;

Result<void> PairReader::open(const SourceOptions& options) {
  close();
  {
    const std::scoped_lock lock(impl_->readers_mutex);
    impl_->interrupted = false;
  }
  impl_->failed_thing.clear();
  impl_->options = options;
  auto opened = impl_->openFilm();
  if (!opened) close();
  return opened;
}

Result<std::optional<FramePair>> PairReader::next() {
  if (!impl_->color_reader) return fail(ErrorCode::InvalidState, kNotOpen);
  auto color = impl_->nextColor();
  if (!color) return std::unexpected(color.error());
  if (!*color) return std::nullopt;
  auto pair = impl_->pairFor(std::move(**color));
  if (!pair) return std::unexpected(pair.error());
  ++impl_->counters.pairs;
  if (!pair->matched && impl_->key_step == Duration(0)) ++impl_->counters.mismatched;
  if (impl_->info.has_depth && pair->depth.empty()) ++impl_->counters.without_depth;
  return std::move(*pair);
}

Result<void> PairReader::seek(MediaTime target, Duration key_step) {
  if (!impl_->color_reader) return fail(ErrorCode::InvalidState, kNotOpen);
  if (auto sought = impl_->color_reader->seek(target, key_step); !sought) {
    return impl_->failOn(impl_->options.url, sought.error());
  }
  impl_->color_ahead.clear();
  impl_->key_step = key_step;
  if (auto sought = impl_->seekDepth(target); !sought) return sought;
  return impl_->passTo(target);
}

std::optional<AudioChunk> PairReader::nextSound() {
  return impl_->color_reader ? impl_->color_reader->nextSound() : std::nullopt;
}

bool PairReader::readAhead() {
  return impl_->color_reader && impl_->color_reader->readAhead();
}

void PairReader::close() noexcept {
  Impl& film = *impl_;
  film.depth.reset();
  film.depth_track.reset();
  film.color_ahead.clear();
  film.depth_lost = film.loss_told = false;
  film.counters = {};
  film.key_step = Duration(0);
  film.info = {};
  const std::scoped_lock lock(film.readers_mutex);
  film.color_reader.reset();
  film.second_reader.reset();
}

void PairReader::interrupt() noexcept {
  const std::scoped_lock lock(impl_->readers_mutex);
  impl_->interrupted = true;
  if (impl_->color_reader) impl_->color_reader->interrupt();
  if (impl_->second_reader) impl_->second_reader->interrupt();
}

const FilmInfo& PairReader::info() const noexcept {
  return impl_->info;
}

const std::string& PairReader::failedThing() const noexcept {
  return impl_->failed_thing;
}

PairCounters PairReader::counters() const noexcept {
  PairCounters counters = impl_->counters;
  if (impl_->depth) counters.depth_skipped = impl_->depth->skipped();
  if (impl_->color_reader) {
    counters.damaged += impl_->color_reader->damaged();
    counters.missing = impl_->color_reader->source().missing();
  }
  if (impl_->second_reader) {
    counters.damaged += impl_->second_reader->damaged();
    counters.depth_missing = impl_->second_reader->source().missing();
  }
  return counters;
}

}  // namespace relievo
