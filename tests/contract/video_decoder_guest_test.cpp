// SPDX-License-Identifier: Apache-2.0
// The kernel's virtual codec, vicodec, in a virtual machine: real queues, real events, real dma-bufs. Its packets are
// FWHT; the expected pictures are those that another program, v4l2-ctl, gets from it.
#include <gtest/gtest.h>
#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <deque>
#include <fstream>
#include <iterator>
#include <optional>

#include "drivers/v4l2/v4l2.h"
#include "tests/support/film/clip_maker.h"

namespace relievo {
namespace {

constexpr int kFrames = 12, kFewFrames = 3, kKeyInterval = 10;  // the last is the encoder's own
constexpr Duration kPeriod = std::chrono::milliseconds(40);

std::string readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The node of a card whose list of formats for its packets, or pictures, begins with this one.
std::optional<std::string> findNode(const std::string& format) {
  for (int i = 0; i < 16; ++i) {
    const std::string node = "/dev/video" + std::to_string(i);
    const std::string ask = "v4l2-ctl -d " + node + " -D 2>/dev/null | grep -q vicodec && v4l2-ctl -d " + node +
                            " --list-formats-out 2>/dev/null | grep -q \"0]: '" + format + "'\"";
    if (std::system(ask.c_str()) == 0) return node;
  }
  return std::nullopt;
}

// A film of FWHT packets, and the pictures that another program decodes from them: YU12, one after the other.
struct Film {
  int width, height;
  std::string coded, pictures;
  std::vector<std::size_t> begins;  // of the packets, and the end

  [[nodiscard]] std::string picture(int number) const {
    const std::size_t bytes = static_cast<std::size_t>(width * height) * 3 / 2;
    return pictures.substr(bytes * static_cast<std::size_t>(number), bytes);
  }
  [[nodiscard]] Packet packet(int number, MediaTime pts) const {
    const std::size_t begin = begins[static_cast<std::size_t>(number)];
    return {.data = reinterpret_cast<const std::uint8_t*>(coded.data()) + begin,
            .bytes = begins[static_cast<std::size_t>(number) + 1] - begin,
            .pts = pts,
            .keyframe = number % kKeyInterval == 0,
            .owner = std::make_shared<int>(0)};
  }
};

std::string samplesOf(const Frame& frame) {
  std::string samples;
  for (int i = 0; i < 3; ++i) {
    const int shift = i > 0 ? 1 : 0;
    for (int r = 0; r < frame.height >> shift; ++r) {
      for (int c = 0; c < frame.width >> shift; ++c) samples += static_cast<char>(test::sampleAt(frame, i, c, r));
    }
  }
  return samples;
}

class VideoDecoderGuest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto encoder = findNode("YU12"), decoder = findNode("FWHT");
    if (!encoder || !decoder) return;
    small_ = makeFilm(*encoder, *decoder, 640, 368, kFrames);
    large_ = makeFilm(*encoder, *decoder, 800, 400, kFewFrames);
  }
  void SetUp() override {
    if (!small_) GTEST_SKIP() << "no vicodec here; run it by toolchain/guest";
    ASSERT_EQ(small_->begins.size(), static_cast<std::size_t>(kFrames) + 1);
    ASSERT_EQ(large_->begins.size(), static_cast<std::size_t>(kFewFrames) + 1);
    ASSERT_FALSE(small_->picture(kFrames - 1).empty());
  }
  static Film makeFilm(const std::string& encoder, const std::string& decoder, int width, int height, int frames) {
    const test::TemporaryFolder folder;
    std::ofstream raw(folder / "raw", std::ios::binary);
    for (int n = 0; n < frames; ++n) {
      for (int r = 0; r < height * 3 / 2; ++r) {
        std::string row(static_cast<std::size_t>(width), static_cast<char>(40 + (r / 3 + 9 * n) % 160));
        row[static_cast<std::size_t>((r + 30 * n) % width)] = static_cast<char>(200);
        raw << row;
      }
    }
    raw.close();
    const std::string size = "width=" + std::to_string(width) + ",height=" + std::to_string(height);
    const auto run = [&](const std::string& node, const std::string& format, const char* from, const char* to) {
      const std::string line = "v4l2-ctl -d " + node + " --set-fmt-video-out=" + size + ",pixelformat=" + format +
                               " --stream-mmap --stream-out-mmap --stream-from=" + (folder / from) +
                               " --stream-to=" + (folder / to) + " >/dev/null 2>&1";
      EXPECT_EQ(std::system(line.c_str()), 0) << line;
    };
    run(encoder, "YU12", "raw", "coded");
    run(decoder, "FWHT", "coded", "pictures");
    Film film{width, height, readFile(folder / "coded"), readFile(folder / "pictures"), {}};
    // A header of 44 bytes (codec-fwht.h), the last four the number of those that follow.
    for (std::size_t at = 0; at + 44 <= film.coded.size();) {
      film.begins.push_back(at);
      std::uint32_t bytes = 0;
      for (std::size_t i = 40; i < 44; ++i) bytes = bytes << 8 | static_cast<std::uint8_t>(film.coded[at + i]);
      at += 44 + bytes;
      if (at == film.coded.size()) film.begins.push_back(at);
    }
    return film;
  }
  static std::unique_ptr<VideoDecoder> open() {
    auto decoder = makeV4l2M2mDecoder();
    StreamInfo stream;
    stream.kind = StreamKind::Video;
    stream.codec = "fwht";
    stream.width = small_->width;
    stream.height = small_->height;
    stream.frame_period = kPeriod;
    const auto opened = decoder->open(stream);
    EXPECT_TRUE(opened) << opened.error().message;
    return decoder;
  }
  // Feeds packets [from, to) of a film, and compares every picture with the expected one.
  struct Due {
    const Film* film;
    int number;
    MediaTime pts;
  };
  void feed(VideoDecoder& decoder, const Film& film, int from, int to) {
    for (int n = from; n < to; ++n) {
      receive(decoder);
      ASSERT_EQ(decoder.feed(film.packet(n, next_)).value(), Feed::Accepted);
      due_.push_back({&film, n, next_});
      next_ += kPeriod;
    }
    receive(decoder);
  }
  void drain(VideoDecoder& decoder) {
    ASSERT_TRUE(decoder.drain());
    receive(decoder);
    EXPECT_EQ(decoder.state(), VideoDecoder::State::Ended);
    EXPECT_TRUE(due_.empty()) << due_.size() << " have not come";
  }
  void receive(VideoDecoder& decoder) {
    for (;;) {
      const auto frame = decoder.receive();
      ASSERT_TRUE(frame) << frame.error().message;
      if (!*frame) return;
      ASSERT_FALSE(due_.empty());
      const Due due = due_.front();
      due_.pop_front();
      EXPECT_EQ((*frame)->pts, due.pts);
      ASSERT_EQ((*frame)->width, due.film->width);
      ASSERT_EQ((*frame)->height, due.film->height);
      EXPECT_TRUE(samplesOf(**frame) == due.film->picture(due.number)) << "picture " << due.number;
      last_ = **frame;
    }
  }

  static inline std::optional<Film> small_, large_;
  std::deque<Due> due_;
  MediaTime next_;
  Frame last_;
};

TEST_F(VideoDecoderGuest, PicturesAreThoseOfAnotherProgramToTheBit) {
  const auto decoder = open();
  feed(*decoder, *small_, 0, kFrames);
  drain(*decoder);
  EXPECT_EQ(decoder->damaged(), 0u);
  EXPECT_EQ(decoder->description().substr(0, 28), "v4l2-m2m, vicodec at /dev/vi");
}

TEST_F(VideoDecoderGuest, SeeksAndDrainsAgainAndAgain) {
  const auto decoder = open();
  for (const int fed : {kFrames, 3, 1, 7}) {
    feed(*decoder, *small_, 0, fed);
    if (fed % 2 == 1) drain(*decoder);
    ASSERT_TRUE(decoder->flush());
    due_.clear();
    feed(*decoder, *small_, kKeyInterval, kFrames);
    drain(*decoder);
    ASSERT_TRUE(decoder->flush());
  }
}

TEST_F(VideoDecoderGuest, TheResolutionChangesInMidStreamWhilePicturesAreHeld) {
  const auto decoder = open();
  feed(*decoder, *small_, 0, kFrames);
  const Frame held = last_;
  const std::string samples = samplesOf(held);
  feed(*decoder, *large_, 0, kFewFrames);
  feed(*decoder, *small_, 0, kFrames);
  drain(*decoder);
  EXPECT_TRUE(samplesOf(held) == samples);
}

TEST_F(VideoDecoderGuest, ItsDmaBufHoldsThePicture) {
  const auto decoder = open();
  feed(*decoder, *small_, 0, 4);
  drain(*decoder);
  const DmaBuf where = last_.dma_bufs[0];
  ASSERT_GE(where.fd, 0);
  const std::size_t bytes =
      static_cast<std::size_t>(last_.planes[0].stride_bytes) * static_cast<std::size_t>(last_.height);
  void* const memory = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, where.fd, 0);
  ASSERT_NE(memory, MAP_FAILED);
  EXPECT_EQ(std::memcmp(static_cast<const std::uint8_t*>(memory) + where.offset_bytes, last_.planes[0].data, bytes), 0);
  ::munmap(memory, bytes);
}

}  // namespace
}  // namespace relievo
