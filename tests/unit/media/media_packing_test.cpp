// SPDX-License-Identifier: Apache-2.0
// Which tracks are colour and depth, and the halves of packed pictures.
#include <gtest/gtest.h>

#include "app/media/reading/packing.h"

namespace relievo {
namespace {

using Tags = std::map<std::string, std::string>;

StreamInfo video(Tags tags = {}) {
  StreamInfo stream;
  stream.kind = StreamKind::Video;
  stream.tags = std::move(tags);
  return stream;
}

class ListedSource final : public MediaSource {
 public:
  ListedSource(std::vector<StreamInfo> streams, Tags tags) : streams_(std::move(streams)), tags_(std::move(tags)) {
    for (std::size_t i = 0; i < streams_.size(); ++i) streams_[i].index = static_cast<int>(i);
    EXPECT_TRUE(open("").has_value());
  }

 private:
  Result<Description> openSource(const std::string&) override { return Description{streams_, tags_, Duration(0)}; }
  Result<std::optional<Packet>> readPacket() override { return std::nullopt; }
  Result<void> seekTo(MediaTime) override { return {}; }
  void closeSource() noexcept override {}
  void interrupted() noexcept override {}
  std::vector<StreamInfo> streams_;
  Tags tags_;
};

// "colour/depth packing", by stream number; "-" for no depth.
std::string planOf(std::vector<StreamInfo> streams, Packing packing = Packing::Auto, bool elsewhere = false,
                   Tags tags = {}) {
  const ListedSource source(std::move(streams), std::move(tags));
  const auto plan = planTracks(source, packing, elsewhere);
  if (!plan) return plan.error().code == ErrorCode::NotFound ? "not found" : "other error";
  const char* const names[] = {"auto", "tracks", "sbs", "tb"};
  return std::to_string(plan->color->index) + "/" +
         (plan->depth == nullptr ? "-" : std::to_string(plan->depth->index)) + " " +
         names[static_cast<int>(plan->packing)];
}

TEST(Packing, OnePlainTrackIsColourAlone) {
  EXPECT_EQ(planOf({video()}), "0/- tracks");
}

TEST(Packing, OfTwoTracksTheMarkedOneIsTheDepthElseTheSecond) {
  EXPECT_EQ(planOf({video(), video()}), "0/1 tracks");
  EXPECT_EQ(planOf({video({{"TITLE", "The Depth map"}}), video()}), "1/0 tracks");
  EXPECT_EQ(planOf({video({{"HANDLER_NAME", "depth"}}), video({{"HANDLER_NAME", "VideoHandler"}})}), "1/0 tracks");
  EXPECT_EQ(planOf({video(), video(), video({{"DEPTH_LAW", "inverse"}})}), "0/2 tracks");
  EXPECT_EQ(planOf({video(), video(), video({{"HANDLER_NAME", "Core Media Auxiliary Picture"}})}), "0/2 tracks");
  EXPECT_EQ(planOf({video(), video(), video()}), "0/1 tracks");
  EXPECT_EQ(planOf({video({{"DEPTH_PACKING", "tracks"}}), video()}), "0/1 tracks");
  EXPECT_EQ(planOf({video(), video()}, Packing::Tracks), "0/1 tracks");
}

// A track of what the surface feels like is neither colour nor depth, whatever its place.
TEST(Packing, AMaterialTrackIsToldByItsTagAndItsName) {
  const StreamInfo material = video({{"MATERIAL_SCALE", "stiffness=1"}}), named = video({{"HANDLER_NAME", "material"}});
  EXPECT_EQ(planOf({video(), material}), "0/- tracks");
  EXPECT_EQ(planOf({material, video(), video()}), "1/2 tracks");
  EXPECT_EQ(planOf({video(), material, video({{"DEPTH_LAW", "inverse"}})}), "0/2 tracks");
  const ListedSource file({video(), named, video()}, {{"MATERIAL_SCALE", "stiffness=1"}});
  EXPECT_EQ(planTracks(file, Packing::Auto, false)->material->index, 1) << "of a container with tags of its own alone";
  EXPECT_EQ(planOf({video(), named}), "0/1 tracks") << "a name alone says nothing";
}

StreamInfo auxiliary() {
  StreamInfo stream = video();
  stream.auxiliary = true;
  return stream;
}

TEST(Packing, WhatTheStreamSignalsGoesBeforeTheTags) {
  EXPECT_EQ(planOf({auxiliary(), video()}), "1/0 tracks");
  EXPECT_EQ(planOf({video(), video(), auxiliary()}), "0/2 tracks");
  EXPECT_EQ(planOf({auxiliary(), video({{"TITLE", "depth"}})}), "1/0 tracks");
  EXPECT_EQ(findDepthTrack(ListedSource({video(), video(), auxiliary()}, {}))->index, 2);
}

TEST(Packing, OnlyVideoStreamsCount) {
  StreamInfo audio;
  audio.kind = StreamKind::Audio;
  StreamInfo other;
  EXPECT_EQ(planOf({other, audio, video()}), "2/- tracks");
  EXPECT_EQ(planOf({audio, video(), other, video()}), "1/3 tracks");
  EXPECT_EQ(planOf({audio, other}), "not found");
}

TEST(Packing, ATagSaysThatAPictureIsPacked) {
  EXPECT_EQ(planOf({video({{"DEPTH_PACKING", "sbs"}})}), "0/- sbs");
  EXPECT_EQ(planOf({video()}, Packing::Auto, false, {{"DEPTH_PACKING", "TB"}}), "0/- tb");
  EXPECT_EQ(planOf({video({{"DEPTH_PACKING", "tb"}})}, Packing::Auto, false, {{"DEPTH_PACKING", "sbs"}}), "0/- tb");
  EXPECT_EQ(planOf({video({{"DEPTH_PACKING", "diagonal"}})}), "0/- tracks");
}

TEST(Packing, TheCallersWordGoesBeforeTheTags) {
  EXPECT_EQ(planOf({video({{"DEPTH_PACKING", "sbs"}})}, Packing::TopBottom), "0/- tb");
  EXPECT_EQ(planOf({video(), video()}, Packing::SideBySide), "0/- sbs");
  EXPECT_EQ(planOf({video()}, Packing::Tracks), "not found");
}

TEST(Packing, WithTheDepthElsewhereTheSourceIsColour) {
  EXPECT_EQ(planOf({video()}, Packing::Auto, true), "0/- tracks");
  EXPECT_EQ(planOf({video()}, Packing::Tracks, true), "0/- tracks");
  EXPECT_EQ(planOf({video({{"TITLE", "depth"}}), video()}, Packing::Auto, true), "1/- tracks");
  EXPECT_EQ(planOf({video({{"DEPTH_PACKING", "sbs"}})}, Packing::Auto, true), "0/- tracks");
}

TEST(Packing, TheDepthTrackOfADepthSourceIsFound) {
  EXPECT_EQ(findDepthTrack(ListedSource({video()}, {}))->index, 0);
  EXPECT_EQ(findDepthTrack(ListedSource({video(), video()}, {}))->index, 1);
  EXPECT_EQ(findDepthTrack(ListedSource({video({{"TITLE", "depth"}}), video()}, {}))->index, 0);
  EXPECT_EQ(findDepthTrack(ListedSource({}, {})), nullptr);
}

// A picture whose luma sample (c, r) is at address base + r * 1000 + c, with chroma in separate planes.
Frame picture(int width, int height, ColorModel model) {
  static std::array<std::uint8_t, 1> memory{};
  Frame frame;
  frame.width = width;
  frame.height = height;
  frame.model = model;
  frame.plane_count = model == ColorModel::Yuv ? 3 : 1;
  frame.planes[0] = {memory.data(), 1000};
  if (model != ColorModel::Yuv) return frame;
  frame.chroma_shift_x = frame.chroma_shift_y = 1;
  frame.components[1].plane = 1;
  frame.components[2].plane = 2;
  frame.planes[1] = frame.planes[2] = {memory.data(), 1000};
  return frame;
}

struct Corner {
  std::ptrdiff_t x, y;
  int width, height;
  bool operator==(const Corner&) const = default;
};
void PrintTo(const Corner& c, std::ostream* out) {
  *out << c.x << "," << c.y << " " << c.width << "x" << c.height;
}
Corner cornerOf(const Frame& part, const Frame& whole) {
  const std::ptrdiff_t distance = part.planes[0].data - whole.planes[0].data;
  return {distance % 1000, distance / 1000, part.width, part.height};
}

TEST(Packing, HalvesOfEvenPicturesTouch) {
  const Frame whole = picture(640, 360, ColorModel::Yuv);
  const auto sbs = splitPacked(whole, Packing::SideBySide, DepthCode::Luma).value();
  EXPECT_EQ(cornerOf(sbs.color, whole), (Corner{0, 0, 320, 360}));
  EXPECT_EQ(cornerOf(sbs.depth, whole), (Corner{320, 0, 320, 360}));
  const auto tb = splitPacked(whole, Packing::TopBottom, DepthCode::Luma).value();
  EXPECT_EQ(cornerOf(tb.color, whole), (Corner{0, 0, 640, 180}));
  EXPECT_EQ(cornerOf(tb.depth, whole), (Corner{0, 180, 640, 180}));
}

TEST(Packing, TheMiddleOfAnOddPictureIsLeftOut) {
  const Frame whole = picture(641, 361, ColorModel::Yuv);
  const auto sbs = splitPacked(whole, Packing::SideBySide, DepthCode::Luma).value();
  EXPECT_EQ(cornerOf(sbs.color, whole), (Corner{0, 0, 320, 361}));
  EXPECT_EQ(cornerOf(sbs.depth, whole), (Corner{321, 0, 320, 361}));
  const auto tb = splitPacked(whole, Packing::TopBottom, DepthCode::Luma).value();
  EXPECT_EQ(cornerOf(tb.depth, whole), (Corner{0, 181, 641, 180}));
}

// Half of 642 is 321: no chroma sample of 4:2:0 begins there, but a luma sample does.
TEST(Packing, LumaBeginsAtTheExactSampleAndHueAtAWholeChromaSample) {
  const Frame whole = picture(642, 362, ColorModel::Yuv);
  EXPECT_EQ(cornerOf(splitPacked(whole, Packing::SideBySide, DepthCode::Luma)->depth, whole),
            (Corner{321, 0, 321, 362}));
  const auto hue = splitPacked(whole, Packing::SideBySide, DepthCode::Hue).value();
  EXPECT_EQ(cornerOf(hue.depth, whole), (Corner{322, 0, 320, 362}));
  EXPECT_EQ(cornerOf(hue.color, whole), (Corner{0, 0, 320, 362}));
  EXPECT_EQ(hue.depth.planes[1].data - whole.planes[1].data, 161);
  const Frame rgb = picture(642, 362, ColorModel::Rgb);
  EXPECT_EQ(cornerOf(splitPacked(rgb, Packing::SideBySide, DepthCode::Hue)->depth, rgb), (Corner{321, 0, 321, 362}));
}

// Unsignalled YUV is limited range, and the gray view of its depth must be too.
TEST(Packing, LumaDepthIsGrayOfTheSameRange) {
  Frame whole = picture(64, 48, ColorModel::Yuv);
  const auto depthRange = [&] { return splitPacked(whole, Packing::TopBottom, DepthCode::Luma)->depth.range; };
  EXPECT_EQ(splitPacked(whole, Packing::TopBottom, DepthCode::Luma)->depth.model, ColorModel::Gray);
  EXPECT_EQ(splitPacked(whole, Packing::TopBottom, DepthCode::Luma)->color.model, ColorModel::Yuv);
  EXPECT_EQ(depthRange(), ColorRange::Limited);
  whole.range = ColorRange::Full;
  EXPECT_EQ(depthRange(), ColorRange::Full);
}

TEST(Packing, APictureTooSmallToBeHalvedIsRefused) {
  EXPECT_FALSE(splitPacked(picture(1, 48, ColorModel::Gray), Packing::SideBySide, DepthCode::Luma).has_value());
  EXPECT_TRUE(splitPacked(picture(2, 48, ColorModel::Gray), Packing::SideBySide, DepthCode::Luma).has_value());
}

}  // namespace
}  // namespace relievo
