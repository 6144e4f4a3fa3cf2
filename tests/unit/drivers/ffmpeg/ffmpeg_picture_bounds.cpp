// SPDX-License-Identifier: Apache-2.0
// PNGs and JPEGs that FFmpeg would decode for seconds, or into much memory: refused as files, and as packets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/ffmpeg/ffmpeg.h"
#include "tests/support/files.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

extern "C" {
#include <libavutil/frame.h>
}

namespace relievo {
namespace {

using test::makeClip;
using test::TemporaryFolder;
using testing::HasSubstr;

std::string bigEndian(std::size_t number, int bytes) {
  std::string out;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out += static_cast<char>(number >> shift & 0xFF);
  return out;
}

// A picture of a folder reaches the decoder as it is.
std::uint64_t damagedOf(const StreamInfo& stream, const std::string& picture) {
  const auto decoder = makeFfmpegDecoder();
  EXPECT_TRUE(decoder->open(stream));
  const auto bytes = std::make_shared<std::vector<std::uint8_t>>(picture.begin(), picture.end());
  EXPECT_TRUE(decoder->feed({.data = bytes->data(), .bytes = bytes->size(), .keyframe = true, .owner = bytes}));
  return decoder->damaged();
}

class APng : public testing::Test {
 protected:
  APng() {
    makeClip(folder_ / "plain.png", {{.codec = "png", .pix_fmt = "gray", .width = 64, .height = 48, .frames = 1}});
    plain_ = test::contentOf(folder_ / "plain.png");
  }

  static std::string chunk(const std::string& type, const std::string& data) {
    return bigEndian(data.size(), 4) + type + data + "....";  // FFmpeg does not check the sum
  }
  // A profile or compressed text that unpacks to so many bytes, repeats of `what`.
  static std::string packed(const std::string& type, std::size_t bytes, const std::string& what = "x") {
    std::string unpacked;
    while (unpacked.size() < bytes) unpacked += what;
    unpacked.resize(bytes);
    std::string stream(::compressBound(bytes), '\0');
    uLongf length = stream.size();
    EXPECT_EQ(::compress(reinterpret_cast<Bytef*>(stream.data()), &length,
                         reinterpret_cast<const Bytef*>(unpacked.data()), bytes),
              Z_OK);
    return chunk(type, std::string("name\0\0", 6) + stream.substr(0, length));
  }
  static std::string times(int count, const std::string& one) {
    std::string all;
    for (int i = 0; i < count; ++i) all += one;
    return all;
  }
  [[nodiscard]] std::string with(const std::string& more) const {
    constexpr std::size_t kHeader = 33;  // the signature and IHDR
    return plain_.substr(0, kHeader) + more + plain_.substr(kHeader);
  }
  std::string fileWith(const std::string& more) {
    writeFile(folder_ / "a.png", with(more));
    return folder_ / "a.png";
  }
  [[nodiscard]] StreamInfo stream() const {
    const auto source = makeFfmpegSource();
    EXPECT_TRUE(source->open(folder_ / "plain.png"));
    return source->streams()[0];
  }

 private:
  const TemporaryFolder folder_;
  std::string plain_;
};

// FFmpeg's time for the texts grows with the square of their number: 100,000 took it minutes.
TEST_F(APng, WithMoreTextsThanAnyProgramWritesIsRefusedBeforeItIsDecoded) {
  const std::string text = chunk("tEXt", std::string("a\0b", 3)), other = chunk("npTC", "");
  EXPECT_TRUE(makeFfmpegSource()->open(fileWith(times(1000, text))));
  const Error error = openErrorOf(fileWith(times(1001, text)));
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 1000 texts"));
  EXPECT_EQ(openErrorOf(fileWith(times(50000, other) + times(1001, text))).code, ErrorCode::Unsupported);
  EXPECT_EQ(openErrorOf(fileWith(times(100001, other))).code, ErrorCode::Unsupported)
      << "what is behind them is not looked at";
  EXPECT_EQ(damagedOf(stream(), with(times(1000, text))), 0u);
  EXPECT_EQ(damagedOf(stream(), with(times(1001, text))), 1u);
}

// They become up to a thousand times as long: ten texts of 200 KB took over 6 GB, a profile of 290 KB 8 s.
TEST_F(APng, WithTextsOrAProfileThatUnpackToOver16MiBIsRefused) {
  constexpr std::size_t kMost = std::size_t{1} << 24;
  for (const char* type : {"zTXt", "iCCP"}) {
    EXPECT_TRUE(makeFfmpegSource()->open(fileWith(packed(type, kMost)))) << type;
    const Error error = openErrorOf(fileWith(packed(type, kMost + 1)));
    EXPECT_EQ(error.code, ErrorCode::Unsupported) << type;
    EXPECT_THAT(error.message, HasSubstr("16 MiB of compressed texts and colour profiles"));
    EXPECT_EQ(openErrorOf(fileWith(packed(type, 9'000'000) + packed(type, 9'000'000))).code, ErrorCode::Unsupported);
    EXPECT_EQ(damagedOf(stream(), with(packed(type, kMost + 1))), 1u) << type;
  }
  const std::string name(80, 'n');  // FFmpeg unpacks a text with a longer name than may be
  EXPECT_EQ(openErrorOf(fileWith(chunk("zTXt", name + std::string(20, '\0')))).code, ErrorCode::Unsupported);
}

TEST_F(APng, WithAUsualOrADamagedProfileIsOpened) {
  std::string noise;  // hardly packs: of 500 kB, as print shops have
  std::uint32_t state = 1;
  while (noise.size() < 500'000) noise += static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  EXPECT_TRUE(makeFfmpegSource()->open(fileWith(packed("iCCP", noise.size(), noise))));
  EXPECT_EQ(damagedOf(stream(), with(packed("iCCP", noise.size(), noise))), 0u);
  EXPECT_TRUE(makeFfmpegSource()->open(fileWith(chunk("iCCP", std::string("a\0\0", 3) + std::string(500'000, '\0')))));
  EXPECT_TRUE(makeFfmpegSource()->open(fileWith(chunk("zTXt", "a"))));
}

TEST_F(APng, LeavesNeitherItsTextsNorItsProfileWithThePicture) {
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(fileWith(chunk("tEXt", std::string("a\0b", 3)) + packed("iCCP", 1000))));
  const auto decoder = makeFfmpegDecoder();
  ASSERT_TRUE(decoder->open(source->streams()[0]));
  ASSERT_TRUE(decoder->feed(*source->read().value()));
  ASSERT_TRUE(decoder->drain());
  const auto frame = decoder->receive().value();
  ASSERT_TRUE(frame);
  const auto& picture = *static_cast<const AVFrame*>(frame->owner.get());
  EXPECT_EQ(picture.metadata, nullptr);
  EXPECT_EQ(av_frame_get_side_data(&picture, AV_FRAME_DATA_ICC_PROFILE), nullptr);
}

// A progressive JPEG (ITU-T T.81) of 16 x 16 in gray: a scan of the means, and others that say "nothing more".
class AJpeg : public testing::Test {
 protected:
  static std::string segment(char marker, const std::string& data) {
    return std::string("\xFF") + marker + bigEndian(data.size() + 2, 2) + data;
  }
  static std::string begin() {
    using namespace std::string_literals;
    return "\xFF\xD8"s + segment('\xDB', "\0"s + std::string(64, '\1')) +
           segment('\xC2', "\10\0\20\0\20\1\1\x11\0"s) +                   // 8 bits, 16 x 16, one component
           segment('\xC4', "\0\1"s + std::string(15, '\0') + "\0"s) +      // one code: no change of the mean
           segment('\xC4', "\x10\1"s + std::string(15, '\0') + "\x20"s) +  // one code: four blocks and on have none
           segment('\xDA', "\1\1\0\0\0\1"s) + "\0"s;                       // the means
  }
  static std::string scans(int count) {
    using namespace std::string_literals;
    std::string all;
    for (int i = 0; i < count; ++i) all += segment('\xDA', "\1\1\0\1\77\1"s) + "\x1F"s;  // a code, 00 and filling
    return all;
  }
  static std::string jpeg(int count, const std::string& more = "") {
    return begin() + more + scans(count - 1) + "\xFF\xD9";
  }
  std::string file(const std::string& content) {
    writeFile(folder_ / "a.jpg", content);
    return folder_ / "a.jpg";
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(AJpeg, WithOver500ScansIsRefusedBeforeItIsDecoded) {
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(file(jpeg(500))));
  EXPECT_EQ(damagedOf(source->streams()[0], jpeg(500)), 0u);
  EXPECT_EQ(damagedOf(source->streams()[0], jpeg(501)), 1u);
  EXPECT_EQ(damagedOf(source->streams()[0], "garbage" + jpeg(501)), 1u);
  const Error error = openErrorOf(file(jpeg(501)));
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 500 scans"));
}

TEST_F(AJpeg, ScansOfAPreviewInItsHeaderAndOfWhatFollowsItAreNotCounted) {
  const std::string preview = segment('\xE1', jpeg(400)) + segment('\xFE', jpeg(400));
  EXPECT_TRUE(makeFfmpegSource()->open(file(jpeg(400, preview))));
  EXPECT_TRUE(makeFfmpegSource()->open(file(jpeg(400) + std::string(40'000, '\0') + jpeg(400))));
  EXPECT_EQ(openErrorOf(file(jpeg(400) + jpeg(400))).code, ErrorCode::Unsupported) << "two fields";
}

// FFmpeg reads on behind the marker of a frame that it does not decode, whatever length that states.
TEST_F(AJpeg, ScansDoNotHideInAFrameOfAnUnknownKind) {
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(file(jpeg(1))));
  const std::string start = begin().substr(0, 2);
  for (const char* marker : {"\xFF\xC5", "\xFF\xC8", "\xFF\xCF"}) {
    const auto hidden = [&](int count) { return start + marker + "\xFF\xFF" + jpeg(count).substr(2); };
    EXPECT_EQ(damagedOf(source->streams()[0], hidden(500)), 0u) << "FFmpeg does not decode it";
    EXPECT_EQ(damagedOf(source->streams()[0], hidden(501)), 1u);
    EXPECT_EQ(openErrorOf(file(hidden(501))).code, ErrorCode::Unsupported);
  }
}

// It reads on behind the length of a comment that is longer than the file, and behind the last whole table.
TEST_F(AJpeg, ScansDoNotHideInALengthThatIsNotTrue) {
  using namespace std::string_literals;
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(file(jpeg(1))));
  const std::string start = begin().substr(0, 2);
  for (const std::string& marker : {"\xFF\xFE\xFF\xFF"s, "\xFF\xE1\xFF\xFF"s, "\xFF\xDB\0\x42"s}) {
    const auto hidden = [&](int count) { return start + marker + jpeg(count).substr(2); };
    EXPECT_EQ(damagedOf(source->streams()[0], hidden(500)), 0u) << "FFmpeg does not decode it";
    EXPECT_EQ(damagedOf(source->streams()[0], hidden(501)), 1u);
  }
  std::string parts, short_ones;  // five scans in each of 101 lists without a table; markers in too short data
  for (int i = 0; i < 101; ++i) parts += "\xFF\xDB\0\x42"s + scans(5);
  for (int i = 0; i < 501; ++i) short_ones += "\xFF\xE1\0\5\0"s + scans(1);
  EXPECT_EQ(damagedOf(source->streams()[0], jpeg(1, short_ones)), 1u);
  EXPECT_EQ(damagedOf(source->streams()[0], jpeg(1, parts)), 1u);
}

TEST_F(AJpeg, AnEndBeforeAnyFrameIsNone) {
  using namespace std::string_literals;
  const auto source = makeFfmpegSource();
  ASSERT_TRUE(source->open(file(jpeg(1))));
  for (const std::string& ends : {"\xFF\xD8\xFF\xD9"s, "\xFF\xD8\xFF\xD9\xFF\xD8\xFF\xD9"s,
                                  "\xFF\xD8\xFF\xD9"s + segment('\xFE', std::string(40'000, 'x'))}) {
    EXPECT_EQ(damagedOf(source->streams()[0], ends + jpeg(500)), 0u) << "FFmpeg does not decode it";
    EXPECT_EQ(damagedOf(source->streams()[0], ends + jpeg(501)), 1u);
    EXPECT_EQ(openErrorOf(file(ends + jpeg(501))).code, ErrorCode::Unsupported);
  }
}

}  // namespace
}  // namespace relievo
