// SPDX-License-Identifier: Apache-2.0
// A film as the registry's source and decoder give it: its stream, all of its pictures, and what was passed over.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/registry.h"
#include "tests/support/film/recording/recorded_frames.h"

namespace relievo::test {

struct DecodedFilm {
  StreamInfo stream;
  std::vector<Frame> frames;
  std::vector<std::string> notes;
  std::string decoder;        // its name
  std::uint64_t missed = 0;   // pictures that the source passed over
  std::uint64_t damaged = 0;  // pictures that the decoder passed over
};

// Decodes a film with one stream.
inline DecodedFilm decodeFilm(const std::string& url) {
  DecodedFilm film;
  const auto source = drivers::makeMediaSource(url);
  EXPECT_TRUE(source->open(url));
  if (source->streams().empty()) return film;
  film.stream = source->streams()[0];
  const auto decoder = drivers::makeVideoDecoder(film.stream);
  EXPECT_TRUE(decoder->open(film.stream));
  film.decoder = decoder->capabilities().name;
  film.frames = framesOf(*source, film.stream, *decoder);
  film.notes = source->notes();
  film.missed = source->missedPictures();
  film.damaged = decoder->damaged();
  return film;
}

}  // namespace relievo::test
