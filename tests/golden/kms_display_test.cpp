// SPDX-License-Identifier: Apache-2.0
// The full-screen display, in a guest with two screens: QEMU's, which can be captured, and one that refreshes in
// virtual time like a real screen.
#include <GLES3/gl3.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <vector>

#include "app/render/gl/scene_renderer.h"
#include "drivers/egl/egl.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/machine/guest_screen.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::Rgb;

void fill(int x, int y, int width, int height, float red, float green, float blue) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, width, height);
  glClearColor(red, green, blue, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

class KmsDisplay : public testing::Test {
 protected:
  explicit KmsDisplay(const char* driver = "virtio") : screen_(test::GuestScreen::find(driver)) {}
  void SetUp() override {
    if (screen_ == nullptr) GTEST_SKIP() << test::kNoGuest;
    display_ = makeKmsDisplay(screen_->card());
  }
  void open(const DisplayConfig& config) {
    const auto opened = display_->open(config);
    ASSERT_TRUE(opened) << opened.error().message << " " << opened.error().os_error;
  }
  // The left half in one colour, the right half in another.
  void show(const std::array<float, 3>& left, const std::array<float, 3>& right) {
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    const int half = surface->width / 2;
    fill(0, 0, half, surface->height, left[0], left[1], left[2]);
    fill(half, 0, half, surface->height, right[0], right[1], right[2]);
    const auto shown = display_->present();
    ASSERT_TRUE(shown) << shown.error().message << " " << shown.error().os_error;
    EXPECT_LE(*shown, display_->capabilities().refresh_period);
  }
  // QEMU updates its picture in host time, which the guest cannot observe.
  bool untilDump(const std::function<bool(const test::ScreenDump&)>& so) {
    MonotonicClock clock;
    for (int tries = 0; tries < 30; ++tries) {
      if (so(screen_->dump())) return true;
      clock.sleepUntil(clock.now() + 50ms);
    }
    return false;
  }
  bool untilShows(int width, int height, int x, int y, const Rgb& color) {
    return untilDump([&](const test::ScreenDump& dump) {
      return dump.width == width && dump.height == height && dump.at(x, y) == color;
    });
  }
  ErrorCode attendUntilRefused() {
    MonotonicClock clock;
    for (int i = 0; i < 300; ++i) {
      if (const auto attended = display_->attend(); !attended) return attended.error().code;
      clock.sleepUntil(clock.now() + 10ms);
    }
    ADD_FAILURE() << "the loss was not noticed";
    return ErrorCode::InvalidState;
  }

  std::unique_ptr<test::GuestScreen> screen_;
  std::unique_ptr<Display> display_;
};

class PacedKmsDisplay : public KmsDisplay {
 protected:
  PacedKmsDisplay() : KmsDisplay("vkms") {}
};

constexpr std::array<float, 3> kRed{1, 0, 0}, kGreen{0, 1, 0}, kBlue{0, 0, 1};

TEST_F(KmsDisplay, OnTheScreenIsWhatWasDrawnLast) {
  open({1280, 800});
  for (const auto& [left, right] : {std::pair{kRed, kBlue}, {kGreen, kRed}, {kBlue, kGreen}}) {
    show(left, right);
    const auto expected = [](const std::array<float, 3>& c) {
      return Rgb{int(255 * c[0]), int(255 * c[1]), int(255 * c[2])};
    };
    ASSERT_TRUE(untilShows(1280, 800, 639, 400, expected(left)));
    const test::ScreenDump dump = screen_->dump();
    for (const int y : {0, 400, 799}) {
      EXPECT_EQ(dump.at(0, y), expected(left));
      EXPECT_EQ(dump.at(639, y), expected(left));
      EXPECT_EQ(dump.at(640, y), expected(right));
      EXPECT_EQ(dump.at(1279, y), expected(right));
    }
  }
}

// Compares the renderer's output on the screen with that off screen, which the golden tests check.
TEST_F(KmsDisplay, TheReliefOnTheScreenIsThatOfTheOffscreenDisplay) {
  const test::Scene scene{
      .color = test::makeRgbFrame(160, 100, [](int x, int y) { return Rgb{x, 2 * y, (x / 8 + y / 8) % 2 * 255}; }),
      .depth = test::makeGrayFrame(
          160, 100, 8, MediaTime{},
          [](int x, int y) { return static_cast<std::uint32_t>(128 + 100 * std::sin(0.05 * x) * std::cos(0.05 * y)); }),
      .volume = {160, 100, 40},
      .stereo = {.layout = StereoLayout::SideBySide},
      .finger = FingerMark{{10, 5, 30}, {0, 0, 2}, true}};
  // For an offscreen display Mesa opens the cards too and keeps them open, and whoever opens a card first becomes its
  // master.
  std::vector<UniqueFd> masters;
  for (const KmsScreen& each : lookAtKmsScreens()) masters.emplace_back(::open(each.card.c_str(), O_RDWR | O_CLOEXEC));
  STAGE_OR_SKIP(stage, 640, 480);
  masters.clear();
  const test::Image expected = stage.show(scene);

  open({640, 480});
  {
    auto renderer = SceneRenderer::create(1h).value();
    renderer->setStereo(scene.stereo);
    renderer->setError(scene.error_px);
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    ASSERT_TRUE(renderer->setFrame(scene.color, scene.depth, scene.calibration, scene.volume));
    ASSERT_TRUE(renderer->draw(*surface, {scene.finger}));
    ASSERT_TRUE(display_->present());
  }
  // GL draws a window upside down but not a framebuffer object: a pixel whose middle lies on an edge is drawn in only
  // one of the two.
  constexpr double kPixels = 640 * 480;
  double other = 0, sum = 0, light = 0;
  untilDump([&](const test::ScreenDump& dump) {
    other = sum = kPixels;
    light = 0;
    if (dump.width != 640 || dump.height != 480) return false;
    other = sum = 0;
    for (int y = 0; y < dump.height; ++y) {
      for (int x = 0; x < dump.width; ++x) {
        int difference = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          difference = std::max(difference, std::abs(dump.at(x, y)[c] - expected.at(x, y)[c]));
          light += expected.at(x, y)[c] / 3.0;
        }
        other += difference > 1 ? 1 : 0;
        sum += difference;
      }
    }
    return other < 0.001 * kPixels;
  });
  EXPECT_LT(other, 0.001 * kPixels);
  EXPECT_LT(sum, 0.01 * kPixels);
  EXPECT_GT(light, 30 * kPixels) << "the picture is not black";
}

// A picture in a buffer allocated by the card, as a hardware decoder makes it: NV12 with a pattern in luma and in
// chroma.
class CardPicture {
 public:
  CardPicture(const std::string& card, int width, int height)
      : card_(::open(card.c_str(), O_RDWR | O_CLOEXEC)), width_(width), height_(height) {
    (void)drmDropMaster(card_.get());  // whoever opens a card first becomes master, but here the display must be
    std::uint32_t pitch = 0;
    std::uint64_t size = 0, offset = 0;
    // Contiguous memory for both planes.
    if (drmModeCreateDumbBuffer(card_.get(), static_cast<std::uint32_t>(width / 4),
                                static_cast<std::uint32_t>(height * 3 / 2), 32, 0, &handle_, &pitch, &size) != 0 ||
        drmModeMapDumbBuffer(card_.get(), handle_, &offset) != 0) {
      return;
    }
    size_ = size;
    stride_ = pitch;
    int fd = -1;
    if (drmPrimeHandleToFD(card_.get(), handle_, DRM_CLOEXEC | DRM_RDWR, &fd) != 0) return;
    buffer_ = UniqueFd(fd);
    void* mapped = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, card_.get(), static_cast<off_t>(offset));
    if (mapped == MAP_FAILED) return;
    bytes_ = static_cast<std::uint8_t*>(mapped);
    for (int r = 0; r < height * 3 / 2; ++r) {
      for (int c = 0; c < width; ++c) {
        bytes_[r * stride_ + c] = static_cast<std::uint8_t>(r < height ? 40 + (c + 2 * r) % 180 : 90 + (c % 2) * 60);
      }
    }
  }
  ~CardPicture() {
    if (bytes_ != nullptr) ::munmap(bytes_, size_);
    buffer_ = UniqueFd();
    drmModeDestroyDumbBuffer(card_.get(), handle_);
  }
  CardPicture(const CardPicture&) = delete;
  CardPicture& operator=(const CardPicture&) = delete;

  [[nodiscard]] bool made() const { return bytes_ != nullptr; }
  [[nodiscard]] Frame frame(bool with_dma_buf) const {
    Frame frame;
    frame.width = width_;
    frame.height = height_;
    frame.model = ColorModel::Yuv;
    frame.chroma_shift_x = frame.chroma_shift_y = 1;
    frame.plane_count = 2;
    frame.components = {Component{}, {.plane = 1, .step_bytes = 2}, {.plane = 1, .offset_bytes = 1, .step_bytes = 2}};
    const auto chroma = static_cast<std::uint32_t>(stride_ * height_);
    frame.planes[0] = {bytes_, stride_};
    frame.planes[1] = {bytes_ + chroma, stride_};
    if (with_dma_buf) {
      frame.dma_bufs[0] = {buffer_.get(), 0};
      frame.dma_bufs[1] = {buffer_.get(), chroma};
      frame.dma_modifier = 0;  // linear
    }
    return frame;
  }

 private:
  UniqueFd card_, buffer_;
  int width_ = 0, height_ = 0;
  std::uint32_t handle_ = 0;
  std::size_t size_ = 0;
  std::ptrdiff_t stride_ = 0;
  std::uint8_t* bytes_ = nullptr;
};

// Drawing from dma-bufs gives the same picture as an upload.
void expectTheSameFromDmaBufs(Display& display, const std::string& card) {
  const CardPicture picture(card, 256, 160);
  ASSERT_TRUE(picture.made()) << errno;
  ASSERT_TRUE(display.open({640, 480}));
  std::array<std::vector<std::uint8_t>, 2> drawn;
  bool imported = false;
  for (const bool with_dma_buf : {false, true}) {
    const auto surface = display.beginFrame();
    ASSERT_TRUE(surface);
    {
      auto renderer = SceneRenderer::create(1h).value();
      ASSERT_TRUE(renderer->setFrame(picture.frame(with_dma_buf), {}, {}, {160, 100, 40}));
      ASSERT_TRUE(renderer->draw(*surface, {}));
      imported = renderer->statistics().imported;
      auto& pixels = drawn[with_dma_buf ? 1 : 0];
      pixels.resize(std::size_t{640} * 480 * 4);
      glReadPixels(0, 0, 640, 480, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    }
    ASSERT_TRUE(display.present());
  }
  EXPECT_TRUE(imported) << "Mesa takes the dma-bufs of both cards";
  EXPECT_GT(*std::max_element(drawn[0].begin(), drawn[0].end() - 4), 100);
  int furthest = 0;
  for (std::size_t i = 0; i < drawn[0].size(); ++i) furthest = std::max(furthest, std::abs(drawn[0][i] - drawn[1][i]));
  EXPECT_LE(furthest, 2) << "of 255: an upload is made RGB by the CPU, a dma-buf by the GPU";
}

TEST_F(KmsDisplay, APictureInADmaBufIsShownAsItIs) {
  expectTheSameFromDmaBufs(*display_, screen_->card());
}

TEST_F(PacedKmsDisplay, APictureInADmaBufIsShownAsItIs) {
  expectTheSameFromDmaBufs(*display_, screen_->card());
}

TEST_F(KmsDisplay, TheModeIsTheOneAskedForElseTheScreensFavourite) {
  const struct {
    DisplayConfig wish;
    int width, height;
  } cases[] = {{{800, 600}, 800, 600}, {{1024, 768}, 1024, 768}, {{1234, 567}, 1280, 800}};
  for (const auto& [wish, width, height] : cases) {
    open(wish);
    const auto surface = display_->beginFrame();
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->width, width);
    EXPECT_EQ(surface->height, height);
    EXPECT_EQ(surface->stereo, StereoSignal::None);
    EXPECT_EQ(surface->eye_gap_rows, 0);
    fill(0, 0, width, height, 1, 1, 0);
    ASSERT_TRUE(display_->present());
    EXPECT_TRUE(untilShows(width, height, width - 1, height - 1, {255, 255, 0})) << width;
    display_->close();
  }
}

TEST_F(KmsDisplay, WhatWasOnTheScreenBeforeIsGivenBack) {
  const auto now = [&] {
    const UniqueFd card(::open(screen_->card().c_str(), O_RDWR | O_CLOEXEC));
    drmModeRes* all = drmModeGetResources(card.get());
    drmModeCrtc* crtc = drmModeGetCrtc(card.get(), all->crtcs[0]);
    const std::array<std::uint32_t, 3> state{crtc->buffer_id, crtc->mode.hdisplay, crtc->mode.vdisplay};
    drmModeFreeCrtc(crtc);
    drmModeFreeResources(all);
    return state;
  };
  const auto before = now();
  ASSERT_NE(before[0], 0u) << "the kernel's console is on it";
  open({640, 480});
  EXPECT_EQ(now(), before) << "until there is a picture";
  show(kRed, kRed);
  EXPECT_NE(now(), before);
  show(kRed, kRed);
  display_->close();
  EXPECT_EQ(now(), before);
  EXPECT_TRUE(untilDump([&](const test::ScreenDump& dump) { return dump.width == static_cast<int>(before[1]); }));
}

TEST_F(KmsDisplay, PulledOutItIsLostAndPutInItOpensAgain) {
  open({1280, 800});
  show(kRed, kBlue);
  ASSERT_TRUE(display_->attend());
  screen_->plug(false);
  EXPECT_EQ(attendUntilRefused(), ErrorCode::Lost);
  display_->close();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(display_->open({1280, 800}).error().code, ErrorCode::NotFound);
  screen_->plug(true);
  open({1280, 800});
  show(kGreen, kBlue);
  EXPECT_TRUE(untilShows(1280, 800, 10, 10, {0, 255, 0}));
}

TEST_F(KmsDisplay, TheFirstCardThatHasAScreenIsTaken) {
  const auto other = test::GuestScreen::find("vkms");
  ASSERT_NE(other, nullptr);
  const auto any = makeKmsDisplay();
  screen_->plug(false);
  other->plug(false);
  EXPECT_EQ(any->open({}).error().code, ErrorCode::NotFound);
  screen_->plug(true);
  ASSERT_TRUE(any->open({1280, 800}));
  const auto surface = any->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->width, 1280);
  fill(0, 0, 1280, 800, 1, 0, 1);
  ASSERT_TRUE(any->present());
  EXPECT_TRUE(untilShows(1280, 800, 10, 10, {255, 0, 255}));
}

TEST_F(KmsDisplay, ACardThatAnotherProgramShowsOnIsRefused) {
  const UniqueFd other(::open(screen_->card().c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_EQ(drmSetMaster(other.get()), 0);
  EXPECT_EQ(display_->open({}).error().code, ErrorCode::PermissionDenied);
  EXPECT_THAT(lookAtKmsScreens().at(0).state, testing::HasSubstr("another program uses this card's screens"));
  ASSERT_EQ(drmDropMaster(other.get()), 0);
  open({});
  EXPECT_NE(drmSetMaster(other.get()), 0);
  display_->close();
  EXPECT_EQ(drmSetMaster(other.get()), 0) << "it lets go";
}

TEST_F(KmsDisplay, WithoutThatCardItSaysSo) {
  const auto opened = makeKmsDisplay("/dev/dri/card9")->open({});
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
  EXPECT_EQ(makeKmsDisplay("/dev/null")->open({}).error().code, ErrorCode::Unsupported);
}

TEST_F(KmsDisplay, IsListedWithItsModesAndWhatItTakes) {
  const auto screens = lookAtKmsScreens();
  ASSERT_GE(screens.size(), 2u);
  EXPECT_EQ(screens[0].card, screen_->card());
  EXPECT_TRUE(screens[0].there);
  EXPECT_THAT(screens[0].state, testing::MatchesRegex("Virtual-1: 1280x800 at [67][0-9][.][0-9]+ Hz, [0-9]+ modes; "
                                                      "no 3D signals"));
  screen_->plug(false);
  EXPECT_THAT(lookAtKmsScreens()[0].state, testing::StartsWith("Virtual-1: no screen is connected"));
}

// Frames are shown in consecutive refreshes. The kernel's events are in virtual time and do not depend on the load of
// this machine.
TEST_F(PacedKmsDisplay, FramesAreShownWithTheRefresh) {
  open({640, 480});
  const Duration period = display_->capabilities().refresh_period;
  EXPECT_NEAR(toSeconds(period), 1 / 59.94, 1e-4);
  MonotonicClock clock;
  MonotonicTime last;
  int next_refresh = 0;
  constexpr int kFrames = 30;
  for (int i = 0; i < kFrames; ++i) {
    ASSERT_TRUE(display_->beginFrame());
    const auto shown = display_->present();
    ASSERT_TRUE(shown) << shown.error().message;
    const MonotonicTime now = clock.now();
    EXPECT_GE(*shown, Duration(0));
    EXPECT_LE(*shown, period);
    const MonotonicTime on_screen = now + *shown;  // a refresh
    if (i > 2) {
      const double periods = toSeconds(on_screen - last) / toSeconds(period);
      EXPECT_NEAR(periods, std::round(periods), 0.1) << "frame " << i;
      EXPECT_GT(periods, 0.5) << "two frames in one refresh";
      next_refresh += std::lround(periods) == 1 ? 1 : 0;
    }
    last = on_screen;
  }
  EXPECT_GT(next_refresh, kFrames / 2) << "it keeps up with the screen";
}

TEST_F(PacedKmsDisplay, OpensAgainTenTimes) {
  for (int round = 0; round < 10; ++round) {
    open({640, 480});
    show(kRed, kBlue);
    show(kBlue, kRed);
    display_->close();
  }
}

TEST_F(PacedKmsDisplay, ClosedInTheMiddleOfAFlipItLeavesNothingBehind) {
  for (int round = 0; round < 5; ++round) {
    open({640, 480});
    for (int i = 0; i < 3; ++i) show(kRed, kBlue);
    ASSERT_TRUE(display_->beginFrame());
    display_->close();
  }
}

// The guest's vkms is a television of 1280 x 1470: two pictures of 720 rows with 30 between them.
TEST_F(PacedKmsDisplay, FramePackingIsSentToAScreenThatTakesIt) {
  open({1280, 720, StereoSignal::FramePacking});
  EXPECT_TRUE(display_->capabilities().stereo.frame_packing);
  const auto surface = display_->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->stereo, StereoSignal::FramePacking);
  EXPECT_EQ(surface->width, 1280);
  EXPECT_EQ(surface->height, 1470);
  EXPECT_EQ(surface->eye_gap_rows, 30);
  const auto shown = display_->present();
  ASSERT_TRUE(shown) << shown.error().message << " " << shown.error().os_error;
  show(kRed, kBlue);
  show(kBlue, kRed);

  const UniqueFd card(::open(screen_->card().c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_EQ(drmSetClientCap(card.get(), DRM_CLIENT_CAP_STEREO_3D, 1), 0);
  drmModeRes* all = drmModeGetResources(card.get());
  drmModeCrtc* crtc = drmModeGetCrtc(card.get(), all->crtcs[0]);
  EXPECT_EQ(crtc->mode.vdisplay, 720);
  EXPECT_EQ(crtc->mode.flags & DRM_MODE_FLAG_3D_MASK, unsigned{DRM_MODE_FLAG_3D_FRAME_PACKING});
  drmModeFreeCrtc(crtc);
  drmModeFreeResources(all);
  EXPECT_THAT(lookAtKmsScreens().back().state, testing::HasSubstr("another program"));
  display_->close();
  EXPECT_THAT(lookAtKmsScreens().back().state, testing::HasSubstr("3D signals: frame packing"));
}

TEST_F(PacedKmsDisplay, SideBySideThatTheScreenIsNotToldOfIsShownAllTheSame) {
  open({640, 480, StereoSignal::SideBySideHalf});
  const auto surface = display_->beginFrame();
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->stereo, StereoSignal::None);
  EXPECT_EQ(surface->width, 640);
}

TEST_F(KmsDisplay, FramePackingThatTheScreenDoesNotTakeIsRefused) {
  const auto opened = display_->open({1920, 1080, StereoSignal::FramePacking});
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("does not support frame packing"));
}

}  // namespace
}  // namespace relievo
