// SPDX-License-Identifier: Apache-2.0
// Means down, then across, then colours: each a loop over a row that the compiler can make vectors of.
#include "app/render/gl/seen_color.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace relievo {
namespace {

constexpr std::array kFactors{16, 12, 8, 6, 4, 3, 2};
constexpr int kValueBits = 6, kWeightBits = 13;  // a product's upper half has kProductBits fractional bits
constexpr int kProductBits = kValueBits + kWeightBits - 16;

int samplesAlong(int samples, int shift) noexcept {
  return (samples + (1 << shift) - 1) >> shift;
}

inline std::int16_t upperHalf(std::int16_t a, std::int16_t b) noexcept {
  return static_cast<std::int16_t>((a * b) >> 16);
}

// From sums of bytes with `weight` in all, at most 128, to codes x 64.
void toValues(const std::vector<std::uint16_t>& sums, int weight, std::int16_t* values) noexcept {
  const int shift = std::bit_width(257U / static_cast<unsigned>(weight)) - 1;  // a sum still fits into 16 bits
  const auto factor = static_cast<std::uint16_t>((65536 << kValueBits) / (weight << shift));
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const auto wide = static_cast<std::uint16_t>(sums[i] << shift);
    values[i] = static_cast<std::int16_t>((static_cast<std::uint32_t>(wide) * factor) >> 16);
  }
}

void halve(std::vector<std::int16_t>& values) noexcept {
  const std::size_t count = values.size() / 2;
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<std::int16_t>((values[2 * i] + values[2 * i + 1]) >> 1);
  }
  values.resize(count);
}

void third(std::vector<std::int16_t>& values) noexcept {
  constexpr int kThird = 21846;  // of 2^16
  const std::size_t count = values.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const int sum = values[3 * i] + values[3 * i + 1] + values[3 * i + 2];
    values[i] = static_cast<std::int16_t>((sum * kThird) >> 16);
  }
  values.resize(count);
}

// Two samples for each, a quarter of the pitch beside its middle.
void twice(const std::vector<std::int16_t>& values, std::vector<std::int16_t>& out) {
  const std::size_t count = values.size();
  out.resize(2 * count);
  const auto between = [](int near, int other) { return static_cast<std::int16_t>((3 * near + other) >> 2); };
  for (std::size_t i = 1; i + 1 < count; ++i) {
    out[2 * i] = between(values[i], values[i - 1]);
    out[2 * i + 1] = between(values[i], values[i + 1]);
  }
  const std::size_t last = count - 1;
  out[0] = values[0];
  out[1] = between(values[0], values[std::min<std::size_t>(1, last)]);
  out[2 * last] = between(values[last], values[last > 0 ? last - 1 : 0]);
  out[2 * last + 1] = values[last];
}

struct Weights {
  std::array<std::array<std::int16_t, 3>, 3> of;  // by colour and component
  std::array<std::int16_t, 3> bias;
};

Weights weightsOf(const glm::mat3& to_rgb, const glm::vec3& bias) noexcept {
  Weights result{};
  for (int k = 0; k < 3; ++k) {
    const auto colour = static_cast<std::size_t>(k);
    for (int i = 0; i < 3; ++i) {
      result.of[colour][static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(std::lround(to_rgb[i][k] * (1 << kWeightBits)));
    }
    // Each of three products loses half a unit on average; half a code rounds.
    const float rounding = 1.5F + static_cast<float>(1 << (kProductBits - 1));
    result.bias[colour] = static_cast<std::int16_t>(std::lround(bias[k] * 255 * (1 << kProductBits) + rounding));
  }
  return result;
}

void writeColors(const std::array<std::vector<std::int16_t>, 3>& rows, const Weights& weights, std::size_t count,
                 std::uint8_t* out) noexcept {
  const std::int16_t *first = rows[0].data(), *second = rows[1].data(), *third = rows[2].data();
  const auto colour = [&](std::size_t k, std::size_t i) {
    const auto& of = weights.of[k];
    const auto sum = static_cast<std::int16_t>(upperHalf(first[i], of[0]) + upperHalf(second[i], of[1]) +
                                               upperHalf(third[i], of[2]) + weights.bias[k]);
    const auto code = static_cast<std::int16_t>(sum >> kProductBits);
    return static_cast<std::uint8_t>(std::clamp<std::int16_t>(code, 0, 255));
  };
  for (std::size_t i = 0; i < count; ++i) {
    out[4 * i] = colour(0, i);
    out[4 * i + 1] = colour(1, i);
    out[4 * i + 2] = colour(2, i);
    out[4 * i + 3] = 255;
  }
}

}  // namespace

int SeenColor::factorFor(int samples, int shown) noexcept {
  const auto* found = std::ranges::find_if(kFactors, [&](int factor) { return samples / factor >= shown; });
  return found == kFactors.end() ? 1 : *found;
}

void SeenColor::make(const Frame& frame, glm::ivec2 samples, const glm::mat3& to_rgb, const glm::vec3& bias) {
  width_ = frame.width / samples.x;
  height_ = frame.height / samples.y;
  const auto count = static_cast<std::size_t>(width_);
  rgba_.resize(4 * count * static_cast<std::size_t>(height_));
  const Weights weights = weightsOf(to_rgb, bias);
  const std::size_t components = frame.model == ColorModel::Gray ? 1 : 3;
  for (Values& unused : rows_) unused.assign(count, 0);
  for (int row = 0; row < height_; ++row) {
    for (std::size_t i = 0; i < components; ++i) makeRow(frame, i, row, samples, rows_[i]);
    writeColors(rows_, weights, count, rgba_.data() + 4 * count * static_cast<std::size_t>(row));
  }
}

void SeenColor::makeRow(const Frame& frame, std::size_t component, int row, glm::ivec2 samples, Values& values) {
  int across = component > 0 ? frame.chroma_shift_x : 0;
  const int down = component > 0 ? frame.chroma_shift_y : 0;
  const int count = samplesAlong(frame.width, across);
  sums_.assign(static_cast<std::size_t>(count), 0);
  int weight = samples.y >> down;
  if (weight << down == samples.y) {
    for (int k = 0; k < weight; ++k) addRow(frame, component, row * weight + k, 1);
  } else {
    // Each of the luma's rows lies between two of the chroma's, at a multiple of 1 / whole.
    const int whole = 2 << down, last = samplesAlong(frame.height, down) - 1;
    weight = samples.y * whole;
    for (int k = 0; k < samples.y; ++k) {
      const int place = 2 * (row * samples.y + k) + 1 + whole / 2;  // of the row before the first: 0
      const int above = place / whole - 1, part = place % whole;
      addRow(frame, component, std::max(above, 0), whole - part);
      if (part > 0) addRow(frame, component, std::min(above + 1, last), part);
    }
  }
  values.resize(sums_.size());
  toValues(sums_, weight, values.data());
  int factor = samples.x;
  for (; across > 0; --across) {
    if (factor % 2 == 0) {
      factor /= 2;
    } else {
      twice(values, wider_);
      values.swap(wider_);
    }
  }
  for (; factor % 2 == 0; factor /= 2) halve(values);
  for (; factor % 3 == 0; factor /= 3) third(values);
}

void SeenColor::addRow(const Frame& frame, std::size_t component, int row, int weight) {
  const std::uint8_t* bytes = bytesOf(frame, component, row, static_cast<int>(sums_.size()));
  const auto factor = static_cast<std::uint16_t>(weight);
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] = static_cast<std::uint16_t>(sums_[i] + bytes[i] * factor);
}

const std::uint8_t* SeenColor::bytesOf(const Frame& frame, std::size_t component, int row, int count) {
  const Component& what = frame.components[component];
  const Plane& plane = frame.planes[what.plane];
  const std::uint8_t* first = plane.data + row * plane.stride_bytes + what.offset_bytes;
  if (what.bits <= 8 && what.step_bytes == 1) return first;
  bytes_.resize(static_cast<std::size_t>(count));
  const std::ptrdiff_t step = what.step_bytes;
  if (what.bits <= 8) {
    for (std::ptrdiff_t i = 0; i < count; ++i) bytes_[static_cast<std::size_t>(i)] = first[i * step];
    return bytes_.data();
  }
  const int narrowing = what.shift + what.bits - 8;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const std::uint8_t* sample = first + i * step;
    const unsigned word = sample[0] | static_cast<unsigned>(sample[1]) << 8;
    bytes_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(word >> narrowing);
  }
  return bytes_.data();
}

}  // namespace relievo
