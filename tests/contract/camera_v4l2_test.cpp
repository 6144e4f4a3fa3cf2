// SPDX-License-Identifier: Apache-2.0
// Cameras that umockdev simulates as nodes of /dev: every picture is returned once, or is counted as lost.
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <optional>
#include <thread>
#include <vector>

#include "drivers/v4l2/v4l2.h"
#include "platform/clock.h"
#include "tests/contract/state_table.h"
#include "tests/support/device/mocked_machine.h"
#include "tests/support/device/umockdev_camera.h"

namespace relievo {
namespace {

using test::CameraKind;
using test::UmockdevCamera;
using State = MediaSource::State;
using Fault = UmockdevCamera::Fault;

constexpr const char* kUrl = "v4l2:/dev/video0";

CameraKind depthCamera() {
  return {.formats = {V4L2_PIX_FMT_Z16}};
}

std::unique_ptr<MediaSource> openCamera(const std::string& url = kUrl) {
  auto source = makeV4l2Source();
  const auto opened = source->open(url);
  EXPECT_TRUE(opened) << opened.error().message;
  return source;
}

// Reads and decodes the next picture of one track; nullopt after an error, which is then in `error`.
class Reader {
 public:
  explicit Reader(MediaSource& source, std::size_t stream)
      : source_(source), stream_(source.streams().at(stream)), decoder_(makeV4l2RawDecoder()) {
    EXPECT_TRUE(decoder_->open(stream_));
  }
  std::optional<Frame> next() {
    for (;;) {
      auto packet = source_.read();
      if (!packet) {
        error = packet.error();
        return std::nullopt;
      }
      if ((*packet)->stream != stream_.index) continue;
      EXPECT_EQ(decoder_->feed(**packet).value(), Feed::Accepted);
      packet->reset();
      return decoder_->receive().value();
    }
  }
  Error error;

 private:
  MediaSource& source_;
  StreamInfo stream_;
  std::unique_ptr<VideoDecoder> decoder_;
};

std::uint32_t sampleOf(const Frame& frame, std::size_t component, int c, int r) {
  const Component& where = frame.components[component];
  const std::uint8_t* const at = frame.planes[where.plane].data + r * frame.planes[where.plane].stride_bytes +
                                 where.offset_bytes + c * where.step_bytes;
  const std::uint32_t word = where.bits > 8 ? at[0] | static_cast<std::uint32_t>(at[1]) << 8 : at[0];
  return (word >> where.shift) & ((1U << where.bits) - 1);
}
std::uint32_t numberOf(const Frame& frame) {
  return sampleOf(frame, 0, 0, 0);
}

class CameraV4l2 : public test::MockedMachine {};

TEST_F(CameraV4l2, EveryVerbInEveryState) {
  UmockdevCamera camera(bed_, 0, depthCamera());
  const std::vector<test::Verb<MediaSource>> verbs = {
      {"open", [](MediaSource& s) { return test::answerOf(s.open(kUrl)); }},
      {"read", [](MediaSource& s) { return test::answerOf(s.read()); }},
      {"close", [](MediaSource& s) { return s.close(), test::Answer{}; }},
  };
  constexpr auto no = std::nullopt;
  const std::vector<test::Row<State>> table = {{State::Closed, {State::Open, no, State::Closed}},
                                               {State::Open, {no, State::Open, State::Closed}}};
  test::expectStateTable(verbs, table, [](State state) {
    auto source = makeV4l2Source();
    EXPECT_TRUE(state == State::Closed || source->open(kUrl));
    return source;
  });
  EXPECT_EQ(openCamera()->seek(MediaTime{}).error().code, ErrorCode::Unsupported);
  EXPECT_EQ(camera.unknownRequests(), 0);
}

TEST_F(CameraV4l2, ADepthCameraIsAFilmOfItsDepthAndOfAPictureOfIt) {
  CameraKind kind = depthCamera();
  kind.row_padding = 10;
  kind.sample = [](std::uint32_t, int c, int r) { return static_cast<std::uint16_t>(r == 0 ? 0 : 100 * r + c); };
  UmockdevCamera camera(bed_, 0, kind);
  const auto source = openCamera();
  EXPECT_TRUE(source->live());
  ASSERT_EQ(source->streams().size(), 2u);
  EXPECT_EQ(source->tags().at("TITLE"), "A camera that is not there");
  const StreamInfo& depth = source->streams()[1];
  EXPECT_TRUE(depth.auxiliary);
  EXPECT_EQ(depth.codec, "z16");
  EXPECT_EQ(depth.tags.at("DEPTH_UNIT"), "1");
  EXPECT_EQ(depth.tags.at("DEPTH_INVALID"), "0");
  EXPECT_NEAR(toSeconds(depth.frame_period), 1.0 / 30, 1e-6);

  const Frame exact = Reader(*source, 1).next().value();
  EXPECT_EQ(exact.planes[0].stride_bytes, 2 * 64 + 10);
  for (int r = 0; r < 48; ++r) ASSERT_EQ(sampleOf(exact, 0, 63, r), r == 0 ? 0U : 100U * r + 63) << r;
  const Frame shown = Reader(*source, 0).next().value();
  EXPECT_EQ(shown.components[0].bits, 8);
  EXPECT_EQ(sampleOf(shown, 0, 5, 0), 0u) << "no value is black";
  EXPECT_EQ(sampleOf(shown, 0, 0, 30), 0u) << "far, 3000 mm, as well";
  EXPECT_EQ(sampleOf(shown, 0, 0, 15), 127u) << "1500 mm: 255 / 2";
  EXPECT_GT(sampleOf(shown, 0, 0, 1), sampleOf(shown, 0, 0, 15)) << "near is bright";
}

// Each fault removes one picture: returned and lost pictures together are all that the camera took.
TEST_F(CameraV4l2, EveryPictureComesOnceInOrderOrIsCountedAsLost) {
  UmockdevCamera camera(bed_, 0, depthCamera());
  for (const std::uint32_t number : {10u, 20u, 21u, 22u, 90u}) camera.fault(number, Fault::Dropped);
  camera.fault(30, Fault::Damaged);
  camera.fault(40, Fault::Short);
  camera.fault(50, Fault::BackInTime);
  const auto source = openCamera();
  Reader depth(*source, 1);
  std::vector<std::uint32_t> came;
  MediaTime last{Duration(-1)};
  for (int i = 0; i < 200; ++i) {
    const auto frame = depth.next();
    ASSERT_TRUE(frame) << depth.error.message;
    came.push_back(numberOf(*frame));
    EXPECT_GT(frame->pts, last);
    last = frame->pts;
    EXPECT_NEAR(toSeconds(frame->pts), came.back() / 30.0, 1e-4) << "the driver's own time";
  }
  std::vector<std::uint32_t> expected;
  for (std::uint32_t number = 0; expected.size() < 200; ++number) {
    const bool lost =
        number == 10 || (number >= 20 && number <= 22) || number == 30 || number == 40 || number == 50 || number == 90;
    if (!lost) expected.push_back(number);
  }
  EXPECT_EQ(came, expected);
  EXPECT_EQ(source->missedPictures(), 8u);
  EXPECT_EQ(came.size() + source->missedPictures(), camera.taken());
}

// At a real camera's rate, with more pictures held than it has buffers.
TEST_F(CameraV4l2, AtItsOwnPaceNothingIsLostUnseen) {
  constexpr int kPictures = 60;
  CameraKind kind = depthCamera();
  kind.paced = true;
  UmockdevCamera camera(bed_, 0, kind);
  const auto source = openCamera();
  Reader depth(*source, 1);
  std::vector<Frame> held;
  std::uint32_t last = 0;
  for (int i = 0; i < kPictures; ++i) {
    auto frame = depth.next();
    ASSERT_TRUE(frame) << depth.error.message;
    last = numberOf(*frame);
    held.push_back(std::move(*frame));
    if (held.size() > 24) held.erase(held.begin());
  }
  EXPECT_EQ(source->missedPictures(), last + 1 - kPictures) << "what is not there was counted";
  EXPECT_EQ(source->missedPictures(), camera.starved()) << "and nothing else was";
}

TEST_F(CameraV4l2, HeldPicturesStayAsTheyAreAndDoNotStopTheCamera) {
  UmockdevCamera camera(bed_, 0, depthCamera());
  auto source = openCamera();
  std::vector<Frame> held;
  {
    Reader depth(*source, 1);
    for (int i = 0; i < 40; ++i) held.push_back(depth.next().value());
  }
  EXPECT_EQ(source->missedPictures(), 0u);
  source->close();
  const auto expectAll = [&] {
    for (std::uint32_t i = 0; i < held.size(); ++i) ASSERT_EQ(numberOf(held[i]), i);
  };
  expectAll();
  ASSERT_TRUE(source->open(kUrl)) << "while old pictures are held";
  source.reset();
  EXPECT_EQ(held.size(), 40u);
}

TEST_F(CameraV4l2, UnpluggedItIsLostAndItComesBack) {
  UmockdevCamera camera(bed_, 0, depthCamera());
  const auto source = openCamera();
  Reader depth(*source, 1);
  ASSERT_TRUE(depth.next());
  camera.unplug();
  EXPECT_FALSE(depth.next());
  EXPECT_EQ(depth.error.code, ErrorCode::Lost);
  EXPECT_STREQ(depth.error.message, "the camera has gone away; check its cable");
  source->close();
  EXPECT_EQ(source->open(kUrl).error().code, ErrorCode::NotFound);
  camera.plug();
  EXPECT_TRUE(source->open(kUrl));
  EXPECT_TRUE(Reader(*source, 1).next());
}

TEST_F(CameraV4l2, ASilentCameraTimesOutAndAnInterruptionEndsTheWait) {
  UmockdevCamera camera(bed_, 0, depthCamera());
  const auto source = openCamera();
  Reader depth(*source, 1);
  ASSERT_TRUE(depth.next());
  camera.silence();
  {
    const std::jthread other([&source] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      source->interrupt();
    });
    EXPECT_FALSE(depth.next());
    EXPECT_EQ(depth.error.code, ErrorCode::Cancelled);
  }
  EXPECT_EQ(test::answerOf(source->read()), ErrorCode::Cancelled) << "until it is opened again";
  source->close();
  EXPECT_EQ(source->open(kUrl).error().code, ErrorCode::Timeout) << "three seconds later";
}

TEST_F(CameraV4l2, ReadsEveryFormatOfDepthInItsOwnBits) {
  const struct {
    const char* name;
    std::uint32_t fourcc;
    int bits;
  } formats[] = {{"y16", V4L2_PIX_FMT_Y16, 16}, {"y12", V4L2_PIX_FMT_Y12, 12}, {"y10", V4L2_PIX_FMT_Y10, 10}};
  int number = 0;
  for (const auto& format : formats) {
    CameraKind kind{.formats = {format.fourcc}};
    kind.sample = [bits = format.bits](std::uint32_t, int, int) {
      return static_cast<std::uint16_t>((1U << bits) - 2);
    };
    UmockdevCamera camera(bed_, number, kind);
    const auto source = openCamera("v4l2:/dev/video" + std::to_string(number++));
    const StreamInfo& stream = source->streams()[1];
    EXPECT_EQ(stream.codec, format.name);
    EXPECT_TRUE(stream.tags.empty()) << "the meaning of its codes is unknown";
    const Frame exact = Reader(*source, 1).next().value();
    EXPECT_EQ(exact.components[0].bits, format.bits);
    EXPECT_EQ(sampleOf(exact, 0, 1, 1), (1U << format.bits) - 2);
    EXPECT_EQ(sampleOf(Reader(*source, 0).next().value(), 0, 1, 1), 255u);
  }
}

TEST_F(CameraV4l2, AColourCameraIsOneTrack) {
  CameraKind kind{.formats = {V4L2_PIX_FMT_YUYV}};
  // Y0 U, Y1 V, Y2 U, ..: the column in Y, 200 in U, 50 in V.
  kind.sample = [](std::uint32_t, int c, int) { return static_cast<std::uint16_t>(c | (c % 2 == 0 ? 200 : 50) << 8); };
  UmockdevCamera camera(bed_, 0, kind);
  const auto source = openCamera();
  ASSERT_EQ(source->streams().size(), 1u);
  const Frame frame = Reader(*source, 0).next().value();
  EXPECT_EQ(frame.model, ColorModel::Yuv);
  EXPECT_EQ(frame.range, ColorRange::Limited);
  for (const int c : {0, 1, 7, 62}) EXPECT_EQ(sampleOf(frame, 0, c, 3), static_cast<std::uint32_t>(c));
  EXPECT_EQ(sampleOf(frame, 1, 31, 3), 200u);
  EXPECT_EQ(sampleOf(frame, 2, 31, 3), 50u);
}

TEST_F(CameraV4l2, TakesDistancesFirstAndWhatIsAskedForByName) {
  UmockdevCamera camera(bed_, 0, {.formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_Y16, V4L2_PIX_FMT_Z16}});
  EXPECT_EQ(openCamera()->streams()[0].codec, "z16");
  EXPECT_EQ(openCamera("v4l2:/dev/video0,Y16,64x48@30")->streams()[0].codec, "y16");
  EXPECT_EQ(openCamera("v4l2:/dev/video0,YUYV")->streams()[0].codec, "yuyv");
  const auto refusal = [](const char* url) { return makeV4l2Source()->open(url).error().code; };
  EXPECT_EQ(refusal("v4l2:/dev/video0,Y12"), ErrorCode::Unsupported);
  EXPECT_EQ(refusal("v4l2:/dev/video0,320x240"), ErrorCode::Unsupported);
  EXPECT_EQ(refusal("v4l2:/dev/video9"), ErrorCode::NotFound);
  EXPECT_EQ(refusal("v4l2:/dev/null"), ErrorCode::Unsupported);
  for (const char* url : {"v4l2:", "v4l2:/dev/video0,", "v4l2:/dev/video0,0x48", "v4l2:/dev/video0@-3",
                          "v4l2:/dev/video0@nan", "v4l2:/dev/video0,depth"}) {
    EXPECT_EQ(refusal(url), ErrorCode::InvalidArgument) << url;
  }
}

}  // namespace
}  // namespace relievo
