// SPDX-License-Identifier: Apache-2.0
// The offscreen display: reopens any number of times, keeps instances separate, and captures what was presented.
#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "drivers/egl/egl.h"
#include "drivers/egl/egl_context.h"
#include "drivers/egl/offscreen_platform.h"
#include "platform/clock.h"
#include "tests/support/machine/sanitizers.h"

namespace relievo {
namespace {

// Skips where there is no EGL.
#define OPEN_OR_SKIP(display, ...)                                                                        \
  do {                                                                                                    \
    const auto opened = (display).open(__VA_ARGS__);                                                      \
    if (!opened && opened.error().code == ErrorCode::Unsupported) GTEST_SKIP() << opened.error().message; \
    ASSERT_TRUE(opened) << opened.error().message;                                                        \
  } while (false)

std::array<int, 3> pixel(int x, int y) {
  std::array<std::uint8_t, 4> rgba{};
  glReadPixels(x, y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return {rgba[0], rgba[1], rgba[2]};
}

void fill(float red, float green, float blue) {
  glDisable(GL_SCISSOR_TEST);
  glClearColor(red, green, blue, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

const ManualClock kStill;

// A temporary file, removed after the test.
class CaptureFile {
 public:
  explicit CaptureFile(const char* name)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(getpid()) + "_" + name)) {}
  ~CaptureFile() { std::filesystem::remove(path_); }
  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::string content() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::filesystem::path path_;
};

// Mesa has EGL devices of its own (its software renderer among them), so that the way to a driver without Mesa is
// tried.
TEST(OffscreenDisplay, CanDrawOnEachEglDeviceThatHasGles3) {
  int drawn = 0;
  for (EGLDisplay shown : offscreenDisplays()) {
    auto context = EglContext::createForPbuffers(shown);
    if (!context) continue;
    constexpr std::array<EGLint, 5> kOnePixel{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    EGLSurface surface = eglCreatePbufferSurface(shown, context->config(), kOnePixel.data());
    ASSERT_NE(surface, EGL_NO_SURFACE);
    ASSERT_TRUE(context->makeCurrent(surface));
    fill(0, 1, 0);
    EXPECT_EQ(pixel(0, 0), (std::array<int, 3>{0, 255, 0}));
    ++drawn;
    eglMakeCurrent(shown, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroySurface(shown, surface);
  }
  if (drawn == 0) GTEST_SKIP() << "no EGL display with GLES 3";
  EXPECT_GE(drawn, 2) << "the surfaceless platform and at least one device";
}

TEST(OffscreenDisplay, GivesTheSizeAskedForAndGles3) {
  const auto display = makeOffscreenDisplay({}, kStill);
  EXPECT_TRUE(display->capabilities().gles);
  EXPECT_EQ(display->capabilities().refresh_period, Duration(0));
  OPEN_OR_SKIP(*display, {321, 123});
  const auto surface = display->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->width, 321);
  EXPECT_EQ(surface->height, 123);
  GLint major = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  EXPECT_GE(major, 3);
  fill(0, 1, 0);
  EXPECT_EQ(pixel(320, 122), (std::array{0, 255, 0}));
  GLint depth_bits = 0;
  glGetIntegerv(GL_DEPTH_BITS, &depth_bits);
  EXPECT_GE(depth_bits, 16);
  EXPECT_EQ(display->present(), Duration(0));
}

TEST(OffscreenDisplay, OpensAgainAThousandTimes) {
  const auto display = makeOffscreenDisplay({}, kStill);
  const int rounds = kMemorySanitizer ? 100 : 1000;  // it makes a round 20 times as slow
  for (int round = 0; round < rounds; ++round) {
    OPEN_OR_SKIP(*display, {64, 64});
    ASSERT_TRUE(display->beginFrame());
    fill(1, 0, 0);
    ASSERT_EQ(pixel(10, 10), (std::array{255, 0, 0})) << round;
    ASSERT_TRUE(display->present());
    display->close();
  }
}

TEST(OffscreenDisplay, ClosingOneLeavesTheOtherAlone) {
  const auto first = makeOffscreenDisplay({}, kStill);
  const auto second = makeOffscreenDisplay({}, kStill);
  OPEN_OR_SKIP(*first, {32, 32});
  OPEN_OR_SKIP(*second, {16, 16});
  ASSERT_TRUE(first->beginFrame());
  fill(1, 0, 0);
  ASSERT_TRUE(second->beginFrame());
  fill(0, 0, 1);
  ASSERT_TRUE(second->present());
  second->close();
  EXPECT_EQ(first->present(), Duration(0));
  ASSERT_TRUE(first->beginFrame());
  EXPECT_EQ(pixel(5, 5), (std::array{255, 0, 0}));
  fill(0, 1, 0);
  EXPECT_EQ(pixel(5, 5), (std::array{0, 255, 0}));
}

TEST(OffscreenDisplay, LeavesNoContextCurrentWhenItIsDestroyedWhileOpen) {
  auto display = makeOffscreenDisplay({}, kStill);
  OPEN_OR_SKIP(*display, {32, 32});
  ASSERT_TRUE(display->beginFrame());
  display.reset();
  EXPECT_EQ(glGetString(GL_VERSION), nullptr);  // no context is left current
}

TEST(OffscreenDisplay, CapturesWhatWasPresentedInItsOrder) {
  const CaptureFile file("two_frames.y4m");
  ManualClock clock;
  const auto display = makeOffscreenDisplay(Capture::parse(file.path() + "@25"), clock);
  OPEN_OR_SKIP(*display, {4, 4});
  // The upper half red, the lower half green; then all blue.
  ASSERT_TRUE(display->beginFrame());
  fill(0, 1, 0);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 2, 4, 2);
  glClearColor(1, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ASSERT_TRUE(display->present());
  clock.advance(std::chrono::milliseconds(40));
  ASSERT_TRUE(display->beginFrame());
  fill(0, 0, 1);
  ASSERT_TRUE(display->present());
  display->close();

  // BT.709 limited: red is 62.6, 102.3, 240; green 172.6, 41.7, 26.3; blue 31.8, 240, 117.7.
  const auto bytes = [](std::size_t count, int value) { return std::string(count, static_cast<char>(value)); };
  const std::string expected =
      "YUV4MPEG2 W4 H4 F25000:1000 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\n"
      "FRAME\n" +
      bytes(8, 63) + bytes(8, 173) + bytes(2, 102) + bytes(2, 42) + bytes(2, 240) + bytes(2, 26) + "FRAME\n" +
      bytes(16, 32) + bytes(4, 240) + bytes(4, 118);
  EXPECT_EQ(file.content(), expected);
}

// At 25 frames/s. The luma of each picture in the file identifies it: white 235, black 16, blue 32.
TEST(OffscreenDisplay, CaptureHoldsItsRateWhateverComesLateOrEarly) {
  const CaptureFile file("steady.y4m");
  ManualClock clock;
  const auto display = makeOffscreenDisplay(Capture::parse(file.path() + "@25"), clock);
  OPEN_OR_SKIP(*display, {2, 2});
  const auto show = [&](int after_ms, float red_green, float blue) {
    clock.advance(std::chrono::milliseconds(after_ms));
    ASSERT_TRUE(display->beginFrame());
    fill(red_green, red_green, blue);
    ASSERT_TRUE(display->present());
  };
  show(0, 1, 1);   // white at 0 ms
  show(58, 0, 0);  // black, 18 ms late: neither repeated nor dropped
  show(24, 1, 1);  // white at 82 ms, 2 ms late
  show(78, 0, 1);  // blue at 160 ms: nothing came at 120 ms, so white is repeated
  show(1, 0, 0);   // black at 161 ms, 39 ms early
  show(1, 1, 1);   // white at 162 ms, two periods early: dropped
  display->close();

  const std::string content = file.content();
  std::string lumas;
  for (std::size_t at = content.find("FRAME\n"); at != std::string::npos; at = content.find("FRAME\n", at + 12)) {
    lumas += content[at + 6];
  }
  EXPECT_EQ(lumas, "\xeb\x10\xeb\xeb\x20\x10");
}

TEST(OffscreenDisplay, CaptureOfAnOddSizeRoundsItsChromaUp) {
  const CaptureFile file("odd.y4m");
  const auto display = makeOffscreenDisplay(Capture::parse(file.path()), kStill);
  OPEN_OR_SKIP(*display, {5, 3});
  ASSERT_TRUE(display->beginFrame());
  fill(1, 1, 1);
  ASSERT_TRUE(display->present());
  display->close();
  const std::string header = "YUV4MPEG2 W5 H3 F30000:1000 Ip A1:1 C420jpeg XCOLORRANGE=LIMITED\nFRAME\n";
  EXPECT_EQ(file.content(), header + std::string(15, static_cast<char>(235)) + std::string(12, static_cast<char>(128)));
}

TEST(OffscreenDisplay, CaptureBeginsAnewWhenOpenedAgain) {
  const CaptureFile file("again.y4m");
  const auto display = makeOffscreenDisplay(Capture::parse(file.path()), kStill);
  std::string first;
  for (int round = 0; round < 2; ++round) {
    OPEN_OR_SKIP(*display, {2, 2});
    ASSERT_TRUE(display->beginFrame());
    fill(1, 1, 1);
    ASSERT_TRUE(display->present());
    display->close();
    if (round == 0) first = file.content();
  }
  EXPECT_EQ(file.content(), first);
}

// As by two players at once.
TEST(OffscreenDisplay, CaptureThatIsBeingWrittenIsLeftToItsWriter) {
  const CaptureFile file("one.y4m");
  const auto first = makeOffscreenDisplay(Capture::parse(file.path()), kStill);
  OPEN_OR_SKIP(*first, {2, 2});
  ASSERT_TRUE(first->beginFrame());
  fill(1, 1, 1);
  ASSERT_TRUE(first->present());
  const auto second = makeOffscreenDisplay(Capture::parse(file.path()), kStill);
  const auto opened = second->open({4, 4});
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Io);
  EXPECT_NE(std::string_view(opened.error().message).find("another program writes this file"), std::string_view::npos);
  first->close();
  EXPECT_TRUE(file.content().starts_with("YUV4MPEG2 W2 H2 "));
  EXPECT_TRUE(second->open({4, 4}));
}

TEST(OffscreenDisplay, RateIsTheNumberBehindTheLastAt) {
  const CaptureFile with_rate("me@home.y4m");
  const auto display = makeOffscreenDisplay(Capture::parse(with_rate.path() + "@29.97"), kStill);
  OPEN_OR_SKIP(*display, {2, 2});
  display->close();
  EXPECT_EQ(with_rate.content().substr(0, 28), "YUV4MPEG2 W2 H2 F29970:1000 ");

  const CaptureFile without("take@2b.y4m");
  const auto other = makeOffscreenDisplay(Capture::parse(without.path()), kStill);
  OPEN_OR_SKIP(*other, {2, 2});
  other->close();
  EXPECT_EQ(without.content().substr(0, 28), "YUV4MPEG2 W2 H2 F30000:1000 ");
}

TEST(OffscreenDisplay, CaptureThatCannotBeWrittenSaysWhyAndLeavesItClosed) {
  const auto display = makeOffscreenDisplay(Capture::parse("/no/such/folder/film.y4m"), kStill);
  const auto opened = display->open({16, 16});
  ASSERT_FALSE(opened);
  if (opened.error().code == ErrorCode::Unsupported) GTEST_SKIP() << opened.error().message;
  EXPECT_EQ(opened.error().code, ErrorCode::Io) << "the error is reported at once";
  EXPECT_NE(opened.error().os_error, 0);
  EXPECT_EQ(display->state(), Display::State::Closed);
}

TEST(OffscreenDisplay, FullDiskIsTold) {
  const auto display = makeOffscreenDisplay(Capture::parse("/dev/full"), kStill);
  OPEN_OR_SKIP(*display, {64, 64});
  ASSERT_TRUE(display->beginFrame());
  const auto presented = display->present();
  ASSERT_FALSE(presented);
  EXPECT_EQ(presented.error().code, ErrorCode::Io);
}

TEST(OffscreenDisplay, SizeThatGlCannotDrawIsRefused) {
  const auto display = makeOffscreenDisplay({}, kStill);
  OPEN_OR_SKIP(*display, {1, 1});
  ASSERT_TRUE(display->beginFrame());
  display->close();
  for (const DisplayConfig& config : {DisplayConfig{0, 16}, DisplayConfig{16, 16385}}) {
    const auto opened = display->open(config);
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().code, ErrorCode::InvalidArgument);
  }
  ASSERT_TRUE(display->open({16, 16}));
}

}  // namespace
}  // namespace relievo
