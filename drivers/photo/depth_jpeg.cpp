// SPDX-License-Identifier: Apache-2.0
// Finds the depth map of a JPEG photo and its meaning (Google's depthmap metadata; Dynamic Depth 1.0; iPhones).
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>

#include "drivers/photo/apple_depth.h"
#include "drivers/photo/jpeg_xmp.h"
#include "drivers/photo/multi_picture.h"
#include "drivers/photo/photo.h"
#include "platform/print.h"

namespace relievo {
namespace {

using namespace photo;

constexpr double kLeastMm = 1e-3, kMostMm = 1e9;

std::optional<double> numberIn(std::optional<std::string_view> text) {
  if (!text) return std::nullopt;
  const std::string word(*text);
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  return end != word.c_str() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// The meaning of the codes: RangeInverse d = far (z - near)/(z (far - near)), RangeLinear d = (z - near)/(far - near),
// and d is 0 for near.
std::map<std::string, std::string> tagsOf(std::string_view xmp, const std::string& prefix) {
  const auto get = [&](const char* name) { return property(xmp, prefix + name); };
  const bool linear = get("Format").value_or("") == "RangeLinear";
  std::map<std::string, std::string> tags{{"TITLE", "depth"},
                                          {"DEPTH_LAW", linear ? "linear" : "inverse"},
                                          {"DEPTH_POLARITY", "near-low"},
                                          {"DEPTH_RANGE", "full"},
                                          {"DEPTH_INVALID", "none"}};
  const std::string_view units = get("Units").value_or("m");
  const double mm = units == "mm" || units == "Millimeters" ? 1 : 1000;
  const auto near = numberIn(get("Near")), far = numberIn(get("Far"));
  if (!near || !far) return tags;
  const double near_mm = mm * *near, far_mm = mm * *far;
  if (near_mm < kLeastMm || far_mm > kMostMm || far_mm <= near_mm) return tags;
  tags["DEPTH_NEAR"] = print("%.9g", near_mm);
  tags["DEPTH_FAR"] = print("%.9g", far_mm);
  return tags;
}

std::string_view codecOf(std::span<const std::uint8_t> picture) {
  constexpr std::array<std::uint8_t, 4> kPng{0x89, 'P', 'N', 'G'};
  if (picture.size() > 4 && std::equal(kPng.begin(), kPng.end(), picture.begin())) return "png";
  return picture.size() > 2 && picture[0] == 0xff && picture[1] == 0xd8 ? "mjpeg" : "";
}

std::vector<PhotoPart> withDepth(const PhotoBytes& file, std::span<const std::uint8_t> map, const PhotoBytes& owner,
                                 std::map<std::string, std::string> tags) {
  const std::string_view codec = codecOf(map);
  if (codec.empty()) return {};
  PhotoPart color{.stream = {.codec = "mjpeg"}, .coded = *file, .owner = file};
  color.stream.rotation = exifRotation(*file).value_or(0);
  PhotoPart depth{.stream = {.codec = std::string(codec), .tags = std::move(tags)}, .coded = map, .owner = owner};
  depth.stream.rotation = exifRotation(map).value_or(color.stream.rotation);
  return {std::move(color), std::move(depth)};
}

// A directory lists what follows the picture, in order; the first item is the picture itself, of length 0.
struct Listed {
  std::size_t length = 0;
  bool depth = false;
};
std::vector<Listed> directoryOf(std::string_view xmp) {
  constexpr std::size_t kMostItems = 64;
  std::vector<Listed> items;
  const std::size_t begin = xmp.find("Container:Directory");
  if (begin == xmp.npos) return items;
  xmp = xmp.substr(begin, xmp.find("</Container:Directory", begin) - begin);
  for (std::size_t at = xmp.find("<rdf:li"); at != xmp.npos && items.size() < kMostItems;) {
    const std::size_t next = xmp.find("<rdf:li", at + 1);
    const std::string_view item = xmp.substr(at, next - at);
    Listed listed;
    for (const char* const prefix : {"Item:", "Container:"}) {
      const auto get = [&](const char* name) { return property(item, prefix + std::string(name)); };
      if (const auto length = numberIn(get("Length")); length && *length > 0 && *length < 1e9) {
        listed.length += static_cast<std::size_t>(*length);
      }
      const bool names = get("DataURI").value_or("").find("depthmap") != std::string_view::npos;
      listed.depth = listed.depth || names || get("Semantic").value_or("") == "Depth";
    }
    items.push_back(listed);
    at = next;
  }
  return items;
}

// The items lie one after the other at the end of the file.
std::span<const std::uint8_t> appendedDepth(std::string_view xmp, std::span<const std::uint8_t> file) {
  const std::vector<Listed> items = directoryOf(xmp);
  std::size_t behind = 0;
  for (auto item = items.rbegin(); item != items.rend(); ++item) {
    behind += item->length;
    if (behind > file.size()) return {};
    if (item->depth) return file.subspan(file.size() - behind, item->length);
  }
  return {};
}

// Behind an iPhone's picture, in its own index: a picture whose XMP says disparity or depth.
std::vector<PhotoPart> appleDepth(const PhotoBytes& file) {
  for (const ListedPicture& picture : picturesIn(*file)) {
    if (picture.coded.data() == file->data()) continue;
    const std::string xmp = xmpOf(picture.coded);
    if (isAppleDepth(xmp)) return withDepth(file, picture.coded, file, depthTags(appleRange(xmp), 8));
  }
  return {};
}

bool beginsLikeJpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

std::vector<PhotoPart> partsOf(const PhotoBytes& file) {
  const std::string xmp = xmpOf(*file);
  if (const auto coded = property(xmp, "GDepth:Data")) {
    auto map = fromBase64(*coded);
    if (!map) return {};
    const auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(*map));
    return withDepth(file, *owner, owner, tagsOf(xmp, "GDepth:"));
  }
  auto parts = withDepth(file, appendedDepth(xmp, *file), file, tagsOf(xmp, "DepthMap:"));
  return parts.empty() ? appleDepth(file) : parts;
}

}  // namespace

const PhotoKind kDepthJpeg{beginsLikeJpeg, partsOf, kMostJpegBytes};

}  // namespace relievo
