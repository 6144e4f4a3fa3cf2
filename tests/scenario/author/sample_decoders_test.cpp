// SPDX-License-Identifier: Apache-2.0
// The sample film through every decoder: the same samples of colour and depth, and the report says which one decoded
// and why no better one did.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/v4l2/v4l2.h"
#include "tests/contract/decoded_film.h"
#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_codec.h"
#include "tests/support/machine/program.h"
#ifdef RELIEVO_GSTREAMER
#include "drivers/gstreamer/gstreamer.h"
#include "tests/support/device/gstreamer_element.h"
#endif

namespace relievo {
namespace {

using test::Film;
using test::play;
using testing::StartsWith;

class SampleDecoders : public test::MockedMachine {
 protected:
  // `options`: of the author, beside the sample.
  std::string makeSample(const std::string& options) {
    const std::string path = folder_ / "sample.mkv";
    const auto made =
        test::runProgram("relievo-author --scene sample -o " + path + " --force " + options, folder_ / "");
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path;
  }
  nlohmann::json reportOf(const std::string& film, const std::string& decoder) {
    const auto played = test::runProgram("relievo play " + film + " --display mock --haptic none --decoder " + decoder +
                                             " --report " + (folder_ / "report.json"),
                                         folder_ / "");
    EXPECT_EQ(played.exit_code, 0) << played.err;
    return nlohmann::json::parse(std::ifstream(folder_ / "report.json"))["film"];
  }
  test::TemporaryFolder folder_;
};

TEST_F(SampleDecoders, GiveTheSameDepthToTheBitAndAreNamedInTheReport) {
  const std::string path = makeSample("--depth-chroma flat");
  const Film film(path, 1);
  const bool hevc = film.stream.codec == "hevc";
  const auto software = test::bySoftware(film);
  ASSERT_GT(software.size(), 100U);
  {
    test::UmockdevCodec codec(bed_, 10, {.packets = hevc ? V4L2_PIX_FMT_HEVC : V4L2_PIX_FMT_H264});
    const auto hardware = makeV4l2M2mDecoder();
    ASSERT_TRUE(hardware->open(film.stream));
    EXPECT_EQ(play(*hardware, film), software);
  }
  EXPECT_EQ(reportOf(path, "ffmpeg")["depth"]["decoder"], "ffmpeg");
  {
    test::UmockdevCodec small(bed_, 10, {.packets = hevc ? V4L2_PIX_FMT_HEVC : V4L2_PIX_FMT_H264, .largest = 64});
    EXPECT_THAT(reportOf(path, "v4l2")["depth"]["decoder"].get<std::string>(),
                StartsWith("ffmpeg; no better decoder: "));
  }
#ifdef RELIEVO_GSTREAMER
  const std::string element = hevc ? "avdec_h265" : "avdec_h264";
  test::keepGstreamerListAt(RELIEVO_BIN_DIR "/../tests/gstreamer.list");
  const auto decoder = makeGstreamerDecoder(element);
  ASSERT_TRUE(decoder->open(film.stream));
  EXPECT_EQ(play(*decoder, film), software);
  EXPECT_EQ(reportOf(path, "gstreamer:" + element)["depth"]["decoder"], "gstreamer, " + element);
  EXPECT_THAT(reportOf(path, "gstreamer:nosuchelement")["depth"]["decoder"].get<std::string>(),
              StartsWith("ffmpeg; no better decoder: "));
#endif
}

}  // namespace
}  // namespace relievo
