// SPDX-License-Identifier: Apache-2.0
// MP4 and QuickTime films whose tables say far more than the file holds: FFmpeg takes gigabytes for them, or minutes.
#include <gmock/gmock.h>
#include <zlib.h>

#include <algorithm>
#include <initializer_list>
#include <span>
#include <utility>

#include "drivers/ffmpeg/bounds/mp4_bounds.h"
#include "tests/support/files.h"
#include "tests/support/network/http_server.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using ffmpeg::exceededMp4Bound;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsNull;
using testing::StrEq;

std::string bigEndian(std::uint64_t number, int bytes = 4) {
  std::string text;
  for (int shift = 8 * bytes - 8; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift & 0xFF);
  return text;
}
std::string box(const std::string& type, const std::string& content = "") {
  return bigEndian(8 + content.size()) + type + content;
}
// With a version and flags of 0.
std::string table(const std::string& type, std::initializer_list<std::uint64_t> numbers, const std::string& more = "") {
  std::string content(4, '\0');
  for (const std::uint64_t number : numbers) content += bigEndian(number);
  return box(type, content + more);
}
std::string repeated(const std::string& one, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += one;
  return all;
}
std::string track(const std::string& kind, const std::string& tables, const std::string& more = "") {
  return box("trak",
             more + box("mdia", table("hdlr", {0}, kind + std::string(13, '\0')) + box("minf", box("stbl", tables))));
}
std::string pictures(std::uint64_t count, const std::string& more = "") {
  return track("vide", table("stts", {1, count, 1}) + table("stsz", {1, count}), more);
}
std::string film(const std::string& in_header, const std::string& behind = "") {
  return box("ftyp", "isom") + box("moov", in_header) + behind;
}
const char* exceeded(const std::string& bytes) {
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return exceededMp4Bound(ffmpeg::readable(std::span(data, bytes.size())));
}

// 12 million of them took a program 320 MB, and twenty such tracks 4.9 GB, of a file of 4 KB.
TEST(Mp4Film, WithMoreThan8MillionSamplesIsRefusedBeforeFFmpegReadsThem) {
  const TemporaryFolder folder;
  const std::string path = folder / "film.mp4";
  test::makeClip(path, {kH264, kH264});
  EXPECT_TRUE(makeFfmpegSource()->open(path));
  std::string bytes = test::contentOf(path);
  bytes.replace(bytes.find("stsz") + 8, 8, bigEndian(1) + bigEndian(9'000'000));
  writeFile(path, bytes);
  const Error error = openErrorOf(path);
  EXPECT_EQ(error.code, ErrorCode::Unsupported);
  EXPECT_THAT(error.message, HasSubstr("more than 8 million samples"));
}

// Where the first box of that type begins, and its size.
std::pair<std::size_t, std::size_t> placeOf(const std::string& bytes, const std::string& type) {
  const std::size_t place = bytes.find(type) - 4;
  std::size_t size = 0;
  for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<std::uint8_t>(bytes[place + i]);
  return {place, size};
}

// The lists of a server's film are not looked at. Without a bound these six tracks take 1.4 GB; the program goes on.
TEST(Mp4Film, OfAServerMayNotFillTheMemory) {
  if (test::contentOf("/sys/kernel/mm/transparent_hugepage/enabled").find("[always]") != std::string::npos)
    GTEST_SKIP() << "the kernel gives whole huge pages unasked: what a thread takes is not told";
  const TemporaryFolder folder;
  test::makeClip(folder / "film.mov", {{.codec = "rawvideo", .pix_fmt = "rgb24", .frames = 2}});
  std::string bytes = test::contentOf(folder / "film.mov");
  bytes.replace(placeOf(bytes, "stsz").first + 16, 4, bigEndian(10'000'000));
  bytes.replace(placeOf(bytes, "stsc").first + 20, 4, bigEndian(10'000'000));
  bytes.replace(bytes.find("edts"), 4, "skip");  // which would leave two pictures in the end
  const auto [track, track_bytes] = placeOf(bytes, "trak");
  const auto [header, header_bytes] = placeOf(bytes, "moov");
  const std::string more = repeated(bytes.substr(track, track_bytes), 5);
  bytes.insert(header + header_bytes, more);
  bytes.replace(header, 4, bigEndian(header_bytes + more.size()));
  writeFile(folder / "film.mov", bytes);
  test::makeClip(folder / "good.mp4", {kH264});
  const test::HttpServer server(folder / "");
  const Error error = openErrorOf(server.url("film.mov"));
  EXPECT_EQ(error.code, ErrorCode::Exhausted) << error.message;
  EXPECT_THAT(error.message, HasSubstr("over 800 MB of memory"));
  const auto good = makeFfmpegSource();
  ASSERT_TRUE(good->open(server.url("good.mp4")));
  EXPECT_EQ(readAll(*good).size(), 48u);
}

TEST(Mp4Film, SamplesOfAllTracksAndTheirEditsCountTogether) {
  EXPECT_THAT(exceeded(film(pictures(4'000'000) + pictures(4'000'000))), IsNull());
  EXPECT_THAT(exceeded(film(pictures(4'000'000) + pictures(4'000'001))), StrEq(ffmpeg::kTooManyMp4Samples));
  const auto edits = [](std::size_t count) {
    return box("edts", table("elst", {count}, repeated(bigEndian(1) + bigEndian(0) + bigEndian(0x10000), count)));
  };
  EXPECT_THAT(exceeded(film(pictures(7'000'000, edits(2)))), IsNull()) << "the first waits for the other track";
  EXPECT_THAT(exceeded(film(pictures(100'000, edits(81)))), IsNull());
  EXPECT_THAT(exceeded(film(pictures(100'000, edits(82)))), StrEq(ffmpeg::kTooManyMp4Samples));
}

TEST(Mp4Film, SoundThatIsNotCodedCountsByThePiecesThatFFmpegTakes) {
  const auto sound = [](std::uint64_t chunks, std::uint64_t samples, const std::string& more = "") {
    const std::uint64_t all = std::min(chunks * samples, std::uint64_t{0xFFFFFFFF});
    return track("soun",
                 table("stts", {1, all, 1}) + table("stsz", {4, all}) + table("stsc", {1, 1, samples, 1}) +
                     table("stco", {chunks}, std::string(4 * chunks, '\1')),
                 more);
  };
  EXPECT_THAT(exceeded(film(sound(36'000, 48'000))), IsNull()) << "ten hours";
  EXPECT_THAT(exceeded(film(sound(100, 2'000'000'000))), StrEq(ffmpeg::kTooManyMp4Samples));
  const std::string picture = table("hdlr", {0}, "vide" + std::string(13, '\0'));
  EXPECT_THAT(exceeded(film(sound(36'000, 48'000, picture))), StrEq(ffmpeg::kTooManyMp4Samples));
}

// FFmpeg writes each chunk with the pictures of its time.
std::string soundIn(const std::string& kinds, std::uint64_t seconds, std::uint64_t chunk = 2000) {
  const std::uint64_t chunks = 48'000 * seconds / chunk;
  return track("soun", table("stsd", {1}, kinds) + table("stts", {1, 48'000 * seconds, 1}) +
                           table("stsz", {6, 48'000 * seconds}) + table("stsc", {1, 1, chunk, 1}) +
                           table("stco", {chunks}, std::string(4 * chunks, '\1')));
}
// An entry of the list of sound, with the samples in a packet.
std::string soundEntry(const std::string& type, int version, std::uint64_t samples) {
  const std::string begin = std::string(8, '\0') + bigEndian(static_cast<std::uint64_t>(version), 2);
  if (version < 2) return box(type, begin + std::string(18, '\0') + bigEndian(samples) + std::string(12, '\0'));
  return box(type, begin + std::string(50, '\0') + bigEndian(samples));
}

// FFmpeg writes 24 bits so; eight tracks of an hour took ffprobe 82 MB.
TEST(Mp4Film, SoundInPacketsOfASampleCountsBy1024) {
  constexpr std::uint64_t kHour = 3600;
  EXPECT_THAT(exceeded(film(repeated(soundIn(soundEntry("in24", 1, 1), kHour), 8))), IsNull());
  EXPECT_THAT(exceeded(film(repeated(soundIn(soundEntry("lpcm", 2, 1), kHour), 8))), IsNull());
  EXPECT_THAT(exceeded(film(repeated(soundIn(soundEntry("ima4", 1, 64), kHour), 8))), IsNull());
  const std::uint64_t tens = 10 * kHour;  // of 160 samples: 10.8 million
  EXPECT_THAT(exceeded(film(soundIn(soundEntry("lpcm", 1, 160), tens))), StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(film(soundIn(soundEntry("lpcm", 2, 160), tens))), StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(film(soundIn(soundEntry("agsm", 0, 0), tens))), StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(film(soundIn(soundEntry("lpcm", 2, 161), 7 * kHour))), IsNull());
}

// Edits of `seconds` that follow each other, in a film of 1000 ticks a second.
std::string shown(std::size_t edits, std::uint64_t seconds, std::uint64_t ticks) {
  std::string rows;
  for (std::uint64_t i = 0; i < edits; ++i)
    rows += bigEndian(1000 * seconds) + bigEndian(i * seconds * ticks) + bigEndian(0x10000);
  return box("edts", table("elst", {edits}, rows));
}
std::string ticksOf(const char* type, std::uint64_t ticks) {
  return table(type, {0, 0, ticks, 0});
}
// An hour of 60 pictures a second, 600 ticks, in `edits` edits.
std::string edited(std::size_t edits, const std::string& tables, std::uint64_t ticks = 600) {
  constexpr std::uint64_t kPictures = 216'000;
  return film(ticksOf("mvhd", 1000) + track("vide", table("stsz", {0, kPictures}) + tables,
                                            shown(edits, 3600 / edits, ticks) + box("mdia", ticksOf("mdhd", 600))));
}

// 40 edits of one and a half minutes: ffprobe reads 216,000 packets.
TEST(Mp4Film, EditsCountByWhatTheyShow) {
  const std::string times = table("stts", {1, 216'000, 10});
  EXPECT_THAT(exceeded(edited(40, times)), IsNull()) << "each picture is a key frame";
  std::string second;
  for (std::uint64_t i = 0; i < 3600; ++i) second += bigEndian(1 + 60 * i);
  const std::string keys = table("stss", {3600}, second);
  EXPECT_THAT(exceeded(edited(40, times + keys + table("ctts", {1, 216'000, 20}))), IsNull());
  EXPECT_THAT(exceeded(edited(36, times + table("stss", {1, 1}))), IsNull()) << "all of 36 times";
  EXPECT_THAT(exceeded(edited(40, times + table("stss", {1, 1}))), StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(edited(40, times + table("stss", {0}))), StrEq(ffmpeg::kTooManyMp4Samples)) << "no key frame";
  const std::string dense = table("stts", {2, 215'999, 0, 1, 2'159'990});
  EXPECT_THAT(exceeded(edited(40, times, 0)), IsNull()) << "all show the first 90 seconds";
  EXPECT_THAT(exceeded(edited(40, dense, 0)), StrEq(ffmpeg::kTooManyMp4Samples)) << "in which all pictures are";
  EXPECT_THAT(exceeded(edited(90, times + keys)), IsNull());
  EXPECT_THAT(exceeded(edited(90, times + keys + table("ctts", {2, 1, 0, 1, 0x7FFFFFFF}))),
              StrEq(ffmpeg::kTooManyMp4Samples))
      << "each begins with the first picture";
}

TEST(Mp4Film, EditsOfSoundCountByWhatTheyShow) {
  const std::string sound = soundIn(soundEntry("in24", 1, 1), 36'000);  // 1.7 million pieces
  const auto with = [&](std::uint64_t seconds) {
    return film(ticksOf("mvhd", 1000) +
                box("trak", sound.substr(8) + shown(40, seconds, 48'000) + box("mdia", ticksOf("mdhd", 48'000))));
  };
  EXPECT_THAT(exceeded(with(900)), IsNull());
  EXPECT_THAT(exceeded(with(36'000)), StrEq(ffmpeg::kTooManyMp4Samples));
}

TEST(Mp4Film, FragmentsTracksAndTagsAreBoundedToo) {
  const std::string run = box("moof", box("traf", table("tfhd", {1}) + table("trun", {4'000'001})));
  EXPECT_THAT(exceeded(film("", run)), IsNull());
  EXPECT_THAT(exceeded(film("", run + box("mdat") + run)), StrEq(ffmpeg::kTooManyMp4Samples));
  const std::string places = table("sidx", {1, 1000, 0, 0, 60'000});
  EXPECT_THAT(exceeded(film("", repeated(places, 3))), IsNull());
  EXPECT_THAT(exceeded(film("", repeated(places, 4))), StrEq(ffmpeg::kTooManyMp4Boxes));
  EXPECT_THAT(exceeded(film(repeated(pictures(1), 1000))), IsNull());
  EXPECT_THAT(exceeded(film(repeated(pictures(1), 1001))), StrEq(ffmpeg::kTooManyMp4Boxes));
  const auto tags = [](std::size_t count) {
    return box("udta", table("meta", {}, table("hdlr", {0}, "mdir") + box("ilst", repeated(box("\xA9nam"), count))));
  };
  EXPECT_THAT(exceeded(film(tags(4990))), IsNull());
  // QuickTime's have their names in a list of their own.
  const auto named = [](std::size_t count, std::size_t said) {
    const std::string names = table("keys", {said}, repeated(box("mdta", "name"), count));
    return box("meta", table("hdlr", {0}, "mdta") + names + box("ilst", repeated(box(bigEndian(1)), count)));
  };
  EXPECT_THAT(exceeded(film(named(4990, 4990))), IsNull());
  EXPECT_THAT(exceeded(film(named(5001, 5001))), StrEq(ffmpeg::kTooManyMp4Tags));
  EXPECT_THAT(exceeded(film(table("keys", {5001}, std::string(8 * 5001, ' ')))), StrEq(ffmpeg::kTooManyMp4Tags));
  const std::string endless = bigEndian(1) + "keys" + bigEndian(std::uint64_t{1} << 40, 8) + bigEndian(0);
  EXPECT_THAT(exceeded(film("", box("free") + endless + bigEndian(0x80000000))), StrEq(ffmpeg::kTooManyMp4Tags));
  EXPECT_THAT(exceeded(film(tags(5001))), StrEq(ffmpeg::kTooManyMp4Tags));
  EXPECT_THAT(exceeded(film(repeated(box("free"), 100'001))), StrEq(ffmpeg::kTooManyMp4Boxes));
}

TEST(Mp4Film, NothingHidesInOtherHeaders) {
  const std::string many = pictures(9'000'000), header = table("mvhd", {0}) + many;
  EXPECT_THAT(exceeded(box("ftyp", "isom") + box("free", header)), StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(box("ftyp", "isom") + repeated(box("moof"), 100) + box("moov", many)),
              StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(bigEndian(1) + "mdat" + bigEndian(16, 8) + box("moov", many)),
              StrEq(ffmpeg::kTooManyMp4Samples));
  const auto packedBox = [](const std::string& content, std::uint64_t length) {
    std::string stream(2 * content.size() + 100, '\0');
    uLongf bytes = stream.size();
    ::compress(reinterpret_cast<Bytef*>(stream.data()), &bytes, reinterpret_cast<const Bytef*>(content.data()),
               content.size());
    stream.resize(bytes);
    return box("cmov", box("dcom", "zlib") + box("cmvd", bigEndian(length) + stream));
  };
  const auto packed = [&](const std::string& content, std::uint64_t length) {
    return film(packedBox(content, length));
  };
  EXPECT_THAT(exceeded(packed(pictures(100), pictures(100).size())), IsNull());
  EXPECT_THAT(exceeded(packed(many, many.size())), StrEq(ffmpeg::kTooManyMp4Samples));
  EXPECT_THAT(exceeded(packed(many, 4'000'000'000)), StrEq(ffmpeg::kTooLongMp4Header));
  // 1000 of them, 16 KB each, were unpacked for half a minute.
  const std::string once = packedBox(pictures(100), pictures(100).size());
  EXPECT_THAT(exceeded(film(once)), IsNull());
  EXPECT_THAT(exceeded(film(once + once)), StrEq(ffmpeg::kTooLongMp4Header));
  EXPECT_THAT(exceeded(film(once) + box("moov", once)), StrEq(ffmpeg::kTooLongMp4Header));
  EXPECT_THAT(exceeded(packed(once, once.size())), StrEq(ffmpeg::kTooLongMp4Header)) << "one in another";
  EXPECT_THAT(exceeded(film(box("trak", box("mdia", once)))), StrEq(ffmpeg::kTooLongMp4Header)) << "that of a track";
}

TEST(Mp4Film, OtherFilesAreLeftAsTheyAre) {
  const std::string few = bigEndian(8) + std::string("\1\2\3\4", 4);
  EXPECT_THAT(exceeded(repeated(few, 100'001)), IsNull());
  EXPECT_THAT(exceeded(std::string(100, '\0')), IsNull());
  EXPECT_THAT(exceeded(""), IsNull());
  const std::string part = box("moof", box("traf", table("tfhd", {1}) + table("trun", {100'000})));
  EXPECT_THAT(exceeded(box("styp", "msdh") + repeated(part + box("mdat"), 1000)), IsNull())
      << "its header is elsewhere";
}

}  // namespace
}  // namespace relievo
