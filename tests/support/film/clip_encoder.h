// SPDX-License-Identifier: Apache-2.0
// What the encoders of a clip's tracks share. For clip_maker and clip_sound alone.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "tests/support/film/clip_maker.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace relievo::test {

inline constexpr AVRational kNanosecond{1, 1'000'000'000};

[[noreturn]] inline void give_up(const std::string& what, int code = 0) {
  char reason[AV_ERROR_MAX_STRING_SIZE] = "";
  if (code < 0) av_strerror(code, reason, sizeof reason);
  throw std::runtime_error("clip: " + what + " " + reason);
}
inline int check(int code, const std::string& what) {
  if (code < 0) give_up(what, code);
  return code;
}

struct Free {
  void operator()(AVFormatContext* c) const {
    if ((c->oformat->flags & AVFMT_NOFILE) == 0) avio_closep(&c->pb);
    avformat_free_context(c);
  }
  void operator()(AVCodecContext* c) const { avcodec_free_context(&c); }
  void operator()(AVFrame* f) const { av_frame_free(&f); }
  void operator()(AVPacket* p) const { av_packet_free(&p); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

// One track on its way into the file.
class Encoder {
 public:
  virtual ~Encoder() = default;
  [[nodiscard]] virtual bool done() const = 0;
  [[nodiscard]] virtual Duration nextTime() const = 0;
  virtual void encodeNext() = 0;
  virtual void finish() = 0;
};

[[nodiscard]] std::unique_ptr<Encoder> makeSoundEncoder(AVFormatContext& file, const ClipSound& sound);

}  // namespace relievo::test
