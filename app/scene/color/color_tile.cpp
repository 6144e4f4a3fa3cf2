// SPDX-License-Identifier: Apache-2.0
// Reads eight cells of 2 x 2 samples side by side, by vector extensions that GCC and clang share.
#include "app/scene/color/color_tile.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace relievo {
namespace {

using Bytes = std::uint8_t __attribute__((vector_size(16)));
using Eight = std::uint16_t __attribute__((vector_size(16)));
using Signed = std::int16_t __attribute__((vector_size(16)));
using Four = std::uint32_t __attribute__((vector_size(16)));

template <class To>
To load(const std::uint8_t* from) RELIEVO_RT {
  To to;
  std::memcpy(&to, from, sizeof to);
  return to;
}
Eight lower(const Eight& a, const Eight& b) RELIEVO_RT {
  return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11);
}
Eight upper(const Eight& a, const Eight& b) RELIEVO_RT {
  return __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15);
}
Four lowerPairs(const Eight& a, const Eight& b) RELIEVO_RT {
  return __builtin_shufflevector(std::bit_cast<Four>(a), std::bit_cast<Four>(b), 0, 4, 1, 5);
}
Four upperPairs(const Eight& a, const Eight& b) RELIEVO_RT {
  return __builtin_shufflevector(std::bit_cast<Four>(a), std::bit_cast<Four>(b), 2, 6, 3, 7);
}
// Eight codes of one or two bytes, `step_bytes` apart: as many as one code has, or twice as many.
template <bool kWords>
Eight eightCodes(const std::uint8_t* from, int step_bytes) RELIEVO_RT {
  if constexpr (kWords) {
    const auto codes = load<Eight>(from);
    if (step_bytes == 2) return codes;
    return __builtin_shufflevector(codes, load<Eight>(from + 16), 0, 2, 4, 6, 8, 10, 12, 14);
  } else {
    if (step_bytes == 2) return load<Eight>(from) & 0xff;
    const Bytes codes = std::bit_cast<Bytes>(Four{load<std::uint32_t>(from), load<std::uint32_t>(from + 4)});
    return std::bit_cast<Eight>(
        __builtin_shufflevector(codes, Bytes{}, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
  }
}

// Of each of eight cells: which of its columns count, and how many.
struct Columns {
  Eight first, second, count;

  explicit Columns(const ColorTile& tile) RELIEVO_RT {
    constexpr Signed kFirst{0, 2, 4, 6, 8, 10, 12, 14};
    const auto left = static_cast<std::int16_t>(tile.left - tile.begin),
               right = static_cast<std::int16_t>(tile.right - tile.begin);
    first = std::bit_cast<Eight>((kFirst >= left) & (kFirst < right));
    second = std::bit_cast<Eight>((kFirst + 1 >= left) & (kFirst + 1 < right));
    count = (first & 1) + (second & 1);
  }
};

// Of eight cells, the places in a ColorTable. `to_four` times the sum of a code is four times its mean.
void storePlaces(const std::array<Eight, 3>& sums, const Eight& to_four, std::uint32_t* places) RELIEVO_RT {
  const auto place = [&](std::size_t i) RELIEVO_RT { return sums[i] * to_four >> 4; };  // of ten bits, six
  const Eight first = place(0), low = first << 12 | place(1) << 6 | place(2), high = first >> 4;
  const std::array<Eight, 2> all{lower(low, high), upper(low, high)};
  std::memcpy(places, all.data(), sizeof all);
}

// Of each of eight cells, ColorTile::Sums.
std::array<std::uint64_t, 8> sumsOf(const std::array<Eight, 3>& sums, const Eight& samples) RELIEVO_RT {
  const Eight a = lower(sums[0], sums[1]), b = upper(sums[0], sums[1]), c = lower(sums[2], samples),
              d = upper(sums[2], samples);
  return std::bit_cast<std::array<std::uint64_t, 8>>(
      std::array<Four, 4>{lowerPairs(a, c), upperPairs(a, c), lowerPairs(b, d), upperPairs(b, d)});
}

// By piece: a shift by a number that is not known takes four instructions.
constexpr auto kBits = [] {
  std::array<std::uint64_t, 64> bits{};
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = std::uint64_t{1} << i;
  return bits;
}();

}  // namespace

// Chroma is as large as luma, or half as wide and high; then it counts once for each sample over it.
template <bool kWords, bool kHalved>
void ColorSamples::readSideBySide(const ColorTable& table, ColorTile& tile) const RELIEVO_RT {
  const Columns columns(tile);
  const Eight one = columns.count, two = one + one, to_four = 3 - one, to_two = to_four + to_four;
  const int count = tile.cells(), kept = std::min<int>(bits_, 10);  // of more bits, the upper ten are read
  const auto cleared = [&](const Eight& codes, const Part& part) RELIEVO_RT {
    if constexpr (!kWords) return codes;
    return (codes >> part.shift & static_cast<std::uint16_t>(mask_)) >> (bits_ - kept);
  };
  // Where the tile's rows begin in each component.
  const auto beginOf = [&](std::size_t i) RELIEVO_RT {
    const bool halved = kHalved && i > 0;
    const std::ptrdiff_t first = halved ? tile.begin >> 1 : tile.begin, row = halved ? tile.top >> 1 : tile.top;
    return parts_[i].data + row * parts_[i].stride_bytes + first * parts_[i].step_bytes;
  };
  const auto inRow = [&](const Part& part, const std::uint8_t* from) RELIEVO_RT {
    constexpr int kCode = kWords ? 2 : 1;
    return (cleared(eightCodes<kWords>(from, 2 * kCode), part) & columns.first) +
           (cleared(eightCodes<kWords>(from + kCode, 2 * kCode), part) & columns.second);
  };
  const auto lumaOf = [&](const Part& part, const std::uint8_t* from, bool both) RELIEVO_RT {
    const Eight sum = inRow(part, from);
    return both ? sum + inRow(part, from + part.stride_bytes) : sum;
  };
  const auto chromaOf = [&](const Part& part, const std::uint8_t* from, bool both) RELIEVO_RT {
    if constexpr (!kHalved) return lumaOf(part, from, both);
    return cleared(eightCodes<kWords>(from, part.step_bytes), part) * (both ? two : one);
  };
  const auto inEightBits = [&](const Eight& sum) RELIEVO_RT { return kWords ? sum >> (kept - 8) : sum; };
  const std::uint8_t* const pieces = table.piecesOfMeans();
  const Part luma = parts_[0], second = parts_[1], third = parts_[2];
  const std::uint8_t *const of_luma = beginOf(0), *const of_second = beginOf(1), *const of_third = beginOf(2);
  std::uint64_t used = 0;
  for (int row = 0, rows = 0; row < tile.rows; row += rows) {
    rows = tile.rowsFrom(row);
    const bool both = rows == 2;
    const std::ptrdiff_t down = row * tile.step,
                         down_chroma = kHalved ? (tile.rowAt(row) >> 1) - (tile.top >> 1) : down;
    const std::array<Eight, 3> sums{inEightBits(lumaOf(luma, of_luma + down * luma.stride_bytes, both)),
                                    inEightBits(chromaOf(second, of_second + down_chroma * second.stride_bytes, both)),
                                    inEightBits(chromaOf(third, of_third + down_chroma * third.stride_bytes, both))};
    std::uint32_t* const places = tile.places[static_cast<std::size_t>(row)].data();
    storePlaces(sums, both ? to_four : to_two, places);
    const auto of_cells = sumsOf(sums, both ? two : one);
    for (int k = 0; k < count; ++k) {
      const std::uint8_t piece = pieces[places[k]];
      tile.sums[piece] += of_cells[static_cast<std::size_t>(k)];
      used |= kBits[piece];
    }
  }
  tile.used = used;
}

// For other formats, and at the picture's right edge, beyond which nothing may be read.
void ColorSamples::readOneByOne(const ColorTable& table, ColorTile& tile) const RELIEVO_RT {
  for (int row = 0, rows = 0; row < tile.rows; row += rows) {
    rows = tile.rowsFrom(row);
    for (int k = 0; k < tile.cells(); ++k) {
      const int begin = tile.leftOf(k), end = tile.rightOf(k);
      std::array<std::uint32_t, 3> sums{};
      for (int r = tile.rowAt(row); r < tile.rowAt(row) + rows; ++r) {
        const Line line = lineAt(r);
        for (int c = begin; c < end; ++c) {
          for (std::size_t i = 0; i < 3; ++i) sums[i] += codeAt(i, i == 0 ? c : c >> shift_x_, line);
        }
      }
      const auto samples = static_cast<std::uint32_t>(rows * (end - begin));
      const auto inEightBits = [&](std::uint32_t sum) { return static_cast<std::uint16_t>(sum >> (bits_ - 8)); };
      std::uint32_t& place = tile.places[static_cast<std::size_t>(row)][static_cast<std::size_t>(k)];
      place = ColorTable::placeOf(sums[0] / samples, sums[1] / samples, sums[2] / samples, bits_);
      const std::uint8_t piece = table.piecesOfMeans()[place];
      tile.used |= kBits[piece];
      tile.sums[piece] += std::bit_cast<std::uint64_t>(ColorTile::Sums{
          inEightBits(sums[0]), inEightBits(sums[1]), inEightBits(sums[2]), static_cast<std::uint16_t>(samples)});
    }
  }
}

void ColorSamples::readTile(const ColorTable& table, int cols, ColorTile& tile) const RELIEVO_RT {
  std::fill_n(tile.sums.begin(), table.pieceCount() + 1, 0);
  tile.used = 0;
  constexpr int kReach = 18;  // columns that eight cells reach, with the second bytes of interleaved chroma
  if (!side_by_side_ || tile.begin + kReach > cols) return readOneByOne(table, tile);
  if (shift_x_ == 1) return words_ ? readSideBySide<true, true>(table, tile) : readSideBySide<false, true>(table, tile);
  return words_ ? readSideBySide<true, false>(table, tile) : readSideBySide<false, false>(table, tile);
}

}  // namespace relievo
