// SPDX-License-Identifier: Apache-2.0
// OpenEXR pictures: plain ones that are written here byte by byte, tiled and compressed ones by the library.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/film/opened_film.h"

namespace relievo {
namespace {

using test::write;

constexpr int kCols = 40, kRows = 30;

// Metres; 0 means that there is nothing.
double metresAt(int c, int r) {
  return c < 6 && r < 5 ? 0 : 8.0 - 0.2 * r + 0.01 * c;
}
const float kInfinity = std::numeric_limits<float>::infinity();

enum class Type : std::uint32_t { Uint = 0, Half = 1, Float = 2 };

std::string bytes(const void* from, std::size_t count) {
  return {static_cast<const char*>(from), count};
}
std::string number(std::uint32_t value) {
  return bytes(&value, 4);
}
std::string number(float value) {
  return bytes(&value, 4);
}
// IEEE 754 binary16 of numbers that it holds exactly, or nearly.
std::string half(float value) {
  std::uint16_t bits = 0x7c00;
  if (std::isfinite(value) && value < 65520) {
    int exponent = 0;
    const float mantissa = std::frexp(value, &exponent);  // 0.5 to 1
    bits = value == 0 ? std::uint16_t{0}
                      : static_cast<std::uint16_t>((exponent + 14) * 1024 +
                                                   static_cast<int>(std::lround((2 * mantissa - 1) * 1024)));
  }
  return bytes(&bits, 2);
}

struct Channel {
  std::string name;  // in alphabetical order
  Type type = Type::Float;
  std::function<float(int, int)> value;
};
struct Window {
  int left = 0, top = 0, right = kCols - 1, bottom = kRows - 1;
};

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + number(static_cast<std::uint32_t>(value.size())) + value;
}
std::string box(const Window& w) {
  return bytes(&w, sizeof w);
}

// Scanlines without compression ("Technical Introduction to OpenEXR", file layout).
std::string exr(const std::vector<Channel>& channels, const Window& data = {}, const Window& display = {},
                const std::string& more_attributes = "") {
  std::string list;
  for (const Channel& c : channels) {
    list += c.name + '\0' + number(static_cast<std::uint32_t>(c.type)) + std::string(4, '\0') + number(1u) + number(1u);
  }
  std::string file = "\x76\x2f\x31\x01" + number(2u) + more_attributes;
  file += attribute("channels", "chlist", list + '\0') + attribute("compression", "compression", std::string(1, '\0'));
  file += attribute("dataWindow", "box2i", box(data)) + attribute("displayWindow", "box2i", box(display));
  file += attribute("lineOrder", "lineOrder", std::string(1, '\0'));
  file += attribute("pixelAspectRatio", "float", number(1.0F));
  file += attribute("screenWindowCenter", "v2f", number(0.0F) + number(0.0F));
  file += attribute("screenWindowWidth", "float", number(1.0F)) + '\0';
  std::string lines, offsets;
  const std::size_t begin = file.size() + 8 * static_cast<std::size_t>(data.bottom - data.top + 1);
  for (int y = data.top; y <= data.bottom; ++y) {
    const std::uint64_t offset = begin + lines.size();
    offsets += bytes(&offset, 8);
    std::string line;
    for (const Channel& c : channels) {
      for (int x = data.left; x <= data.right; ++x) {
        const float value = c.value(x - display.left, y - display.top);
        line += c.type == Type::Half    ? half(value)
                : c.type == Type::Float ? number(value)
                                        : number(static_cast<std::uint32_t>(value));
      }
    }
    lines += number(static_cast<std::uint32_t>(y)) + number(static_cast<std::uint32_t>(line.size())) + line;
  }
  return file + offsets + lines;
}

// Depth as metresAt says, with holes where it is 0.
void expectDepth(const test::OpenedFilm& film, double tolerance = 0.001) {
  ASSERT_TRUE(film.info.has_depth);
  ASSERT_EQ(film.info.depth_width, kCols);
  ASSERT_EQ(film.info.depth_height, kRows);
  for (int r = 0; r < kRows; r += 2) {
    for (int c = 0; c < kCols; c += 3) {
      const bool hole = std::isnan(film.heightAt(c, r));
      ASSERT_EQ(hole, metresAt(c, r) == 0) << c << ", " << r;
      if (hole) continue;
      ASSERT_NEAR(film.distanceAt(c, r), 1000 * metresAt(c, r), 1000 * tolerance * metresAt(c, r)) << c << ", " << r;
    }
  }
}

std::function<float(int, int)> depthWith(float nothing, float factor = 1) {
  return [=](int c, int r) { return metresAt(c, r) == 0 ? nothing : factor * static_cast<float>(metresAt(c, r)); };
}
float gradient(int c, int) {
  return 0.02F * static_cast<float>(c);
}
float flat(int, int) {
  return 0.25F;
}

TEST(Exr, DepthIsFoundInEveryChannelAndType) {
  const test::TemporaryFolder folder;
  const auto depth = depthWith(1e10F);
  for (const std::vector<Channel>& channels : std::vector<std::vector<Channel>>{
           {{"Z", Type::Float, depth}},
           {{"Z", Type::Half, depthWith(65504)}},
           {{"Z", Type::Uint, depthWith(0, 1000)}},
           {{"depth", Type::Float, depthWith(kInfinity)}},
           {{"ViewLayer.Depth.Z", Type::Float, depth}},
           {{"N.X", Type::Float, flat}, {"Pz", Type::Float, depth}},
           {{"N.X", Type::Float, flat}, {"VRayZDepth", Type::Float, depth}},
           {{"View.Depth.Z", Type::Float, depth},
            {"View.Mist.Z", Type::Float, flat},
            {"View.N.X", Type::Float, flat},
            {"View.N.Z", Type::Float, flat}},
           {{"R", Type::Float, depth}},
           {{"Y", Type::Half, depthWith(kInfinity)}},
           {{"B", Type::Float, depth}, {"G", Type::Float, depth}, {"R", Type::Float, depth}},
           {{"V", Type::Float, depthWith(1e9F)}},
           {{"B", Type::Float, depthWith(0, 0)}, {"G", Type::Float, depthWith(0, 0)}, {"R", Type::Float, depth}},
       }) {
    SCOPED_TRACE(channels.back().name);
    write(folder / "z.exr", exr(channels));
    expectDepth(test::openFilm({.url = folder / "z.exr"}), channels[0].type == Type::Half ? 0.002 : 0.001);
  }
}

TEST(Exr, ADataWindowLiesInTheDisplayWindow) {
  const test::TemporaryFolder folder;
  // The corner of holes is not stored at all; the rest is, with a margin beyond the picture.
  const Window display{100, 50, 100 + kCols - 1, 50 + kRows - 1};
  const auto depth = [](int c, int r) { return c >= kCols || r >= kRows ? 1.0F : depthWith(kInfinity)(c, r); };
  write(folder / "z.exr", exr({{"Z", Type::Float, depth}}, {100, 50, 110 + kCols, 55 + kRows}, display));
  expectDepth(test::openFilm({.url = folder / "z.exr"}));

  write(folder / "part.exr", exr({{"Z", Type::Float, depthWith(7)}}, {106, 55, 119, 69}, display));
  const test::OpenedFilm part = test::openFilm({.url = folder / "part.exr"});
  ASSERT_EQ(part.info.depth_width, kCols);
  EXPECT_TRUE(std::isnan(part.heightAt(5, 5)) && std::isnan(part.heightAt(6, 4)) && std::isnan(part.heightAt(20, 10)));
  EXPECT_NEAR(part.distanceAt(6, 5), 1000 * metresAt(6, 5), 5);
  EXPECT_NEAR(part.distanceAt(19, 19), 1000 * metresAt(19, 19), 5);
}

TEST(Exr, ColoursWithAZBufferAreColourAndDepth) {
  const test::TemporaryFolder folder;
  write(folder / "a.exr", exr({{"B", Type::Half, flat},
                               {"G", Type::Half, flat},
                               {"R", Type::Half, gradient},
                               {"Z", Type::Float, depthWith(1e10F)}}));
  const test::OpenedFilm film = test::openFilm({.url = folder / "a.exr"});
  EXPECT_EQ(film.info.packing, Packing::Tracks);
  expectDepth(film);
  EXPECT_EQ(film.pair.color.model, ColorModel::Rgb);
  // Light of 0.5 and 0.25 on a screen: IEC 61966-2-1.
  EXPECT_NEAR(test::sampleAt(film.pair.color, 0, 25, 3) / 255.0, 0.7354, 0.002);
  EXPECT_NEAR(test::sampleAt(film.pair.color, 2, 25, 3) / 255.0, 0.5371, 0.002);
}

TEST(Exr, ASeriesWithColoursAndAZBufferIsBothToo) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "render");
  for (const char* name : {"render/0001.exr", "render/0002.exr"}) {
    write(folder / name, exr({{"ViewLayer.Combined.B", Type::Half, flat},
                              {"ViewLayer.Combined.G", Type::Half, flat},
                              {"ViewLayer.Combined.R", Type::Half, gradient},
                              {"ViewLayer.Depth.Z", Type::Float, depthWith(1e10F)}}));
  }
  for (const char* name : {"render", "render/%04d.exr"}) {
    const test::OpenedFilm film = test::openFilm({.url = folder / name});
    EXPECT_EQ(film.info.packing, Packing::Tracks);
    expectDepth(film);
    EXPECT_EQ(film.pair.color.model, ColorModel::Rgb);
    EXPECT_NEAR(test::sampleAt(film.pair.color, 0, 25, 3) / 255.0, 0.7354, 0.002);
  }
}

TEST(Exr, TheColourIsOfTheDepthsOwnView) {
  const test::TemporaryFolder folder;
  const auto samplesOf = [](const std::function<float(int, int)>& value) {
    std::vector<float> samples;
    for (int i = 0; i < kCols * kRows; ++i) samples.push_back(value(i % kCols, i / kCols));
    return samples;
  };
  std::vector<float> right = samplesOf(flat), left = samplesOf(gradient), depth = samplesOf(depthWith(1e10F));
  std::vector<Imf::Header> headers;
  for (const std::string part : {"rgb.right", "rgb.left", "depth.left"}) {
    Imf::Header header(kCols, kRows);
    header.setName(part);
    header.setType(Imf::SCANLINEIMAGE);
    header.setView(part.substr(part.find('.') + 1));
    for (const char* const channel : {"R", "G", "B"}) {
      if (part[0] == 'r') header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    }
    if (part[0] == 'd') header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  {
    Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 3);
    for (int i = 0; i < 3; ++i) {
      Imf::FrameBuffer buffer;
      std::vector<float>& samples = i == 0 ? right : i == 1 ? left : depth;
      for (const char* const channel : {"R", "G", "B", "Z"}) {
        if ((*channel == 'Z') != (i == 2)) continue;
        buffer.insert(channel, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float),
                                          sizeof(float) * kCols));
      }
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(buffer);
      part.writePixels(kRows);
    }
  }
  const test::OpenedFilm film = test::openFilm({.url = folder / "a.exr"});
  expectDepth(film);
  EXPECT_GT(test::sampleAt(film.pair.color, 0, 25, 3), 4 * test::sampleAt(film.pair.color, 0, 5, 3)) << "the left one";
}

TEST(Exr, UnrealsWorldDepthIsInCentimetres) {
  const test::TemporaryFolder folder;
  const auto depth = depthWith(65504, 100);
  const std::string layer = "FinalImageMovieRenderQueue_WorldDepth.";
  const std::string layers = exr({{"ActorHitProxyMask00.B", Type::Half, depth},
                                  {"ActorHitProxyMask00.G", Type::Half, depth},
                                  {"ActorHitProxyMask00.R", Type::Half, depth},
                                  {"FinalImageCustomDepth.R", Type::Half, flat},
                                  {"FinalImageMovieRenderQueue_Beauty.B", Type::Half, flat},
                                  {"FinalImageMovieRenderQueue_Beauty.G", Type::Half, flat},
                                  {"FinalImageMovieRenderQueue_Beauty.R", Type::Half, gradient},
                                  {layer + "B", Type::Half, depth},
                                  {layer + "G", Type::Half, depth},
                                  {layer + "R", Type::Half, depth}});
  std::filesystem::create_directory(folder / "render");
  for (const char* name : {"one.exr", "render/0001.exr", "render/0002.exr"}) write(folder / name, layers);
  write(folder / "Shot.WorldDepth.0001.exr",
        exr({{"B", Type::Half, depth}, {"G", Type::Half, depth}, {"R", Type::Half, depth}}));
  for (const char* name : {"one.exr", "render", "Shot.WorldDepth.0001.exr"}) {
    SCOPED_TRACE(name);
    const test::OpenedFilm film = test::openFilm({.url = folder / name});
    expectDepth(film, 0.003);
    if (film.info.packing == Packing::DepthAlone) continue;
    EXPECT_NEAR(test::sampleAt(film.pair.color, 0, 25, 3) / 255.0, 0.7354, 0.002);
  }
}

TEST(Exr, NukesDepthIsInverse) {
  const test::TemporaryFolder folder;
  const auto inverse = [](int c, int r) { return metresAt(c, r) == 0 ? 0 : 1 / static_cast<float>(metresAt(c, r)); };
  const auto film = [&](const std::function<float(int, int)>& depth, const std::string& by) {
    write(folder / "a.exr", exr({{"B", Type::Half, flat},
                                 {"G", Type::Half, flat},
                                 {"R", Type::Half, gradient},
                                 {"depth.Z", Type::Float, depth}},
                                {}, {}, attribute(by, "string", "13.0v1")));
    return test::openFilm({.url = folder / "a.exr"});
  };
  const test::OpenedFilm own = film(inverse, "nuke/version");
  EXPECT_TRUE(std::isnan(own.heightAt(0, 0)));
  EXPECT_NEAR(own.distanceAt(9, 20) / own.distanceAt(30, 2), metresAt(9, 20) / metresAt(30, 2), 0.002);
  expectDepth(film(depthWith(0), "nuke/version"));
  EXPECT_GT(film(inverse, "version").distanceAt(9, 20), film(inverse, "version").distanceAt(30, 2)) << "not Nuke's";
}

TEST(Exr, ColoursAloneAreAPictureWithoutDepth) {
  const test::TemporaryFolder folder;
  write(folder / "a.exr", exr({{"B", Type::Half, flat}, {"G", Type::Half, flat}, {"R", Type::Half, gradient}}));
  const test::OpenedFilm film = test::openFilm({.url = folder / "a.exr"});
  EXPECT_FALSE(film.info.has_depth);
  EXPECT_EQ(film.pair.color.model, ColorModel::Rgb);
}

TEST(Exr, TilesAndCompression) {
  const test::TemporaryFolder folder;
  std::vector<float> samples;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kCols; ++c) samples.push_back(depthWith(1e10F)(c, r));
  }
  Imf::FrameBuffer buffer;
  buffer.insert("Z",
                Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float), sizeof(float) * kCols));
  for (const Imf::Compression compression : {Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION}) {
    SCOPED_TRACE(compression);
    Imf::Header header(kCols, kRows, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, compression);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    {
      Imf::OutputFile file((folder / "lines.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writePixels(kRows);
    }
    expectDepth(test::openFilm({.url = folder / "lines.exr"}));
    header.setTileDescription(Imf::TileDescription(16, 16, Imf::ONE_LEVEL));
    {
      Imf::TiledOutputFile file((folder / "tiles.exr").c_str(), header);
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    }
    expectDepth(test::openFilm({.url = folder / "tiles.exr"}));
  }
}

TEST(Exr, DamagedFilesAreNoPictures) {
  const test::TemporaryFolder folder;
  const std::string whole = exr({{"Z", Type::Float, depthWith(1e10F)}});
  for (const std::size_t length : {4ul, 40ul, 200ul, whole.size() / 2}) {
    write(folder / "z.exr", whole.substr(0, length));
    PairReader reader({.make_source = [](const std::string& url) { return drivers::makeMediaSource(url); },
                       .make_decoder = [](const StreamInfo& s) { return drivers::makeSoftwareDecoder(s); },
                       .read_text = {}});
    EXPECT_FALSE(reader.open({.url = folder / "z.exr"})) << length;
  }
}

}  // namespace
}  // namespace relievo
