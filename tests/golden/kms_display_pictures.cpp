// SPDX-License-Identifier: Apache-2.0
// The full-screen display in a guest with two screens: what it shows is what was drawn, also from dma-bufs.
#include <GLES3/gl3.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <vector>

#include "app/render/gl/scene_renderer.h"
#include "drivers/egl/egl.h"
#include "tests/golden/kms_display.h"
#include "tests/golden/picture_stage.h"
#include "tests/support/film/depth_frames.h"
#include "tests/support/machine/guest_screen.h"

namespace relievo::test {
namespace {

using namespace std::chrono_literals;

TEST_F(KmsDisplay, OnTheScreenIsWhatWasDrawnLast) {
  open({1280, 800});
  for (const auto& [left, right] : {std::pair{kRed, kBlue}, {kGreen, kRed}, {kBlue, kGreen}}) {
    show(left, right);
    const auto expected = [](const std::array<float, 3>& c) {
      return Rgb{int(255 * c[0]), int(255 * c[1]), int(255 * c[2])};
    };
    ASSERT_TRUE(untilShows(1280, 800, 639, 400, expected(left)));
    const ScreenDump dump = screen_->dump();
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
  const Scene scene{
      .color = makeRgbFrame(160, 100, [](int x, int y) { return Rgb{x, 2 * y, (x / 8 + y / 8) % 2 * 255}; }),
      .depth = makeGrayFrame(
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
  const Image expected = stage.show(scene);

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
  untilDump([&](const ScreenDump& dump) {
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

}  // namespace
}  // namespace relievo::test
