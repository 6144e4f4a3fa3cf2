// SPDX-License-Identifier: Apache-2.0
// What the pictures of a hardware decoder say of themselves.
#include "drivers/v4l2/m2m_picture.h"

#include <gtest/gtest.h>

namespace relievo::v4l2 {
namespace {

Frame pictureOf(const StreamInfo& stream) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_NV12;
  format.fmt.pix.width = 64;
  format.fmt.pix.height = 48;
  const auto layout = layoutOf(format, std::nullopt, stream);
  EXPECT_TRUE(layout);
  return layout ? layout->frame : Frame{};
}

TEST(M2mPicture, HasTheColoursOfTheStream) {
  StreamInfo stream;
  stream.primaries = 9;
  stream.transfer = 18;
  const Frame frame = pictureOf(stream);
  EXPECT_EQ(frame.primaries, 9);
  EXPECT_EQ(frame.transfer, 18);
}

TEST(M2mPicture, IsInterlacedWhereTheDriverSaysSo) {
  struct Case {
    FieldOrder stream;
    std::uint32_t field;
    bool interlaced, top_first;
  };
  for (const Case& c : {Case{FieldOrder::Unknown, V4L2_FIELD_NONE, false, true},
                        {FieldOrder::BottomBottom, V4L2_FIELD_NONE, false, true},
                        {FieldOrder::Unknown, V4L2_FIELD_INTERLACED, true, true},
                        {FieldOrder::BottomBottom, V4L2_FIELD_INTERLACED, true, false},
                        {FieldOrder::TopBottom, V4L2_FIELD_INTERLACED, true, false},
                        {FieldOrder::BottomTop, V4L2_FIELD_INTERLACED, true, true},
                        {FieldOrder::BottomBottom, V4L2_FIELD_INTERLACED_TB, true, true},
                        {FieldOrder::TopTop, V4L2_FIELD_INTERLACED_BT, true, false}}) {
    StreamInfo stream;
    stream.fields = c.stream;
    Frame frame = pictureOf(stream);
    setFields(frame, c.field);
    EXPECT_EQ(frame.interlaced, c.interlaced) << c.field;
    EXPECT_EQ(frame.top_field_first, c.top_first) << c.field << ' ' << static_cast<int>(c.stream);
  }
}

}  // namespace
}  // namespace relievo::v4l2
