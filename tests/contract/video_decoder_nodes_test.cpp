// SPDX-License-Identifier: Apache-2.0
// Hardware decoders that differ in what they tell and take: which of them a film gets, and that it plays on each.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <tuple>

#include "drivers/v4l2/v4l2.h"
#include "tests/contract/decoded_film.h"
#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_codec.h"

namespace relievo {
namespace {

using test::bySoftware;
using test::CodecKind;
using test::Film;
using test::play;
using test::UmockdevCodec;

class V4l2Nodes : public test::MockedMachine {
 protected:
  [[nodiscard]] Film film(const std::string& name = "film.mkv",
                          const test::ClipTrack& track = test::movingClip()) const {
    const std::string path = folder_ / name;
    test::makeClip(path, {track});
    return Film(path);
  }
  [[nodiscard]] static std::unique_ptr<VideoDecoder> open(const Film& film) {
    auto decoder = makeV4l2M2mDecoder();
    const auto opened = decoder->open(film.stream);
    EXPECT_TRUE(opened) << opened.error().message;
    return decoder;
  }
  static ErrorCode refusal(const Film& film) {
    const auto opened = makeV4l2M2mDecoder()->open(film.stream);
    return opened ? ErrorCode::InvalidState : opened.error().code;
  }

  [[nodiscard]] const test::TemporaryFolder& folder() const { return folder_; }

 private:
  const test::TemporaryFolder folder_;
};

// Some drivers say nothing if the size is the one that they were given, some nothing before they have buffers for
// pictures; some take many packets meanwhile.
TEST_F(V4l2Nodes, ADriverThatTellsNoFormatIsAskedForIt) {
  Film film = this->film();
  const CodecKind kinds[] = {{.silent = true},
                             {.pictures = V4L2_PIX_FMT_NV12M, .planes = true, .silent = true},
                             {.waits = true},
                             {.silent = true, .ahead = 100}};
  for (const std::size_t packets : {film.packets.size(), std::size_t{5}}) {
    film.packets.resize(packets);
    const auto software = bySoftware(film);
    ASSERT_EQ(software.size(), packets);
    for (const CodecKind& kind : kinds) {
      SCOPED_TRACE(&kind - kinds);
      UmockdevCodec codec(bed_, 10, kind);
      const auto decoder = open(film);
      EXPECT_EQ(play(*decoder, film), software);
      EXPECT_EQ(decoder->damaged(), 0u);
      EXPECT_EQ(codec.openings(), 1);
    }
  }
}

// Then the container's size is visible where it is about the driver's, and later the driver's, here without padding.
TEST_F(V4l2Nodes, ADriverMayNotTellTheVisiblePart) {
  for (const auto& [width, height, later] : {std::tuple{100, 70, 100}, {64, 48, 160}}) {
    SCOPED_TRACE(later);
    const std::string both = folder() / "both.ts";
    std::filesystem::remove(both);
    test::ClipTrack track = test::movingClip(width, height);
    for (const char* name : {"a.ts", "b.ts"}) {
      (void)film(name, track);
      std::ofstream(both, std::ios::binary | std::ios::app) << std::ifstream(folder() / name).rdbuf();
      if (later != width) track.width = later, track.height = 2 * height;
      track.start = std::chrono::seconds(5);
    }
    UmockdevCodec codec(bed_, 10, {.selects = false});
    const Film film(both);
    EXPECT_EQ(play(*open(film), film), bySoftware(film));
  }
}

TEST_F(V4l2Nodes, WhatItCannotDecodeItRefusesBeforehand) {
  EXPECT_EQ(refusal(film()), ErrorCode::NotFound) << "no hardware";
  test::ClipTrack fine = test::movingClip();
  fine.pix_fmt = "yuv420p10le";
  test::ClipTrack colourful = test::movingClip();
  colourful.pix_fmt = "yuv444p";
  test::ClipTrack gray = test::movingClip();
  gray.pix_fmt = "gray";
  {
    UmockdevCodec codec(bed_, 10, {.largest = 128});
    EXPECT_EQ(refusal(film("fine.mkv", fine)), ErrorCode::Unsupported);
    EXPECT_EQ(refusal(film("colourful.mkv", colourful)), ErrorCode::Unsupported);
    EXPECT_EQ(refusal(film("gray.mkv", gray)), ErrorCode::Unsupported);
    EXPECT_EQ(refusal(film("wide.mkv", test::movingClip(160, 64))), ErrorCode::Unsupported);
    EXPECT_EQ(refusal(film("lossless.mkv", {})), ErrorCode::Unsupported) << "another codec";
    fine.codec = "libx265";
    fine.options = {{"x265-params", "log-level=none"}};
    EXPECT_EQ(refusal(film("hevc10.mkv", fine)), ErrorCode::NotFound) << "none of this codec";
    EXPECT_EQ(codec.openings(), 0);
  }
  for (const CodecKind& kind : {CodecKind{.smallest = 80}, CodecKind{.pictures = V4L2_PIX_FMT_NV12_4L4}}) {
    UmockdevCodec codec(bed_, 10, kind), other(bed_, 11);
    EXPECT_EQ(open(film())->description(), "v4l2-m2m, A decoder that is not there at /dev/video11");
    EXPECT_EQ(codec.openings(), 0) << "it takes larger pictures alone, or gives tiles";
  }
  UmockdevCodec codec(bed_, 10, {.main_profile_only = true});
  EXPECT_EQ(refusal(film()), ErrorCode::Unsupported) << "High";
  test::ClipTrack main = test::movingClip();
  main.options = {{"profile", "main"}};
  const Film in_main = film("main.mkv", main);
  EXPECT_EQ(play(*open(in_main), in_main), bySoftware(in_main));
}

TEST_F(V4l2Nodes, NodesAreListedByTheirNumbers) {
  EXPECT_TRUE(lookAtV4l2M2mNodes().empty());
  UmockdevCodec second(bed_, 11, {.packets = V4L2_PIX_FMT_HEVC, .planes = true}), first(bed_, 2);
  const auto nodes = lookAtV4l2M2mNodes();
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].path, "/dev/video2");
  EXPECT_EQ(nodes[0].card, "A decoder that is not there");
  EXPECT_EQ(nodes[0].codecs, std::vector<std::string>{"h264"});
  EXPECT_EQ(nodes[1].path, "/dev/video11");
  EXPECT_EQ(nodes[1].codecs, std::vector<std::string>{"hevc"});
}

TEST_F(V4l2Nodes, ABusyNodeLeavesTheFilmToTheNextOne) {
  UmockdevCodec codec(bed_, 10), other(bed_, 11);
  const Film film = this->film();
  const auto first = open(film), second = open(film);
  EXPECT_EQ(other.openings(), 1);
  EXPECT_EQ(refusal(film), ErrorCode::Io);
  EXPECT_EQ(play(*first, film), play(*second, film));
}

}  // namespace
}  // namespace relievo
