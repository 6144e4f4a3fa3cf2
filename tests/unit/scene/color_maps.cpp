// SPDX-License-Identifier: Apache-2.0
// Entries of colour maps, and colours that are none.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "app/scene/height_field.h"
#include "tests/unit/scene/hue_frames.h"

namespace relievo {
namespace {

using test::Rgb;

constexpr DisplayVolume kBox{160, 108, 255};  // a height is an entry

// Entries 7, 88, 163 and 232 of 256, as matplotlib 3.6 prints them; none is a knot of the curve.
struct Map {
  DepthCode code;
  std::array<Rgb, 4> entries;
};
const Map kMaps[] = {
    {DepthCode::Turbo, {{{56, 39, 109}, {31, 233, 175}, {242, 201, 58}, {190, 33, 2}}}},
    {DepthCode::Inferno, {{{3, 2, 16}, {125, 30, 109}, {231, 94, 46}, {245, 219, 76}}}},
    {DepthCode::Magma, {{{3, 3, 15}, {118, 33, 129}, {234, 86, 97}, {254, 211, 149}}}},
    {DepthCode::Viridis, {{{70, 11, 94}, {47, 107, 142}, {44, 177, 126}, {194, 223, 35}}}},
    {DepthCode::Plasma, {{{32, 6, 143}, {160, 26, 156}, {232, 112, 89}, {252, 210, 37}}}},
    {DepthCode::Rainbow, {{{114, 22, 255}, {48, 225, 218}, {198, 231, 137}, {255, 71, 36}}}},
    {DepthCode::Spectral, {{{82, 95, 169}, {198, 232, 159}, {254, 204, 123}, {208, 56, 78}}}},
    // Between ColorBrewer's nine colours, worked out.
    {DepthCode::YlGnBu, {{{251, 253, 208}, {144, 212, 185}, {30, 139, 189}, {29, 46, 131}}}},
    // Jet, worked out from red min(4x - 3/2, 9/2 - 4x), green min(4x - 1/2, 7/2 - 4x), blue min(4x + 1/2, 5/2 - 4x).
    {DepthCode::Jet, {{{0, 0, 155.5}, {0, 224.5, 255}, {255, 240.5, 0}, {219.5, 0, 0}}}},
    // The sum of the three is three times the entry.
    {DepthCode::Kinect, {{{0, 0, 21}, {0, 9, 255}, {0, 234, 255}, {186, 255, 255}}}},
};

Frame rgbRow(const std::vector<Rgb>& colors) {
  auto bytes = std::make_shared<std::vector<std::uint8_t>>();
  for (const Rgb& color : colors) {
    for (const double part : color) bytes->push_back(static_cast<std::uint8_t>(std::lround(part)));
  }
  Frame frame;
  frame.width = static_cast<int>(colors.size());
  frame.height = 1;
  frame.model = ColorModel::Rgb;
  frame.planes[0] = {bytes->data(), static_cast<std::ptrdiff_t>(bytes->size())};
  for (std::uint8_t i = 0; i < 3; ++i) frame.components[i] = {.offset_bytes = i, .step_bytes = 3};
  frame.owner = bytes;
  return frame;
}

TEST(ColorMaps, AnEntryIsReadToLessThanACode) {
  constexpr double kEntries[] = {7, 88, 163, 232};
  for (const Map& map : kMaps) {
    const Frame frame = rgbRow({map.entries.begin(), map.entries.end()});
    const auto field = HeightField::make(frame, {.code = map.code}, kBox).value();
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(field.heightMm(i, 0), kEntries[i], 0.75) << name(map.code);
    }
  }
}

TEST(ColorMaps, AColourFarOffTheMapIsAHole) {
  const Frame frame = rgbRow({{255, 255, 255}, {128, 128, 128}, {0, 255, 0}});
  const auto field = HeightField::make(frame, {.code = DepthCode::Inferno}, kBox).value();
  for (const int c : {1, 2}) EXPECT_TRUE(std::isnan(field.heightMm(c, 0))) << c;
}

}  // namespace
}  // namespace relievo
