// SPDX-License-Identifier: Apache-2.0
// The self test finds what is missing: each part is taken away in turn.
#include "app/player/setup/self_test.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/mock/mock.h"
#include "drivers/sim/profiles.h"
#include "drivers/sim/sim.h"

namespace relievo {
namespace {

using testing::HasSubstr;
using Verdict = SelfTestLine::Verdict;

class SelfTest : public testing::Test {
 protected:
  // Runs the self-test and returns its lines, without those on fonts and real-time scheduling, which depend on the
  // machine.
  std::map<std::string, SelfTestLine> run() {
    auto display = makeMockDisplay(display_, clock_);
    auto setup = parseSim("");
    auto haptic = hand_ ? makeSimHaptic(setup->profile, std::move(setup->path), clock_) : makeMockHaptic({}, clock_);
    const auto make_decoder = [this](const StreamInfo& stream) {
      return isMock(stream) || stream.codec == unknown_codec_ ? makeMockDecoder({.max_held_frames = 32})
                                                              : makeFfmpegDecoder();
    };
    std::map<std::string, SelfTestLine> lines;
    for (SelfTestLine& line :
         selfTest({.clock = clock_,
                   .display = *display,
                   .haptic = *haptic,
                   .backends = {.make_source = [this](auto&) { return makeMockSource(film_, clock_); },
                                .make_decoder = make_decoder,
                                .read_text = {},
                                .make_audio_decoder = makeFfmpegAudioDecoder},
                   .film = "mock:"})) {
      lines[line.thing] = std::move(line);
    }
    return lines;
  }
  void shorten() {
    for (MockTrack& track : film_.tracks) track.frames = 6;
  }

  MonotonicClock clock_;
  MockDisplayProfile display_{.refresh_period = std::chrono::milliseconds(5)};
  MockMediaProfile film_ = mockFilm();
  bool hand_ = true;
  std::string unknown_codec_;
};

TEST_F(SelfTest, IsContentWithAWholeMachine) {
  const auto lines = run();
  for (const char* thing : {"pictures", "sound", "display", "touch"}) {
    ASSERT_TRUE(lines.contains(thing)) << thing;
    EXPECT_EQ(lines.at(thing).verdict, Verdict::Good) << thing << ": " << lines.at(thing).said;
  }
  EXPECT_THAT(lines.at("pictures").said, HasSubstr("h264"));
  EXPECT_NE(lines.at("text").verdict, Verdict::Bad);
  EXPECT_NE(lines.at("real time").verdict, Verdict::Bad);
}

TEST_F(SelfTest, SaysThatThereIsNoDisplayAndWhy) {
  display_.fail_open = ErrorCode::Unsupported;
  const auto lines = run();
  EXPECT_EQ(lines.at("display").verdict, Verdict::Bad);
  EXPECT_EQ(std::ranges::count_if(lines, [](const auto& line) { return line.second.said.contains("not to open"); }), 1);
}

TEST_F(SelfTest, IsNotContentWithAFingerThatFeelsNothing) {
  shorten();
  hand_ = false;
  EXPECT_EQ(run().at("touch").verdict, Verdict::Bad);
}

TEST_F(SelfTest, NamesTheCodecThatIsMissing) {
  shorten();
  unknown_codec_ = "hevc";
  const SelfTestLine line = run().at("pictures");
  EXPECT_EQ(line.verdict, Verdict::Note);
  EXPECT_THAT(line.said, HasSubstr("hevc"));
  EXPECT_THAT(line.said, testing::Not(HasSubstr("h264")));
}

}  // namespace
}  // namespace relievo
