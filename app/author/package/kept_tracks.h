// SPDX-License-Identifier: Apache-2.0
// What a film has besides colour and depth: sound, subtitles, fonts, chapters and titles. Copied as they are coded.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

extern "C" {
#include <libavformat/avformat.h>
}

#include "app/author/package/film_kind.h"
#include "app/author/package/place/film_place.h"
#include "app/author/package/text_subtitles.h"
#include "hal/media/continuous_time.h"
#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo {

struct KeptWishes {
  bool sound = true;
  bool subtitles = true;
};

// Reads the colour's file a second time, without its pictures. Text subtitles are converted if the film's container
// needs another format; what it cannot hold is left out and reported. Use from one thread.
class KeptTracks {
 public:
  // `picture`: the colour's stream in the file. `start`: the time of the file that is media time 0. NotFound, Corrupt;
  // Timeout and Cancelled as platform/files/file_system_answer.h says, also of writing.
  [[nodiscard]] static Result<std::unique_ptr<KeptTracks>> open(const std::string& file, int picture, Duration start,
                                                                const KeptWishes& wishes);
  // Adds tracks, chapters and titles to the film: after the tracks of its pictures, before its header.
  [[nodiscard]] Result<void> addTo(FilmPlace& film, FilmKind kind);
  // Writes what begins before `time`.
  [[nodiscard]] Result<void> writeUntil(MediaTime time);
  [[nodiscard]] Result<void> writeRest() { return writeUntil(MediaTime::max()); }

  // "sound aac eng", "3 chapters"; in order.
  [[nodiscard]] const std::vector<std::string>& kept() const noexcept { return kept_; }
  // What is left out, and why; a sentence each.
  [[nodiscard]] const std::vector<std::string>& leftOut() const noexcept { return left_out_; }

 private:
  struct Close {
    void operator()(AVFormatContext* file) const noexcept { avformat_close_input(&file); }
  };
  struct FreePacket {
    void operator()(AVPacket* packet) const noexcept { av_packet_free(&packet); }
  };
  using PacketPtr = std::unique_ptr<AVPacket, FreePacket>;
  struct Copy {
    AVStream* stream = nullptr;               // of the film
    std::int64_t last_dts = AV_NOPTS_VALUE;   // as the source has it, in the film's time base
    std::int64_t least_dts = AV_NOPTS_VALUE;  // that the next packet may have
    std::unique_ptr<TextSubtitles> converter;
    PacketPtr text;  // converted; the next one joins it if it begins at the same time, since MP4 shows one at a time
  };

  // Whether the container's times may jump.
  [[nodiscard]] bool jumps() const noexcept { return (file_->iformat->flags & AVFMT_TS_DISCONT) != 0; }
  [[nodiscard]] bool isWished(const AVStream& stream) const noexcept;
  [[nodiscard]] Result<void> addStream(const AVStream& stream);
  [[nodiscard]] Result<void> addChapters();
  void addTitles();
  [[nodiscard]] Result<PacketPtr> next();
  void makeContinuous(AVPacket& packet);
  [[nodiscard]] MediaTime begins(const AVPacket& packet) const noexcept;
  [[nodiscard]] Result<void> write(PacketPtr packet);
  [[nodiscard]] Result<void> writeTextsBefore(MediaTime time);
  [[nodiscard]] Result<void> put(PacketPtr packet);

  // Shared with file system calls that have not returned yet and may outlive this object.
  struct Opened {
    std::shared_ptr<AVFormatContext> file;
    int code = 0;
  };
  [[nodiscard]] static Opened openNow(const std::string& path);
  struct Read {
    PacketPtr packet;
    int code = 0;
  };
  [[nodiscard]] static Read readNow(AVFormatContext& file);

  std::string path_;
  std::shared_ptr<AVFormatContext> file_;
  int picture_ = 0;
  Duration start_{0};
  ContinuousTime times_;
  KeptWishes wishes_;
  FilmPlace* place_ = nullptr;
  AVFormatContext* film_ = nullptr;  // the place's
  FilmKind kind_ = FilmKind::Matroska;
  std::map<int, Copy> copies_;  // by the file's stream
  PacketPtr waiting_;           // read, but not due yet
  bool ended_ = false;
  std::vector<std::string> kept_, left_out_;
};

}  // namespace relievo
