// SPDX-License-Identifier: Apache-2.0
// Reads PFM, the portable float map.
#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <string_view>

#include "drivers/floats/floats.h"
#include "platform/text/number_in.h"

namespace relievo {
namespace {

constexpr std::size_t kLongestHeader = 512;

// The next word of the header, and the byte after it; comments begin with #.
std::string_view nextWord(std::string_view& text) noexcept {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  for (;;) {
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    if (text.empty() || text.front() != '#') break;
    text.remove_prefix(std::min(text.find('\n'), text.size()));
  }
  const auto end = std::find_if(text.begin(), text.end(), blank);
  const std::string_view word = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(word.size());
  return word;
}

std::optional<FilePicture> readPfm(std::span<const std::uint8_t> file) {
  const auto* const begin = reinterpret_cast<const char*>(file.data());
  std::string_view rest(begin, std::min(file.size(), kLongestHeader));
  const std::string_view magic = nextWord(rest);
  if (magic != "Pf" && magic != "PF") return std::nullopt;
  const auto width = numberIn<std::uint32_t>(nextWord(rest)), height = numberIn<std::uint32_t>(nextWord(rest));
  const auto scale = numberIn<double>(nextWord(rest));  // its sign is the byte order
  if (!width || !height || !scale || *scale == 0 || !isSoundSize(*width, *height) || rest.empty()) return std::nullopt;

  FilePicture picture{.width = static_cast<int>(*width), .height = static_cast<int>(*height)};
  picture.components = magic == "PF" ? 3 : 1;
  const std::size_t row = std::size_t{*width} * static_cast<std::size_t>(picture.components);
  const std::span samples = file.subspan(static_cast<std::size_t>(rest.data() + 1 - begin));
  if (samples.size() < row * *height * sizeof(float)) return std::nullopt;
  picture.samples.resize(row * *height);
  for (std::size_t r = 0; r < *height; ++r) {
    std::memcpy(&picture.samples[row * (*height - 1 - r)], &samples[row * r * sizeof(float)], row * sizeof(float));
  }
  if (*scale > 0) {  // high bytes first
    for (float& sample : picture.samples) {
      sample = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(sample)));
    }
  }
  return picture;
}

}  // namespace

const PictureFormat kPfm{"pfm", readPfm};

}  // namespace relievo
