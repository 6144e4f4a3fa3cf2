// SPDX-License-Identifier: Apache-2.0
// A single plain track is read directly; anything else goes through the player's own reader.
#include "app/lab/trace/depth_film.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "app/media/reading/code_count.h"
#include "app/media/reading/depth_doubts.h"
#include "app/media/reading/depth_meaning.h"
#include "app/media/reading/near_end.h"
#include "app/media/tracks/track_reader.h"
#include "app/scene/film_box.h"
#include "app/scene/height_field.h"

namespace relievo {
namespace {

constexpr const char* kPackingTag = "DEPTH_PACKING";

int countVideo(const std::vector<StreamInfo>& streams) {
  return static_cast<int>(
      std::count_if(streams.begin(), streams.end(), [](const StreamInfo& s) { return s.kind == StreamKind::Video; }));
}

}  // namespace

// Exactly one of the two readers is open.
struct DepthFilm::Tracks {
  Tracks(const PairReader::Backends& backends, const std::string& url)
      : single(backends.make_source(url), backends.make_decoder), pairs(backends) {}
  TrackReader single;
  PairReader pairs;
  bool paired = false;
  std::size_t track = 0;
  std::optional<Frame> first;        // read to know its shape, not yet handed out
  std::optional<DisplayVolume> box;  // the player's for these pairs
};

DepthFilm::DepthFilm(const PairReader::Backends& backends, DepthFilmOptions options)
    : options_(std::move(options)), tracks_(std::make_unique<Tracks>(backends, options_.source.url)) {}
DepthFilm::~DepthFilm() = default;

Outcome<void> DepthFilm::open() {
  const SourceOptions& source = options_.source;
  if (const auto opened = tracks_->single.open(source.url); !opened) return failOn(source.url, opened.error());
  const auto& streams = tracks_->single.source().streams();
  const bool tagged = tracks_->single.source().tags().contains(kPackingTag);
  tracks_->paired = countVideo(streams) > 1 || source.packing != Packing::Auto || tagged;

  DepthClues clues{.command_line = source.command_line, .side_file = source.side_file, .as = source.as, .place = {}};
  clues.path = source.url;
  if (tracks_->paired) {
    if (const auto opened = tracks_->pairs.open(source); !opened) {
      return failOn(tracks_->pairs.failedThing(), opened.error());
    }
    if (!tracks_->pairs.info().has_depth)
      return failOn(source.url, {ErrorCode::NotFound, 0, "no depth in this source; check --packing"});
  } else {
    const auto video =
        std::find_if(streams.begin(), streams.end(), [](const StreamInfo& s) { return s.kind == StreamKind::Video; });
    if (video == streams.end()) return failOn(source.url, {ErrorCode::NotFound, 0, "no video in this source"});
    clues.codec = video->codec;
    clues.single = isStill(*video);
    clues.tags = tracks_->single.source().tags();
    clues.tags.insert(video->tags.begin(), video->tags.end());
    const auto selected = tracks_->single.select(*video);
    if (!selected) return failOn(source.url, selected.error());
    tracks_->track = *selected;
  }

  auto first = nextFrame();
  if (!first) return failOn(source.url, first.error());
  if (!*first) return failOn(source.url, {ErrorCode::NotFound, 0, "no picture in this source"});
  tracks_->first = std::move(*first);
  const Frame& frame = *tracks_->first;
  volume_ = options_.volume.value_or(tracks_->box.value_or(usualBox(frame, frame)));
  if (tracks_->paired) {
    calibration_ = tracks_->pairs.info().calibration.calibration;
    material_ = tracks_->pairs.info().material;
    doubts_ = tracks_->pairs.info().reading.doubts;
    return {};
  }
  material_ = layered(source.material, materialFromTags(clues.tags).value_or(Material{}));
  clues.place = lookAtPlace(source.url, "");
  const auto stated = source.as != nullptr ? source.as->code : std::nullopt;
  clues.code = source.depth_code.value_or(stated.value_or(DepthCode::Luma));
  const KnownKind* const kind = kindOf(clues, frame);
  order_ = kind != nullptr ? orderOf(*kind, frame) : SampleOrder::AsStored;
  const auto ordered = inOrder(frame, order_);
  if (!ordered) return failOn(source.url, ordered.error());
  tracks_->first = *ordered;
  auto meaning = readMeaning(clues, kind, *ordered);
  if (!meaning) return failOn(source.url, meaning.error());
  calibration_ = meaning->calibration.calibration;
  doubts_ = std::move(meaning->reading.doubts);
  std::ranges::move(doubtsOf(*ordered, calibration_), std::back_inserter(doubts_));
  return {};
}

Result<std::optional<Frame>> DepthFilm::nextFrame() {
  if (tracks_->first) return std::exchange(tracks_->first, std::nullopt);
  if (!tracks_->paired) {
    auto frame = tracks_->single.next(tracks_->track);
    if (!frame || !*frame || order_ == SampleOrder::AsStored) return frame;
    return inOrder(**frame, order_);
  }
  for (;;) {
    auto pair = tracks_->pairs.next();
    if (!pair) return std::unexpected(pair.error());
    if (!*pair) return std::nullopt;
    // A depth frame comes with every colour frame that it belongs to: it counts once.
    const bool repeated = newest_ && (*pair)->depth.pts - *first_pts_ == newest_->time - MediaTime{};
    if (!tracks_->box) tracks_->box = usualBox((*pair)->color, (*pair)->depth);
    if (!(*pair)->depth.empty() && (!repeated || options_.frames_per_s)) return std::move((*pair)->depth);
  }
}

Outcome<bool> DepthFilm::append() {
  const auto fail_here = [&](const Error& error) { return failOn(options_.source.url, error); };
  auto frame = nextFrame();
  if (!frame) return fail_here(frame.error());
  if (!*frame) {
    ended_ = true;
    return false;
  }
  const auto field = HeightField::make(**frame, calibration_, volume_);
  if (!field) return fail_here(field.error());
  if (newest_ && (field->cols() != newest_->field.cols() || field->rows() != newest_->field.rows())) {
    return failOn(options_.source.url,
                  {ErrorCode::Unsupported, 0, "the depth's picture changes its size; split the film there"});
  }
  if (!first_pts_) first_pts_ = (*frame)->pts;
  MediaTime time{(*frame)->pts - *first_pts_};
  if (options_.frames_per_s) time = mediaTime(static_cast<double>(frame_count_) / *options_.frames_per_s);
  ++frame_count_;
  if (newest_ && time <= newest_->time) return true;  // a repeated timestamp: the first one counts
  newest_ = {*field, time, (*frame)->owner};
  frames_.add(*newest_);
  return true;
}

Outcome<const SurfaceWindow*> DepthFilm::windowAt(double t_s) {
  bool changed = frames_.moveTo(mediaTime(t_s)) || window_.count == 0;
  while (!ended_ && !frames_.full()) {
    const auto read = append();
    if (!read) return std::unexpected(read.error());
    changed = true;
  }
  if (!changed) return &window_;
  frames_.fill(window_);
  window_.ended = ended_;
  return &window_;
}

}  // namespace relievo
