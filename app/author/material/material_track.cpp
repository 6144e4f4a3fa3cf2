// SPDX-License-Identifier: Apache-2.0
// Opens the maps, moves the painting along with the film, and makes 4:2:0 pictures of the result.
#include "app/author/material/material_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "platform/clock.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::size_t kMostCutsTold = 5;
constexpr Duration kRounding = std::chrono::milliseconds(4);  // of two containers' times
constexpr Error kFilmOfMaps{ErrorCode::InvalidArgument, 0,
                            "a film of maps has times of its own; give it alone, or a picture for each time"};
constexpr Error kNoPicture{ErrorCode::Corrupt, 0, "no picture in it; give a picture or a film of the material"};

Result<std::unique_ptr<TrackReader>> openMaps(const std::string& path, const PairReader::Backends& backends) {
  auto reader = std::make_unique<TrackReader>(backends.make_source(path), backends.make_decoder);
  if (auto opened = reader->open(path); !opened) return std::unexpected(opened.error());
  const auto& streams = reader->source().streams();
  const auto video = std::ranges::find(streams, StreamKind::Video, &StreamInfo::kind);
  if (video == streams.end()) return std::unexpected(kNoPicture);
  if (auto selected = reader->select(*video); !selected) return std::unexpected(selected.error());
  return reader;
}

int even(double length) {
  return std::max(2 * static_cast<int>(std::lround(length / 2)), 2);
}

}  // namespace

Outcome<MaterialTrack> MaterialTrack::open(const std::vector<Painting>& paintings, const Material& words,
                                           const PairReader::Backends& backends, int width, int height) {
  MaterialTrack track;
  track.cols_ = even(std::min(width, kMostCols));
  track.rows_ = even(static_cast<double>(track.cols_) * height / width);
  track.scale_ = layered(words, kFull);
  bool all_gray = true;
  for (const Painting& painting : paintings) {
    const auto model = track.read(painting, paintings.size() == 1 && painting.from_s == 0, backends);
    if (!model) return failOn(painting.path, model.error());
    all_gray = all_gray && *model == ColorModel::Gray;
  }
  if (all_gray) track.scale_.friction = {}, track.scale_.texture = {};
  return track;
}

Result<ColorModel> MaterialTrack::read(const Painting& painting, bool alone, const PairReader::Backends& backends) {
  auto reader = openMaps(painting.path, backends);
  if (!reader) return std::unexpected(reader.error());
  const auto first = (*reader)->next(0);
  if (!first || !*first) return std::unexpected(first ? kNoPicture : first.error());
  auto second = (*reader)->next(0);
  if (!second) return std::unexpected(second.error());
  if (*second) {
    if (!alone) return std::unexpected(kFilmOfMaps);
    map_ = readMap(**first, cols_, rows_);
    next_ = std::move(*second);
    reader_ = std::move(*reader);
  } else {
    coming_.emplace_back(painting, readMap(**first, cols_, rows_));
  }
  return (*first)->model;
}

Result<const ColorPicture420*> MaterialTrack::at(const ColorPicture420& color, MediaTime time, bool begins_shot) {
  if (reader_) {
    if (auto passed = passTo(time); !passed) return std::unexpected(passed.error());
    draw(asPainted());
  } else {
    follow(color, time, begins_shot);
  }
  return &picture_;
}

Result<void> MaterialTrack::passTo(MediaTime time) {
  while (next_ && next_->pts <= time + kRounding) {
    map_ = readMap(*next_, cols_, rows_);
    auto next = reader_->next(0);
    if (!next) return std::unexpected(next.error());
    next_ = std::move(*next);
  }
  return {};
}

void MaterialTrack::follow(const ColorPicture420& color, MediaTime time, bool begins_shot) {
  follower_.add(scaledTo(cols_, rows_, color.y.data(), color.width, color.height));
  if (beginPainting(time)) {
    follower_.begin();
  } else if (begins_shot || !has_begun_) {
    follower_.cut();
    if (has_begun_) ends_at_.push_back(time);
  }
  std::vector<PaintedMap::Codes> codes;
  codes.reserve(follower_.places().size());
  const PaintedMap::Codes none = unpainted();
  for (const MapFollower::Place& place : follower_.places()) {
    const std::size_t from = place.x < 0 ? 0
                                         : map_.index(std::min(static_cast<int>(std::lround(place.x)), cols_ - 1),
                                                      std::min(static_cast<int>(std::lround(place.y)), rows_ - 1));
    codes.push_back(place.x >= 0 && map_.painted[from] ? map_.codes[from] : none);
  }
  draw(codes);
}

bool MaterialTrack::beginPainting(MediaTime time) {
  bool begins = false;
  for (; !coming_.empty(); coming_.pop_front()) {
    auto& [painting, map] = coming_.front();
    if (MediaTime(fromSeconds(painting.from_s)) > time + kRounding) break;
    map_ = std::move(map);
    begins = has_begun_ = true;
  }
  return begins;
}

std::vector<std::string> MaterialTrack::notes() const {
  std::vector<std::string> notes;
  if (!ends_at_.empty()) {
    std::string cuts;
    for (std::size_t i = 0; i < std::min(ends_at_.size(), kMostCutsTold); ++i) {
      // Rounded down, so that the picture at the cut is the first one that is included.
      const auto time = std::chrono::floor<std::chrono::milliseconds>(ends_at_[i].time_since_epoch());
      cuts += print("%s%.3f s", i == 0 ? "" : ", ", toSeconds(time));
    }
    if (ends_at_.size() > kMostCutsTold) cuts += print(" and %zu more", ends_at_.size() - kMostCutsTold);
    notes.push_back(
        print("nothing is painted after the cut%s at %s; --material 0=FILE,SECONDS=FILE,.. has a painting "
              "for each shot",
              ends_at_.size() == 1 ? "" : "s", cuts.c_str()));
  }
  for (const auto& [painting, map] : coming_) {
    notes.push_back(
        print("%s: the film ends before %g s, where this painting begins", painting.path.c_str(), painting.from_s));
  }
  return notes;
}

std::vector<PaintedMap::Codes> MaterialTrack::asPainted() const {
  std::vector<PaintedMap::Codes> codes = map_.codes;
  const PaintedMap::Codes none = unpainted();
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!map_.painted[i]) codes[i] = none;
  }
  return codes;
}

// The player's own stiffness, without friction and texture.
PaintedMap::Codes MaterialTrack::unpainted() const {
  const double share = std::min(kUsualStiffnessNPerMm / scale_.stiffness_n_per_mm.value_or(1), 1.0);
  return {static_cast<std::uint8_t>(std::lround(255 * share)), 0, 0};
}

void MaterialTrack::draw(const std::vector<PaintedMap::Codes>& codes) {
  picture_.width = cols_;
  picture_.height = rows_;
  picture_.range = ColorRange::Full;
  picture_.y.clear();
  picture_.u.clear();
  picture_.v.clear();
  for (const PaintedMap::Codes& code : codes) picture_.y.push_back(code[0]);
  for (int r = 0; r < rows_; r += 2) {
    for (int c = 0; c < cols_; c += 2) {
      const auto meanOf = [&](std::size_t k) {
        const int sum = codes[map_.index(c, r)][k] + codes[map_.index(c + 1, r)][k] + codes[map_.index(c, r + 1)][k] +
                        codes[map_.index(c + 1, r + 1)][k];
        return static_cast<std::uint8_t>((sum + 2) / 4);
      };
      picture_.u.push_back(meanOf(1));
      picture_.v.push_back(meanOf(2));
    }
  }
}

}  // namespace relievo
