// SPDX-License-Identifier: Apache-2.0
// Which of GStreamer's elements decodes a film, and how long it may take.
#include <algorithm>
#include <string>
#include <utility>

#include "drivers/gstreamer/gstreamer.h"
#include "tests/contract/decoded_film.h"
#include "tests/contract/state_table.h"
#include "tests/support/device/gstreamer_element.h"

namespace relievo {
namespace {

using test::bySoftware;
using test::Film;
using test::GstreamerElement;
using test::play;
using Fault = GstreamerElement::Fault;

const bool kPrepared = [] {
  test::keepGstreamerListAt(RELIEVO_BIN_DIR "/../tests/gstreamer.list");
  return true;
}();

class GstreamerChoice : public testing::Test {
 protected:
  [[nodiscard]] Film film(const test::ClipTrack& track = test::movingClip()) const {
    const std::string path = folder_ / "film.mkv";
    test::makeClip(path, {track});
    return Film(path);
  }
  [[nodiscard]] static std::unique_ptr<VideoDecoder> open(const Film& film, const std::string& element = "") {
    auto decoder = makeGstreamerDecoder(element);
    const auto opened = decoder->open(film.stream);
    EXPECT_TRUE(opened) << opened.error().message;
    return decoder;
  }
  static ErrorCode refusal(const Film& film, const std::string& element = "") {
    const auto opened = makeGstreamerDecoder(element)->open(film.stream);
    return opened ? ErrorCode::InvalidState : opened.error().code;
  }

 private:
  const test::TemporaryFolder folder_;
};

TEST_F(GstreamerChoice, WhatItCannotDecodeItRefusesBeforehand) {
  GstreamerElement element;
  const Film film = this->film();
  test::ClipTrack vp8 = test::movingClip();
  vp8.codec = "libvpx";
  vp8.b_frames = 0;
  EXPECT_EQ(refusal(this->film(vp8)), ErrorCode::NotFound) << "no such hardware";
  EXPECT_EQ(refusal(this->film({})), ErrorCode::Unsupported) << "another codec";
  EXPECT_EQ(refusal(film, "nosuchelement"), ErrorCode::Unsupported);
  EXPECT_EQ(refusal(film, "avdec_vp8"), ErrorCode::Unsupported);
  EXPECT_EQ(element.instances(), 0);
  const auto decoder = open(film);
  EXPECT_EQ(decoder->description(), std::string("gstreamer, ") + GstreamerElement::kName);
  EXPECT_TRUE(decoder->capabilities().hardware);
  const auto seen = lookAtGstreamerElements();
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.front().name, GstreamerElement::kName);
  EXPECT_EQ(seen.front().title, "a decoder that is not there");
}

TEST_F(GstreamerChoice, HardwareIsWhatSaysSoAndWhatIsKnownOfMakers) {
  const GstreamerElement element;
  const Film film = this->film();
  EXPECT_TRUE(open(film, GstreamerElement::kMakers)->capabilities().hardware);
  EXPECT_FALSE(open(film, GstreamerElement::kSoftware)->capabilities().hardware);
  const auto seen = lookAtGstreamerElements();
  const auto lists = [&](const char* name) { return std::ranges::count(seen, name, &relievo::GstreamerElement::name); };
  EXPECT_EQ(lists(GstreamerElement::kMakers), 1);
  EXPECT_EQ(lists(GstreamerElement::kSoftware), 0);
}

TEST_F(GstreamerChoice, AnElementThatGivesFewerBitsThanTheFilmHasIsNotTaken) {
  const GstreamerElement element;
  Film film = this->film();
  for (const auto& [bits, taken] : {std::pair{0, true}, {8, true}, {10, false}}) {
    film.stream.bits = bits;
    const auto opened = makeGstreamerDecoder(GstreamerElement::kSoftware)->open(film.stream);
    EXPECT_EQ(test::answerOf(opened), taken ? test::Answer() : ErrorCode::Unsupported) << bits;
  }
  EXPECT_TRUE(open(film)) << "the other one names no formats";
}

// On a busy machine all of its threads may wait for a processor.
TEST_F(GstreamerChoice, AnElementInSoftwareMayTakeItsTime) {
  const Film film = this->film();
  GstreamerElement element;
  element.befall(Fault::Pauses, 0, 1);
  EXPECT_EQ(play(*open(film, GstreamerElement::kSoftware), film), bySoftware(film));
  element.befall(Fault::Pauses, 10, 1);
  std::vector<test::Shown> shown;
  const auto hardware = open(film);
  EXPECT_EQ(test::answerOf(test::feedTo(*hardware, film, 0, film.packets.size(), shown)), ErrorCode::Lost);
}

}  // namespace
}  // namespace relievo
