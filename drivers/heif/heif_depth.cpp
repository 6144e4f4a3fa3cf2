// SPDX-License-Identifier: Apache-2.0
// What the codes of a HEIF photo's depth map mean.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/heif/heif.h"
#include "drivers/heif/heif_handle.h"
#include "drivers/photo/jpeg_xmp.h"
#include "hal/media/media_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

using namespace heif;
using Tags = std::map<std::string, std::string>;

constexpr double kMmPerMetre = 1000;
constexpr double kMostRatio = 64;  // of far to near; smaller disparities are cut to it

// Disparities in 1/m, or distances in m, of the lowest and the highest code.
struct Range {
  double low = 0, high = 0;
  bool distances = false;
};

std::optional<Range> fromRepresentation(const Photo& photo) {
  const heif_depth_representation_info* info = nullptr;
  if (heif_image_handle_get_depth_image_representation_info(photo.color.get(), photo.depth_id, &info) == 0 ||
      info == nullptr) {
    return std::nullopt;
  }
  const std::unique_ptr<const heif_depth_representation_info, decltype(&heif_depth_representation_info_free)> owned(
      info, heif_depth_representation_info_free);
  const bool distances = info->depth_representation_type == heif_depth_representation_type_uniform_Z;
  if (info->has_z_near != 0 && info->has_z_far != 0 && info->z_near > 0 && info->z_far > info->z_near) {
    return distances ? Range{info->z_far, info->z_near, true} : Range{1 / info->z_far, 1 / info->z_near, false};
  }
  if (distances || info->has_d_min == 0 || info->has_d_max == 0) return std::nullopt;
  return Range{info->d_min, info->d_max, false};
}

// Phones write the least and the largest disparity to the depth map's XMP.
std::optional<Range> fromXmp(const Photo& photo) {
  constexpr std::size_t kMostXmp = 1 << 20;
  heif_item_id ids[16];
  const int count = heif_image_handle_get_list_of_metadata_block_IDs(photo.depth.get(), nullptr, ids, 16);
  for (int i = 0; i < count; ++i) {
    const std::size_t bytes = heif_image_handle_get_metadata_size(photo.depth.get(), ids[i]);
    std::string xmp(std::min(bytes, kMostXmp), ' ');
    if (bytes > kMostXmp || failed(heif_image_handle_get_metadata(photo.depth.get(), ids[i], xmp.data()))) continue;
    const auto number = [&](const char* name) {
      const std::string word(photo::property(xmp, name).value_or(""));
      return word.empty() ? std::nan("") : std::strtod(word.c_str(), nullptr);
    };
    const Range range{number("apdi:FloatMinValue"), number("apdi:FloatMaxValue"), false};
    if (range.high > range.low) return range;
  }
  return std::nullopt;
}

Tags tagsOf(const Photo& photo) {
  Tags tags{{"TITLE", "depth"},
            {"DEPTH_LAW", "inverse"},
            {"DEPTH_POLARITY", "near-high"},
            {"DEPTH_RANGE", "full"},
            {"DEPTH_INVALID", "none"}};
  auto range = fromRepresentation(photo);
  if (!range) range = fromXmp(photo);
  if (!range || !std::isfinite(range->low) || !std::isfinite(range->high)) return tags;
  if (range->distances) {
    tags["DEPTH_LAW"] = "linear";
    tags["DEPTH_NEAR"] = print("%.9g", kMmPerMetre * range->high);
    tags["DEPTH_FAR"] = print("%.9g", kMmPerMetre * range->low);
    return tags;
  }
  if (!(range->high > std::max(range->low, 1e-5))) return tags;
  const double least = range->high / kMostRatio;
  double low = range->low;
  if (low < least) {  // the codes below it are as far
    const int bits = heif_image_handle_get_luma_bits_per_pixel(photo.depth.get());
    const double top = std::ldexp(1.0, std::clamp(bits, 8, 16)) - 1;
    const double code = std::min(top - 1, std::round(top * (least - low) / (range->high - low)));
    low += code / top * (range->high - low);
    tags["DEPTH_CODES"] = print("%.0f-%.0f", code, top);
  }
  tags["DEPTH_NEAR"] = print("%.9g", kMmPerMetre / range->high);
  tags["DEPTH_FAR"] = print("%.9g", kMmPerMetre / std::max(low, 1e-6));
  return tags;
}

// A file type box with a brand of still pictures (ISO/IEC 23008-12).
bool beginsLikeHeif(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kBrands[] = {"heic", "heix", "heim", "heis", "mif1", "msf1"};
  if (bytes.size() < 16) return false;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.substr(4, 4) != "ftyp") return false;
  for (std::size_t at = 8; at + 4 <= text.size(); at += at == 8 ? 8 : 4) {
    if (std::find(std::begin(kBrands), std::end(kBrands), text.substr(at, 4)) != std::end(kBrands)) return true;
  }
  return false;
}

std::vector<PhotoPart> viewsOf(const PhotoBytes& file) {
  return {
      PhotoPart{.stream = {.codec = kHeifLeft.codec, .tags = {{kViewTag, "left"}}}, .coded = *file, .owner = file},
      PhotoPart{.stream = {.codec = kHeifRight.codec, .tags = {{kViewTag, "right"}}}, .coded = *file, .owner = file}};
}

std::vector<PhotoPart> partsOf(const PhotoBytes& file) {
  const Photo photo = openPhoto(*file);
  if (!photo.depth) return photo.color && stereoPairIn(*file) ? viewsOf(file) : std::vector<PhotoPart>{};
  return {PhotoPart{.stream = {.codec = kHeifColor.codec}, .coded = *file, .owner = file},
          PhotoPart{.stream = {.codec = kHeifDepth.codec, .tags = tagsOf(photo)}, .coded = *file, .owner = file}};
}

}  // namespace

const PhotoKind kHeif{beginsLikeHeif, partsOf};

}  // namespace relievo
