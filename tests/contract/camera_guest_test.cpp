// SPDX-License-Identifier: Apache-2.0
// The kernel's virtual camera, vivid, in a virtual machine: real buffers, real dma-bufs, a real disconnection.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/dma-buf.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <cstring>
#include <optional>
#include <string>

#include "drivers/v4l2/v4l2.h"
#include "platform/unique_fd.h"

namespace relievo {
namespace {

constexpr std::uint32_t kDisconnect = 0x00f0f000 + 65;  // a button: VIVID_CID_DISCONNECT

std::optional<std::string> findVivid() {
  for (int i = 0; i < 16; ++i) {
    const std::string node = "/dev/video" + std::to_string(i);
    const UniqueFd fd(::open(node.c_str(), O_RDWR | O_CLOEXEC));
    v4l2_capability is{};
    if (!fd.valid() || ::ioctl(fd.get(), VIDIOC_QUERYCAP, &is) != 0) continue;
    const bool camera = (is.device_caps & V4L2_CAP_VIDEO_CAPTURE) != 0;
    if (camera && std::strcmp(reinterpret_cast<const char*>(is.driver), "vivid") == 0) return node;
  }
  return std::nullopt;
}

class CameraGuest : public testing::Test {
 protected:
  void SetUp() override {
    const auto found = findVivid();
    if (!found) GTEST_SKIP() << "no vivid here; run it by toolchain/guest";
    node_ = *found;
  }
  [[nodiscard]] std::unique_ptr<MediaSource> open(const std::string& options) const {
    auto source = makeV4l2Source();
    const auto opened = source->open("v4l2:" + node_ + options);
    EXPECT_TRUE(opened) << opened.error().message;
    return source;
  }
  static Result<std::optional<Frame>> next(MediaSource& source, VideoDecoder& decoder, int stream) {
    for (;;) {
      auto packet = source.read();
      if (!packet) return std::unexpected(packet.error());
      if ((*packet)->stream != stream) continue;
      EXPECT_TRUE(decoder.feed(**packet));
      return decoder.receive();
    }
  }
  std::string node_;
};

TEST_F(CameraGuest, EveryFormatComesWithTimesThatGrowAndNothingIsLost) {
  for (const char* format : {",Y16", ",Y12", ",Y10", ",YUYV", ",NV12"}) {
    SCOPED_TRACE(format);
    const auto source = open(std::string(format) + ",320x180@30");
    const StreamInfo& stream = source->streams().back();
    const auto decoder = makeV4l2RawDecoder();
    ASSERT_TRUE(decoder->open(stream));
    MediaTime last{Duration(-1)};
    for (int i = 0; i < 20; ++i) {
      const auto frame = next(*source, *decoder, stream.index);
      ASSERT_TRUE(frame && *frame);
      EXPECT_EQ((*frame)->width, 320);
      EXPECT_GT((*frame)->pts, last);
      last = (*frame)->pts;
    }
    EXPECT_EQ(source->missedPictures(), 0u);
  }
}

TEST_F(CameraGuest, ItsMemoryComesAsADmaBufOfTheSamePicture) {
  const auto source = open(",Y16,320x180@30");
  const StreamInfo& stream = source->streams()[1];
  const auto decoder = makeV4l2RawDecoder();
  ASSERT_TRUE(decoder->open(stream));
  const auto frame = next(*source, *decoder, stream.index);
  ASSERT_TRUE(frame && *frame);
  const DmaBuf& exported = (*frame)->dma_bufs[0];
  ASSERT_GE(exported.fd, 0);
  const std::size_t bytes = std::size_t{320} * 180 * 2;
  void* const other = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, exported.fd, 0);
  ASSERT_NE(other, MAP_FAILED);
  EXPECT_EQ(std::memcmp(other, (*frame)->planes[0].data, bytes), 0);
  ::munmap(other, bytes);
}

// Pictures from before are still held.
TEST_F(CameraGuest, IsOpenedAnewWhilePicturesAreHeld) {
  auto source = open(",Y16,320x180@30");
  const StreamInfo stream = source->streams()[1];
  const auto decoder = makeV4l2RawDecoder();
  ASSERT_TRUE(decoder->open(stream));
  const auto held = next(*source, *decoder, stream.index);
  ASSERT_TRUE(held && *held);
  source.reset();
  EXPECT_TRUE(open(",Y16,320x180@30")->read());
}

// Must be the last test: the camera stays unplugged.
TEST_F(CameraGuest, PulledOutItIsLost) {
  const auto source = open(",Y16,320x180@30");
  ASSERT_TRUE(source->read());
  {
    const UniqueFd fd(::open(node_.c_str(), O_RDWR | O_CLOEXEC));
    v4l2_control pull{kDisconnect, 1};
    ASSERT_EQ(::ioctl(fd.get(), VIDIOC_S_CTRL, &pull), 0);
  }
  Result<std::optional<Packet>> read = source->read();
  for (int i = 0; i < 100 && read; ++i) read = source->read();
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::Lost);
}

}  // namespace
}  // namespace relievo
