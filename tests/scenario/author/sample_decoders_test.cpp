// SPDX-License-Identifier: Apache-2.0
// The sample film through every decoder: the same samples of colour and depth, and the report says which one decoded
// and why no better one did.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/author/author.h"
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
  // Its first seconds, a third as wide: like the whole sample its height is no multiple of a macroblock's.
  std::string makeSample() {
    const std::string path = folder_ / "sample.mkv";
    OutputOptions output{.path = path};
    output.depth.flat_chroma = true;
    const auto made = authorSample({.cols = 240, .rows = 162, .frames = static_cast<int>(kFrames)}, output,
                                   std::atomic<bool>(false), [](std::uint64_t, std::optional<std::uint64_t>) {});
    EXPECT_TRUE(made) << made.error().error.message;
    return path;
  }
  // The report on the first second of the film, played in real time.
  nlohmann::json reportOf(const std::string& film, const std::string& decoder) {
    std::ofstream(folder_ / "keys.txt") << "1 POWER\n";
    const auto played =
        test::runProgram("relievo play " + film + " --display mock --haptic none --decoder " + decoder +
                             " --remote script:" + (folder_ / "keys.txt") + " --report " + (folder_ / "report.json"),
                         folder_ / "");
    EXPECT_EQ(played.exit_code, 0) << played.err;
    return nlohmann::json::parse(std::ifstream(folder_ / "report.json"))["film"];
  }
  static constexpr std::size_t kFrames = 120;
  test::TemporaryFolder folder_;
};

TEST_F(SampleDecoders, GiveTheSameDepthToTheBitAndAreNamedInTheReport) {
  const std::string path = makeSample();
  const Film film(path, 1);
  const bool hevc = film.stream.codec == "hevc";
  const auto software = test::bySoftware(film);
  ASSERT_EQ(software.size(), kFrames);
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
