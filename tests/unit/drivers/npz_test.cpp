// SPDX-License-Identifier: Apache-2.0
// Archives of arrays that Python's zipfile writes, stored and deflated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "app/media/pair_reader.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/real_backends.h"
#include "tests/unit/drivers/decoded_film.h"

namespace relievo {
namespace {

using test::DecodedFilm;
using test::decodeFilm;
using testing::EndsWith;
using testing::HasSubstr;

constexpr int kCols = 40, kRows = 30, kPictures = 9;

// As numpy.savez does it, which gives each member a header of 64-bit sizes.
constexpr const char* kWriter = R"(
import struct, sys, zipfile

def npy(kind, shape, values):
    head = "{'descr': '%s', 'fortran_order': False, 'shape': (%s,), }" % (kind, ", ".join(map(str, shape)))
    head += " " * (-(len(head) + 11) % 64) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(head)) + head.encode() + values

def floats(pictures, add):
    return struct.pack("<%df" % (pictures * 1200), *(20 * k + 10 * r + c / 4 + add
                       for k in range(pictures) for r in range(30) for c in range(40)))

arrays = {
    "depths": ("<f4", (9, 30, 40), floats(9, 1)),
    "depth_conf": ("<f4", (9, 30, 40), floats(9, 7)),
    "frames": ("|u1", (9, 30, 40, 3), bytes(range(240)) * 135),
    "cut": ("<f4", (12, 30, 40), floats(9, 1)),
    "K": ("<f8", (3, 3), bytes(72)),
    "arr_0": ("<f4", (30, 40), floats(1, 1)),
}
path, method, names = sys.argv[1], int(sys.argv[2]), sys.argv[3].split(",")
with zipfile.ZipFile(path, "w", method, allowZip64=True) as archive:
    for name in names:
        with archive.open(name + ".npy", "w", force_zip64=True) as member:
            member.write(npy(*arrays[name]))
)";

class Npz : public testing::Test {
 protected:
  [[nodiscard]] std::string archive(const std::string& names, int method, const std::string& file = "film.npz") const {
    std::ofstream(folder_ / "write.py") << kWriter;
    const std::string path = folder_ / file;
    const std::string command =
        "python3 '" + folder_ / "write.py" + "' '" + path + "' " + std::to_string(method) + " " + names;
    EXPECT_EQ(std::system(command.c_str()), 0);
    return path;
  }
  [[nodiscard]] static std::string refusal(const std::string& path) {
    const auto opened = drivers::makeMediaSource(path)->open(path);
    return opened ? "" : opened.error().message;
  }
  static void expectPicture(const Frame& frame, int number) {
    ASSERT_EQ(frame.width, kCols);
    ASSERT_EQ(frame.height, kRows);
    for (int r = 0; r < kRows; ++r) {
      for (int c = 0; c < kCols; ++c) {
        ASSERT_NEAR(test::sampleAt(frame, 0, c, r) * frame.value_per_code, 20 * number + 10 * r + c / 4.0 + 1,
                    0.51 * frame.value_per_code)
            << number << ": " << c << ", " << r;
      }
    }
  }

  const test::TemporaryFolder folder_;
};

constexpr int kStored = 0, kDeflated = 8;

TEST_F(Npz, TheArrayThatSaysDepthIsAFilm) {
  for (const int method : {kStored, kDeflated}) {
    SCOPED_TRACE(method);
    const std::string path = archive("K,frames,depth_conf,depths", method);
    const DecodedFilm film = decodeFilm(path);
    EXPECT_THAT(film.stream.tags.at("FILE"), EndsWith("film.npz/depths.npy"));
    ASSERT_EQ(film.frames.size(), std::size_t{kPictures});
    for (int k = 0; k < kPictures; ++k) expectPicture(film.frames[static_cast<std::size_t>(k)], k);
  }
}

TEST_F(Npz, TheOnlyPictureIsTakenWhateverItsName) {
  const DecodedFilm film = decodeFilm(archive("K,arr_0", kDeflated));
  ASSERT_EQ(film.frames.size(), 1u);
  expectPicture(film.frames[0], 0);
}

// Backwards means from the beginning, where an array is deflated.
TEST_F(Npz, ASeekGivesThePicturesOfItsPlace) {
  for (const int method : {kStored, kDeflated}) {
    SCOPED_TRACE(method);
    PairReader reader(kReal);
    ASSERT_TRUE(reader.open({.url = archive("depths", method)}));
    const auto timeOfNext = [&](int number) {
      const auto pair = reader.next();
      if (!pair || !*pair) return MediaTime::max();
      expectPicture((*pair)->depth, number);
      return (*pair)->depth.pts;
    };
    const MediaTime first = timeOfNext(0), second = timeOfNext(1);
    for (int k = 2; timeOfNext(k) != MediaTime::max(); ++k) {
    }
    ASSERT_TRUE(reader.seek(second));
    EXPECT_EQ(timeOfNext(1), second);
    ASSERT_TRUE(reader.seek(first));
    EXPECT_EQ(timeOfNext(0), first);
  }
}

TEST_F(Npz, WhatCannotBeChosenIsRefusedWithWhatToDo) {
  EXPECT_THAT(refusal(archive("depths,arr_0,depth_conf", kStored)), "") << "one says depth";
  EXPECT_THAT(refusal(archive("depth_conf,arr_0", kStored)), HasSubstr("several arrays"));
  EXPECT_THAT(refusal(archive("K", kStored)), HasSubstr("no array"));
  const std::string cut = archive("depths", kDeflated);
  std::filesystem::resize_file(cut, 2 * std::filesystem::file_size(cut) / 3);
  EXPECT_THAT(refusal(cut), HasSubstr("copy it again"));
}

// It has nine of the twelve pictures that it announces.
TEST_F(Npz, AnArrayThatEndsEarlyIsTold) {
  for (const int method : {kStored, kDeflated}) {
    const std::string path = archive("cut,K", method);
    const auto source = drivers::makeMediaSource(path);
    ASSERT_TRUE(source->open(path));
    int pictures = 0;
    for (;; ++pictures) {
      const auto packet = source->read();
      ASSERT_TRUE(packet);
      if (!*packet) break;
    }
    EXPECT_EQ(pictures, kPictures);
    EXPECT_EQ(source->missing(), std::chrono::milliseconds(3 * 40));
  }
}

// Of 4096 x 4096 numbers of 8 bytes. Nobody reads them here.
TEST(NpzDecoder, HoldsOneLargePictureAndSeveralSmallOnes) {
  const auto accepted = [](std::size_t bytes) {
    const auto decoder = drivers::makeSoftwareDecoder({.kind = StreamKind::Video, .codec = "npy"});
    EXPECT_TRUE(decoder->open({.kind = StreamKind::Video, .codec = "npy"}));
    const std::uint8_t nothing = 0;
    int packets = 0;
    while (decoder->feed({.data = &nothing, .bytes = bytes}) == Feed::Accepted) ++packets;
    return packets;
  };
  EXPECT_EQ(accepted(134'000'000), 1);
  EXPECT_EQ(accepted(30'000'000), 2);
  EXPECT_EQ(accepted(1'000'000), 4);
}

}  // namespace
}  // namespace relievo
