// SPDX-License-Identifier: Apache-2.0
// One plain track is read as it is; anything else goes through the player's own reader.
#include "app/lab/trace/depth_film.h"

#include <algorithm>
#include <utility>

#include "app/media/reading/depth_reading.h"
#include "app/media/track_reader.h"
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
  std::optional<Frame> first;  // read to know its shape, not yet handed out
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

  CalibrationLayers layers{source.command_line, source.side_file, {}};
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
    layers.tags = calibrationFromTags(tracks_->single.source().tags());
    layers.tags.merge(calibrationFromTags(video->tags));
    const auto selected = tracks_->single.select(*video);
    if (!selected) return failOn(source.url, selected.error());
    tracks_->track = *selected;
  }

  auto first = nextFrame();
  if (!first) return failOn(source.url, first.error());
  if (!*first) return failOn(source.url, {ErrorCode::NotFound, 0, "no picture in this source"});
  tracks_->first = std::move(*first);
  const Frame& frame = *tracks_->first;
  volume_ = options_.volume.value_or(DisplayVolume::forPicture(frame.width, frame.height, frame.sample_aspect));
  if (tracks_->paired) {
    calibration_ = tracks_->pairs.info().calibration.calibration;
    return {};
  }
  if (!source.depth_code) layers.pictures = readCodes(frame, CodeCount(frame), layers).settings;
  const auto choice = chooseCalibration(layers, frame, source.depth_code.value_or(DepthCode::Luma));
  if (!choice) return failOn(source.url, choice.error());
  calibration_ = choice->calibration;
  return {};
}

Result<std::optional<Frame>> DepthFilm::nextFrame() {
  if (tracks_->first) return std::exchange(tracks_->first, std::nullopt);
  if (!tracks_->paired) return tracks_->single.next(tracks_->track);
  for (;;) {
    auto pair = tracks_->pairs.next();
    if (!pair) return std::unexpected(pair.error());
    if (!*pair) return std::nullopt;
    // A depth frame comes with every colour frame that it belongs to: it counts once.
    const bool repeated = !frames_.empty() && (*pair)->depth.pts - *first_pts_ == frames_.back().time - MediaTime{};
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
  if (!frames_.empty() &&
      (field->cols() != frames_.back().field.cols() || field->rows() != frames_.back().field.rows())) {
    return failOn(options_.source.url, {ErrorCode::Unsupported, 0, "the picture changes its size; cut the film there"});
  }
  if (!first_pts_) first_pts_ = (*frame)->pts;
  MediaTime time{(*frame)->pts - *first_pts_};
  if (options_.frames_per_s) time = mediaTime(static_cast<double>(frame_count_) / *options_.frames_per_s);
  ++frame_count_;
  if (!frames_.empty() && time <= frames_.back().time) return true;  // a repeated timestamp: the first one counts
  frames_.push_back({*field, time, (*frame)->owner});
  return true;
}

Outcome<const SurfaceWindow*> DepthFilm::windowAt(double t_s) {
  const MediaTime now = mediaTime(t_s);
  bool changed = window_.count == 0;
  const auto ahead = [&] {
    return std::count_if(frames_.begin(), frames_.end(), [&](const TimedSurface& f) { return f.time > now; });
  };
  while (!ended_ && ahead() < SurfaceWindow::kAhead) {
    const auto read = append();
    if (!read) return std::unexpected(read.error());
    changed = true;
  }
  // Two frames from before the present one stay.
  while (frames_.size() > SurfaceWindow::kBefore + 1 && frames_[SurfaceWindow::kBefore + 1].time <= now) {
    frames_.pop_front();
    changed = true;
  }
  if (!changed) return &window_;
  shots_.mark(frames_);
  window_.count = static_cast<int>(std::min<std::size_t>(frames_.size(), SurfaceWindow::kCapacity));
  std::copy_n(frames_.begin(), window_.count, window_.frames.begin());
  window_.ended = ended_;
  return &window_;
}

}  // namespace relievo
