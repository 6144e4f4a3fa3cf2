// SPDX-License-Identifier: Apache-2.0
// Reads npy: header and numbers.
#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "drivers/floats/floats.h"
#include "drivers/floats/npy_header.h"
#include "drivers/floats/number.h"

namespace relievo {
namespace npy {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kFixedPart = 8;  // magic, version; then the header's length

std::string_view textOf(std::span<const std::uint8_t> bytes) noexcept {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Of a header whose first kFixedPart + 4 bytes are there: where its dictionary begins, and how long it is.
std::pair<std::size_t, std::size_t> placeOfText(std::span<const std::uint8_t> begin) noexcept {
  const std::size_t length_bytes = begin[6] == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) length |= std::size_t{begin[kFixedPart + i]} << (8 * i);
  return {kFixedPart + length_bytes, length};
}

// The text behind 'key': in the header, a Python dictionary.
std::optional<std::string_view> valueOf(std::string_view header, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = quote + std::string(key) + quote;
    std::size_t at = header.find(quoted);
    if (at == header.npos) continue;
    at = header.find_first_not_of(" :", at + quoted.size());
    if (at != header.npos) return header.substr(at);
  }
  return std::nullopt;
}

bool readType(std::string_view text, Header& header) noexcept {
  if (text.size() < 4 || (text[0] != '\'' && text[0] != '"')) return false;  // a structure
  header.type.swapped = text[1] == '>';
  if (std::string_view("<>|=").find(text[1]) == std::string_view::npos) return false;
  header.type.kind = text[2];
  header.type.bytes = text[3] - '0';
  if (text.size() < 5 || text[4] != text[0]) return false;
  const std::string_view sizes = header.type.kind == 'f'                              ? "248"
                                 : header.type.kind == 'i' || header.type.kind == 'u' ? "1248"
                                                                                      : "";
  return sizes.find(text[3]) != std::string_view::npos;
}

// "(480, 640)", "(3,)"
std::optional<std::vector<std::uint64_t>> readShape(std::string_view text) {
  constexpr std::size_t kMostDimensions = 8;
  std::vector<std::uint64_t> shape;
  if (text.empty() || text[0] != '(') return std::nullopt;
  text = text.substr(1, text.find(')') - 1);
  while (shape.size() <= kMostDimensions) {
    text.remove_prefix(std::min(text.find_first_not_of(" ,L"), text.size()));
    if (text.empty()) return shape;
    std::uint64_t size = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
    if (error != std::errc()) return std::nullopt;
    shape.push_back(size);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return std::nullopt;
}

// Accepts rows and columns, one or three components after them, and the number of pictures before them.
bool arrange(std::vector<std::uint64_t> shape, Header& header) {
  if (shape.size() >= 3 && (shape.back() == 1 || shape.back() == 3)) {
    header.components = shape.back();
    shape.pop_back();
  }
  if (shape.size() == 4 && shape[1] == 1) shape.erase(shape.begin() + 1);  // pictures x 1 x rows x columns
  // Rows x columns x pictures: no picture is so narrow.
  constexpr std::uint64_t kNarrow = 8;
  if (shape.size() == 3 && shape[2] <= std::min(shape[0], shape[1]) / kNarrow) return false;
  if (shape.size() == 3) {
    header.pictures = shape[0];
    shape.erase(shape.begin());
  }
  if (shape.size() != 2) return false;
  header.rows = shape[0];
  header.cols = shape[1];
  return header.pictures > 0 && header.pictures < std::uint64_t{1} << 32 && isSoundSize(header.cols, header.rows);
}

}  // namespace

bool isNpy(std::span<const std::uint8_t> begin) noexcept {
  return textOf(begin).starts_with(kMagic);
}

std::string_view headerText(std::span<const std::uint8_t> begin) noexcept {
  if (!isNpy(begin) || begin.size() < kFixedPart + 4) return {};
  const auto [from, length] = placeOfText(begin);
  return textOf(begin).substr(from, length);
}

std::optional<Header> parseHeader(std::span<const std::uint8_t> begin) {
  if (!isNpy(begin) || begin.size() < kFixedPart + 4) return std::nullopt;
  const auto [from, length] = placeOfText(begin);
  if (length > kLongestHeader) return std::nullopt;  // what is added below has to fit into 32 bits
  Header header;
  header.begin = from + length;
  if (begin[6] < 1 || begin[6] > 3 || header.begin > begin.size() || header.begin > kLongestHeader) return std::nullopt;
  const std::string_view text = textOf(begin).substr(from, length);
  const auto type = valueOf(text, "descr"), fortran = valueOf(text, "fortran_order"), shape = valueOf(text, "shape");
  if (!type || !fortran || !shape || !readType(*type, header)) return std::nullopt;
  header.fortran = fortran->starts_with("True");
  const auto dimensions = readShape(*shape);
  if (!dimensions || !arrange(*dimensions, header) || header.pictureBytes() > kMostPictureBytes) return std::nullopt;
  return header;
}

}  // namespace npy

namespace {

std::optional<FilePicture> readNpy(std::span<const std::uint8_t> file) {
  const auto header = npy::parseHeader(file);
  if (!header || header->pictures != 1) return std::nullopt;
  const std::span bytes = file.subspan(header->begin);
  if (bytes.size() < header->pictureBytes()) return std::nullopt;
  FilePicture picture{.width = static_cast<int>(header->cols),
                      .height = static_cast<int>(header->rows),
                      .components = static_cast<int>(header->components)};
  const auto rows = static_cast<std::size_t>(header->rows), cols = static_cast<std::size_t>(header->cols);
  const auto components = static_cast<std::size_t>(header->components);
  const std::size_t down = header->fortran ? 1 : cols * components;
  const std::size_t right = header->fortran ? rows : components;
  const std::size_t deep = header->fortran ? rows * cols : 1;
  picture.samples.reserve(rows * cols * components);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < cols; ++c) {
      for (std::size_t k = 0; k < components; ++k) {
        const std::size_t index = r * down + c * right + k * deep;
        picture.samples.push_back(numberAt(&bytes[index * static_cast<std::size_t>(header->type.bytes)], header->type));
      }
    }
  }
  picture.whole_bits = wholeBits(header->type, picture.samples);
  return picture;
}

}  // namespace

const PictureFormat kNpy{"npy", readNpy};

}  // namespace relievo
