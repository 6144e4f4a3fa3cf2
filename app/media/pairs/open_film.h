// SPDX-License-Identifier: Apache-2.0
// What the parts of a PairReader share: what was asked for, what is open, and what was found out.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "app/media/pair_reader.h"
#include "app/media/pairs/open_sources.h"

namespace relievo {

// One thread, except `remote`, which any thread may ask.
struct OpenFilm {
  static constexpr std::size_t kColorTrack = 0;
  static constexpr Error kNoPicture{
      ErrorCode::Corrupt, 0,
      "not one picture of its video could be decoded; it is empty, damaged, unknown, or has more than 16.7 million "
      "samples (a photo: 50 million, and 300 MB decoded)"};

  explicit OpenFilm(PairReader::Backends b) : backends(std::move(b)) {}

  // The stream, with the user's frame rate if one was given.
  [[nodiscard]] StreamInfo asTold(const StreamInfo& stream) const {
    StreamInfo told = stream;
    if (options.frames_per_s) told.frame_period = fromSeconds(1 / *options.frames_per_s);
    return told;
  }
  [[nodiscard]] bool isPacked() const noexcept { return relievo::isPacked(info.packing); }
  // The colour's picture holds the depth or a second view as well.
  [[nodiscard]] bool isInOnePicture() const noexcept {
    return isPacked() || isStereo(info.packing) || info.packing == Packing::StereoLayers;
  }
  [[nodiscard]] bool isLoss(const Error& error) const noexcept {
    using enum ErrorCode;
    return remote && (error.code == Lost || error.code == Timeout || error.code == Io);
  }
  // The user named a depth source or packing: `open` fails without depth.
  [[nodiscard]] bool isDepthRequired() const noexcept {
    return !options.depth_url.empty() || options.packing == Packing::Tracks;
  }
  [[nodiscard]] const std::string& depthUrl() const noexcept {
    return options.depth_url.empty() ? options.url : options.depth_url;
  }
  // Of depth that has a stream of its own.
  [[nodiscard]] const StreamInfo& depthStream() const noexcept {
    return sources.depth() ? sources.depth()->stream() : *depth_beside.stream;
  }
  std::unexpected<Error> failOn(const std::string& thing, const Error& error) {
    failed_thing = thing;
    return std::unexpected(error);
  }
  void close() noexcept {
    depth_beside = {};
    remote = live = false;
    info = {};
    sources.close();
  }

  PairReader::Backends backends;
  SourceOptions options;  // its addresses as they were found
  FilmInfo info;
  std::string failed_thing;
  OpenSources sources;
  // Depth beside the colour, in the same source.
  struct DepthBeside {
    std::optional<std::size_t> track;    // TrackReader::select
    const StreamInfo* stream = nullptr;  // valid while the film is open
    std::optional<Error> refused;        // why it cannot be read
  };
  DepthBeside depth_beside;
  std::atomic<bool> remote{false};  // the colour's source
  bool live = false;                // likewise
  bool exchanged = false;           // of two tracks without tags the second is the colour: their pictures show it
};

}  // namespace relievo
