// SPDX-License-Identifier: Apache-2.0
// Writes one film with a colour and a depth track, and perhaps a material one: a file that appears whole or not at all,
// or a network stream.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "app/author/package/depth_check.h"
#include "app/author/package/depth_coding.h"
#include "app/author/package/kept_tracks.h"
#include "app/author/package/picture.h"
#include "hal/media/media_time.h"
#include "platform/atomic_file.h"
#include "platform/error.h"

namespace relievo {

struct FilmFormat {
  int color_width = 0, color_height = 0;
  int depth_width = 0, depth_height = 0;
  ColorRange color_range = ColorRange::Limited;
  ColorMatrix color_matrix = ColorMatrix::Unspecified;
  std::uint8_t color_primaries = kUnspecifiedColor,
               color_transfer = kUnspecifiedColor;  // codes of ITU-T H.273, as in a Frame
  double color_aspect = 1.0, depth_aspect = 1.0;    // sample aspect ratio: width over height
  Duration frame_period{0};                         // for the rate control only; 0: unknown
  int color_crf = 18;
  DepthCoding depth;
  std::map<std::string, std::string> depth_tags;  // calibrationTags()
  int material_width = 0, material_height = 0;    // even; 0: no material track
  int material_crf = 4;
  std::string material_scale;  // value of kMaterialScaleTag
};

struct TrackTotals {
  std::uint64_t frames = 0;
  std::uint64_t bytes = 0;
  MediaTime first, last;
};
struct FilmTotals {
  TrackTotals color, depth, material;
  std::uint64_t file_bytes = 0;
  Duration latest{0};  // network stream: the largest delay of sending
};

// Track 0 is the colour, H.264 4:2:0, titled "color"; track 1 is the depth, full range, titled "depth". The depth's
// tags are stored in each place that container and codec offer:
//
//   Matroska           tags of the track
//   MP4, QuickTime     tags of the file; the tracks are named by their handlers
//   H.264 and HEVC     in the stream, with each key frame, whatever the container (hal/media/stream_tags.h)
//   transport streams  additionally the stream's type: auxiliary video
//
// A material track, if there is one, is track 2: H.264 4:2:0, full range, titled "material", its tag in the same
// places. After them come the kept tracks, if there are any.
//
// Each track is encoded on a thread of its own, a few pictures behind: a failure is reported by a later call for the
// same track, at the latest by `finish`. Use from one thread, except that `writeDepth` may be called from another one.
// A file is written under a temporary name beside the target and renamed by `finish`; without that nothing is left. A
// network stream is sent in real time: writing blocks. Timestamps of a track must increase.
class FilmWriter {
 public:
  // `check`: sees the depth's packets, and must outlive the writer. Null: none.
  //
  // InvalidArgument for an unknown kind of film (filmKindOf) or one that cannot hold the codec, NotFound if the folder
  // does not exist, Unsupported without the codec's library.
  [[nodiscard]] static Result<std::unique_ptr<FilmWriter>> create(const std::string& path, const FilmFormat& format,
                                                                  Existing existing = Existing::Replace,
                                                                  std::unique_ptr<KeptTracks> kept = nullptr,
                                                                  DepthCheck* check = nullptr);
  ~FilmWriter();

  // The memory of the next colour picture. One that is made there is not copied by `writeColor`, and may be read until
  // the next one is made.
  [[nodiscard]] ColorPicture420& nextColor() noexcept;
  // `key` makes it a key frame; apart from the first picture there are no others.
  [[nodiscard]] Result<void> writeColor(const ColorPicture420& picture, MediaTime time, bool key);
  [[nodiscard]] Result<void> writeDepth(const DepthPicture& picture, MediaTime time, bool key);
  // Only if the format has a material track.
  [[nodiscard]] Result<void> writeMaterial(const ColorPicture420& picture, MediaTime time, bool key);
  // `whole`: what is kept goes on to its own end; else it ends with the pictures.
  [[nodiscard]] Result<FilmTotals> finish(bool whole = true);
  // Null: none.
  [[nodiscard]] const KeptTracks* kept() const noexcept;

 private:
  struct Impl;
  explicit FilmWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace relievo
