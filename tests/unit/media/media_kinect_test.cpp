// SPDX-License-Identifier: Apache-2.0
// Azure Kinect's recordings, written element by element: which track is depth, what its codes are, and the registration
// of its attachment.
#include <gtest/gtest.h>
#include <algorithm>

#include <fstream>

#include "app/media/pair_reader.h"
#include "app/media/registration/own_registration.h"
#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/recording/kinect_mkv.h"

namespace relievo {
namespace {

using test::KinectTrack;

constexpr int kCols = 320, kRows = 288;  // NFOV, binned
constexpr int kPictures = 3;
constexpr int kHole = 40;  // columns at the left

int millimetresAt(int c, int r, int picture) {
  return c < kHole ? 0 : 1000 + 2 * r + picture;
}
std::string gray16(const std::function<int(int c, int r)>& code) {
  std::string data;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) {
      const int value = code(c, r);
      data += static_cast<char>(value >> 8);
      data += static_cast<char>(value);
    }
  }
  return data;
}
KinectTrack depthTrack(const std::function<int(int c, int r, int picture)>& code = millimetresAt) {
  KinectTrack track{.name = "DEPTH", .fourcc = "b16g", .cols = kCols, .rows = kRows, .pictures = {}};
  for (int i = 0; i < kPictures; ++i) track.pictures.push_back(gray16([&](int c, int r) { return code(c, r, i); }));
  return track;
}
KinectTrack infraredTrack() {
  KinectTrack track = depthTrack([](int, int, int) { return 77; });
  track.name = "IR";
  return track;
}
// Its upper half is brighter.
KinectTrack colorTrack(const std::string& fourcc = "NV12") {
  const int cols = 1280, rows = 720, bytes = fourcc == "NV12" ? 1 : 4;
  std::string picture;
  for (int r = 0; r < rows; ++r) picture.append(static_cast<std::size_t>(cols * bytes), r < rows / 2 ? '\xc8' : '\x40');
  if (fourcc == "NV12") picture.append(static_cast<std::size_t>(cols * rows / 2), '\x80');
  return {.name = "COLOR",
          .fourcc = fourcc,
          .cols = cols,
          .rows = rows,
          .bits = static_cast<std::uint16_t>(bytes == 1 ? 12 : 32),
          .pictures = std::vector<std::string>(kPictures, picture)};
}

// Both cameras look the same way; the colour camera's frame is moved by `x_mm`.
std::string calibration(double x_mm, const std::string& model = "BrownConrady") {
  const auto camera = [&](const char* location, const char* lens, double x, int width, int height) {
    return R"({"Intrinsics":{"ModelParameterCount":14,"ModelParameters":[)" + std::string(lens) +
           R"(],"ModelType":"CALIBRATION_LensDistortionModel)" + model +
           R"("},"Location":"CALIBRATION_CameraLocation)" + location +
           R"(","MetricRadius":1.74,"Rt":{"Rotation":[1,0,0,0,1,0,0,0,1],"Translation":[)" + std::to_string(x / 1000) +
           R"(,0,0]},"SensorHeight":)" + std::to_string(height) + R"(,"SensorWidth":)" + std::to_string(width) + "}";
  };
  // Principal points in the middle of the modes' pictures: (96 + 160)/512 and (90 + 144)/512.
  return R"({"CalibrationInformation":{"Cameras":[)" +
         camera("D0", "0.5,0.45703125,0.5,0.5,0,0,0,0,0,0,0,0,0,0", 0, 1024, 1024) + "," +
         camera("PV0", "0.5,0.5,0.8,1.0666666666666667,0,0,0,0,0,0,0,0,0,0", x_mm, 4096, 3072) + "]}}" +
         std::string(1, '\0');
}

class KinectRecording : public testing::Test {
 protected:
  [[nodiscard]] bool describesBothCameras() const {
    const auto& why = reader_.info().reading.why;
    return std::any_of(why.begin(), why.end(), [](const std::string& line) { return line.contains("both cameras"); });
  }
  Result<void> open(const std::vector<KinectTrack>& tracks, const std::string& calibration,
                    SourceOptions options = {}) {
    options.url = folder_ / "film.mkv";
    std::ofstream(options.url, std::ios::binary) << test::kinectMkv(tracks, calibration);
    return reader_.open(options);
  }
  FramePair next() {
    auto pair = reader_.next();
    EXPECT_TRUE(pair && *pair);
    return pair && *pair ? std::move(**pair) : FramePair{};
  }
  static int codeOf(const Frame& frame, int c, int r) {
    const Component& where = frame.components[0];
    return static_cast<int>(codeAt(
        where, frame.planes[0].data + r * frame.planes[0].stride_bytes + where.offset_bytes + c * where.step_bytes));
  }
  test::TemporaryFolder folder_;
  PairReader reader_{{.make_source = [](const std::string&) { return makeFfmpegSource(); },
                      .make_decoder = [](const StreamInfo&) { return makeFfmpegDecoder(); },
                      .read_text = {}}};
};

TEST_F(KinectRecording, DepthIsBigEndianMillimetresAndInfraredIsIgnored) {
  for (const bool infrared_first : {false, true}) {
    std::vector<KinectTrack> tracks{colorTrack(), depthTrack(), infraredTrack()};
    if (infrared_first) std::ranges::reverse(tracks);
    ASSERT_TRUE(open(tracks, ""));
    const FilmInfo& info = reader_.info();
    ASSERT_TRUE(info.has_depth);
    EXPECT_EQ(info.color_width, 1280);
    EXPECT_EQ(info.calibration.calibration.unit_mm, 1);
    EXPECT_TRUE(info.calibration.calibration.invalid.contains(0));
    EXPECT_EQ(info.calibration.origin, CalibrationOrigin::ContainerTags);
    for (int i = 0; i < kPictures; ++i) {
      const FramePair pair = next();
      EXPECT_EQ(pair.color.pts, MediaTime(std::chrono::microseconds(1'000'000 * i / 30)));
      EXPECT_EQ(pair.depth.pts, pair.color.pts);
      ASSERT_EQ(pair.depth.width, kCols);
      for (int r = 0; r < kRows; r += 7) {
        for (int c = 0; c < kCols; c += 13)
          ASSERT_EQ(codeOf(pair.depth, c, r), millimetresAt(c, r, i)) << c << ' ' << r;
      }
    }
  }
}

TEST_F(KinectRecording, ColourIsTheRightWayUp) {
  for (const char* const fourcc : {"NV12", "BGRA"}) {
    ASSERT_TRUE(open({colorTrack(fourcc), depthTrack()}, "")) << fourcc;
    const FramePair pair = next();
    EXPECT_EQ(codeOf(pair.color, 600, 100), 0xc8) << fourcc;
    EXPECT_EQ(codeOf(pair.color, 600, 600), 0x40) << fourcc;
  }
}

// A colour camera of focal length 0.8 * 1280 = 1024 pixels, in a picture that is scaled to 320 columns 256, as the
// depth camera's: 100 mm to its left a wall in 1 m appears 25.6 columns to the right. The colour's 180 rows are the
// depth's rows 54 to 233.
TEST_F(KinectRecording, ItsAttachmentRegistersTheDepth) {
  const auto wall = depthTrack([](int c, int r, int) { return r == 60 ? 900 : c < kHole ? 0 : 1000; });
  ASSERT_TRUE(open({colorTrack(), wall}, calibration(100)));
  EXPECT_TRUE(describesBothCameras());
  const FramePair pair = next();
  ASSERT_EQ(pair.depth.width, 320);
  ASSERT_EQ(pair.depth.height, 180);
  EXPECT_EQ(codeOf(pair.depth, 65, 90), 0) << "the hole has moved along";
  EXPECT_EQ(codeOf(pair.depth, 66, 90), 1000);
  EXPECT_EQ(codeOf(pair.depth, 200, 6), 900) << "row 60";
  EXPECT_EQ(codeOf(pair.depth, 200, 7), 1000);
}

// A sensor that has not begun to measure; the wall is 1000 to 1577 mm away.
TEST_F(KinectRecording, RegisteredDepthIsReadFromItsFirstPictureThatIsNotBlank) {
  const auto late = depthTrack([](int c, int r, int i) { return i == 0 ? 0 : millimetresAt(c, r, i); });
  ASSERT_TRUE(open({colorTrack(), late}, calibration(100)));
  EXPECT_TRUE(describesBothCameras());
  EXPECT_GT(reader_.info().calibration.calibration.near_mm, 800);
  EXPECT_LT(reader_.info().calibration.calibration.far_mm, 2000);
}

TEST_F(KinectRecording, TheUsersRegistrationOverridesTheFilms) {
  const RigCamera camera{
      .cols = 320, .rows = 288, .focal_x = 250, .focal_y = 250, .center_x = 159.5, .center_y = 143.5};
  SourceOptions options;
  options.registration = Registration{.depth = camera, .color = camera};
  ASSERT_TRUE(open({colorTrack(), depthTrack()}, calibration(100), options));
  EXPECT_FALSE(describesBothCameras());
  EXPECT_EQ(codeOf(next().depth, kHole, 9), 1018);
}

TEST_F(KinectRecording, ACalibrationThatCannotBeUsedIsLeftOut) {
  for (const std::string& text : {std::string("{"), calibration(100, "Theta"), calibration(100).substr(0, 300)}) {
    ASSERT_TRUE(open({colorTrack(), depthTrack()}, text));
    EXPECT_FALSE(describesBothCameras());
    EXPECT_EQ(codeOf(next().depth, kHole, 9), 1018);
  }
}

// The sensors' whole pictures are 1024 x 1024 and 4:3; modes cut out the middle and number pixels from their centres.
TEST(KinectCalibration, IsScaledToTheModesPictures) {
  const auto read = parseKinectCalibration(calibration(-32), {640, 576}, {1920, 1080});
  ASSERT_TRUE(read);
  EXPECT_DOUBLE_EQ(read->depth.focal_x, 512);
  EXPECT_DOUBLE_EQ(read->depth.center_x, 512 - 192 - 0.5);
  EXPECT_DOUBLE_EQ(read->depth.center_y, 468 - 180 - 0.5);
  EXPECT_DOUBLE_EQ(read->color.focal_x, 0.8 * 1920);
  EXPECT_DOUBLE_EQ(read->color.focal_y, 1536);
  EXPECT_DOUBLE_EQ(read->color.center_y, 720 - 180 - 0.5);
  EXPECT_DOUBLE_EQ(read->translation_mm[0], -32);
  EXPECT_FALSE(parseKinectCalibration(calibration(-32), {640, 480}, {1920, 1080})) << "no mode of the camera";
  EXPECT_FALSE(parseKinectCalibration(calibration(-32), {640, 576}, {1920, 1000}));
}

}  // namespace
}  // namespace relievo
