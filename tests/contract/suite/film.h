// SPDX-License-Identifier: Apache-2.0
// The same short film for every back end of source and decoder: 30 pictures of 64 x 48 at 25 a second, every tenth a
// key frame. A decoder is tested with packets of a source: a small one that makes them up will do.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "hal/media/media_source.h"
#include "hal/media/video_decoder.h"
#include "platform/clock.h"
#include "tests/contract/suite/backend_name.h"

namespace relievo::test {

inline constexpr int kFilmFrames = 30;
inline constexpr int kFilmKeyInterval = 10;
inline constexpr Duration kFilmPeriod = std::chrono::milliseconds(40);

struct FilmBackend {
  const char* name;
  std::unique_ptr<MediaSource> (*make_source)();
  std::unique_ptr<VideoDecoder> (*make_decoder)();
  std::string (*url)();
  const char* missing_url;  // null if every URL is a film
  Duration key_step = std::chrono::milliseconds(400);
  bool titled = true;  // the container has a tag TITLE, which is "film"
};
inline void PrintTo(const FilmBackend& backend, std::ostream* out) {
  *out << backend.name;
}

class FilmContract : public testing::TestWithParam<FilmBackend> {
 protected:
  [[nodiscard]] std::unique_ptr<MediaSource> openSource() const {
    auto source = GetParam().make_source();
    EXPECT_TRUE(source->open(GetParam().url()));
    return source;
  }
  // All packets from here to the end.
  [[nodiscard]] static std::vector<Packet> readAll(MediaSource& source) {
    std::vector<Packet> packets;
    for (;;) {
      auto packet = source.read();
      EXPECT_TRUE(packet);
      if (!packet || !*packet) return packets;
      packets.push_back(std::move(**packet));
    }
  }
};

}  // namespace relievo::test
