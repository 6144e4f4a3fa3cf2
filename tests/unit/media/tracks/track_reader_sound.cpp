// SPDX-License-Identifier: Apache-2.0
// The sound track of a TrackReader: read ahead, dropped, failed and sought.
#include <gtest/gtest.h>

#include <vector>

#include "tests/unit/media/tracks/film_of_tracks.h"

namespace relievo::test {
namespace {

TEST(TrackReader, SoundComesAlongWithThePictures) {
  std::vector<Scripted> script;
  for (int k = 0; k < 10; ++k) {
    script.push_back({2, 40 * k});
    script.push_back({0, 40 * k});
    script.push_back({2, 40 * k + 20});
  }
  Film film(script);
  film.listen();
  EXPECT_EQ(film.sound(), std::vector<int>{});
  EXPECT_EQ(film.next(0), 0);
  EXPECT_EQ(film.next(0), 40);
  EXPECT_EQ(film.sound(), (std::vector{0, 20, 40}));
}

// The container stores sound a second later than its pictures: it is fetched, and the pictures in between are kept.
TEST(TrackReader, ReadsAheadForSoundThatLiesLate) {
  std::vector<Scripted> script;
  for (int k = 0; k < 100; ++k) {
    script.push_back({0, 40 * k});
    if (k >= 25) script.push_back({2, 40 * (k - 25)});
  }
  Film film(script);
  EXPECT_FALSE(film.reader->readAhead()) << "no sound was selected";
  film.listen();
  EXPECT_FALSE(film.reader->readAhead()) << "before the first picture";
  EXPECT_EQ(film.next(0), 0);
  while (film.sound().empty()) ASSERT_TRUE(film.reader->readAhead());
  for (int k = 1; k < 100; ++k) ASSERT_EQ(film.next(0), 40 * k);
}

// Parts of 6 s, as in HLS: all pictures of a part, and then all its sound.
TEST(TrackReader, ReadsAheadForSoundBehindThePicturesOfAPart) {
  std::vector<Scripted> script;
  for (const int part : {0, 1}) {
    for (const int track : {0, 2}) {
      for (int k = 0; k < 150; ++k) script.push_back({track, 6000 * part + 40 * k});
    }
  }
  Film film(script);
  film.listen();
  std::size_t heard = 0;
  for (int k = 0; k < 300; ++k) {
    ASSERT_EQ(film.next(0), 40 * k);
    do heard += film.sound().size();
    while (heard <= static_cast<std::size_t>(k) && film.reader->readAhead());
    ASSERT_GT(heard, static_cast<std::size_t>(k)) << "the sound of this picture";
  }
}

TEST(TrackReader, ReadsNoFurtherAheadThanItsBound) {
  std::vector<Scripted> script;
  for (int k = 0; k < 1000; ++k) script.push_back({0, 40 * k});
  Film film(script);
  film.listen();
  EXPECT_EQ(film.next(0), 0);
  int read = 0;
  while (film.reader->readAhead()) ++read;
  EXPECT_EQ(read, TrackReader::kReadAhead / milliseconds(40) + 1);
  EXPECT_EQ(film.next(0), 40);
  EXPECT_TRUE(film.reader->readAhead());
}

TEST(TrackReader, SoundThatNobodyTakesIsDroppedTheOldestFirst) {
  std::vector<Scripted> script;
  const int count = static_cast<int>(SoundTrack::kMaxWaitingPackets) + 100;
  for (int k = 0; k < count; ++k) script.push_back({2, k});
  script.push_back({0, 0});
  Film film(script);
  film.listen();
  EXPECT_EQ(film.next(0), 0);
  const std::vector<int> times = film.sound();
  ASSERT_EQ(times.size(), 1000u) << "then the decoder gives up";
  EXPECT_EQ(times.front(), 100);
}

TEST(TrackReader, ADecoderOfSoundThatFailsEndsTheSoundAlone) {
  std::vector<Scripted> script;
  for (int k = 0; k < 10; ++k) {
    script.push_back({2, 40 * k});
    script.push_back({0, 40 * k});
  }
  Film film(script);
  film.listen().lose_after = 2;
  for (int k = 0; k < 10; ++k) ASSERT_EQ(film.next(0), 40 * k);
  EXPECT_EQ(film.sound(), (std::vector{0, 40}));
  EXPECT_EQ(film.next(0), -1);
}

TEST(TrackReader, ASeekForgetsSoundAsWell) {
  std::vector<Scripted> script;
  for (int k = 0; k < 100; ++k) {
    script.push_back({0, 40 * k, k % 10 == 0});
    script.push_back({2, 40 * k});
  }
  Film film(script);
  film.listen();
  for (int k = 0; k < 5; ++k) EXPECT_EQ(film.next(0), 40 * k);
  ASSERT_TRUE(film.reader->seek(MediaTime(milliseconds(40 * 50))).has_value());
  const int picture = film.next(0);
  EXPECT_GT(picture, 40 * 5);
  const std::vector<int> times = film.sound();
  ASSERT_FALSE(times.empty());
  EXPECT_EQ(times.front(), picture);
}

}  // namespace
}  // namespace relievo::test
