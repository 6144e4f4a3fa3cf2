// SPDX-License-Identifier: Apache-2.0
// Opens the map, follows the film with it, and codes it as 4:2:0.
#include "app/author/material/material_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relievo {
namespace {

constexpr Duration kRounding = std::chrono::milliseconds(4);  // of two containers' times
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

Outcome<MaterialTrack> MaterialTrack::open(const std::string& path, const Material& words,
                                           const PairReader::Backends& backends, int width, int height) {
  auto reader = openMaps(path, backends);
  if (!reader) return failOn(path, reader.error());
  const auto first = (*reader)->next(0);
  if (!first || !*first) return failOn(path, first ? kNoPicture : first.error());
  auto second = (*reader)->next(0);
  if (!second) return failOn(path, second.error());
  MaterialTrack track;
  track.cols_ = even(std::min(width, kMostCols));
  track.rows_ = even(static_cast<double>(track.cols_) * height / width);
  track.scale_ = layered(words, kFull);
  if ((*first)->model == ColorModel::Gray) track.scale_.friction = {}, track.scale_.texture = {};
  track.map_ = readMap(**first, track.cols_, track.rows_);
  if (*second) {
    track.next_ = std::move(*second);
    track.reader_ = std::move(*reader);
  }
  return track;
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
  if (begins_shot) {
    follower_.cut();
    if (!ends_at_) ends_at_ = time;
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
