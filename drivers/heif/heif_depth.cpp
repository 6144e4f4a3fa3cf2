// SPDX-License-Identifier: Apache-2.0
// What the codes of a HEIF photo's depth map mean.
#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/heif/heif.h"
#include "drivers/heif/heif_handle.h"
#include "drivers/photo/apple_depth.h"
#include "hal/media/halved.h"
#include "hal/media/media_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

using namespace heif;

std::optional<photo::DepthRange> fromRepresentation(const Photo& photo) {
  const heif_depth_representation_info* info = nullptr;
  if (heif_image_handle_get_depth_image_representation_info(photo.color.get(), photo.depth_id, &info) == 0 ||
      info == nullptr) {
    return std::nullopt;
  }
  const std::unique_ptr<const heif_depth_representation_info, decltype(&heif_depth_representation_info_free)> owned(
      info, heif_depth_representation_info_free);
  const bool distances = info->depth_representation_type == heif_depth_representation_type_uniform_Z;
  if (info->has_z_near != 0 && info->has_z_far != 0 && info->z_near > 0 && info->z_far > info->z_near) {
    return distances ? photo::DepthRange{info->z_far, info->z_near, true}
                     : photo::DepthRange{1 / info->z_far, 1 / info->z_near, false};
  }
  if (distances || info->has_d_min == 0 || info->has_d_max == 0) return std::nullopt;
  return photo::DepthRange{info->d_min, info->d_max, false};
}

// Phones write the least and the largest disparity to the depth map's XMP.
std::optional<photo::DepthRange> fromXmp(const Photo& photo) {
  constexpr std::size_t kMostXmp = 1 << 20;
  heif_item_id ids[16];
  const int count = heif_image_handle_get_list_of_metadata_block_IDs(photo.depth.get(), nullptr, ids, 16);
  for (int i = 0; i < count; ++i) {
    const std::size_t bytes = heif_image_handle_get_metadata_size(photo.depth.get(), ids[i]);
    std::string xmp(std::min(bytes, kMostXmp), ' ');
    if (bytes > kMostXmp || failed(heif_image_handle_get_metadata(photo.depth.get(), ids[i], xmp.data()))) continue;
    if (const auto range = photo::appleRange(xmp)) return range;
  }
  return std::nullopt;
}

std::map<std::string, std::string> tagsOf(const Photo& photo) {
  auto range = fromRepresentation(photo);
  if (!range) range = fromXmp(photo);
  return photo::depthTags(range, heif_image_handle_get_luma_bits_per_pixel(photo.depth.get()));
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

// A line for the user if the picture is halved.
std::string noteOf(const heif_image_handle* handle) {
  const int cols = heif_image_handle_get_width(handle), rows = heif_image_handle_get_height(handle);
  return std::int64_t{cols} * rows > VideoDecoder::kMostSamples ? halvedLine(cols, rows) : "";
}

std::vector<PhotoPart> viewsOf(const PhotoBytes& file) {
  return {
      PhotoPart{.stream = {.codec = kHeifLeft.codec, .tags = {{kViewTag, "left"}}}, .coded = *file, .owner = file},
      PhotoPart{.stream = {.codec = kHeifRight.codec, .tags = {{kViewTag, "right"}}}, .coded = *file, .owner = file}};
}

std::vector<PhotoPart> partsOf(const PhotoBytes& file) {
  const Photo photo = openPhoto(*file);
  if (!photo.depth) return photo.color && stereoPairIn(*file) ? viewsOf(file) : std::vector<PhotoPart>{};
  return {PhotoPart{
              .stream = {.codec = kHeifColor.codec}, .coded = *file, .owner = file, .note = noteOf(photo.color.get())},
          PhotoPart{.stream = {.codec = kHeifDepth.codec, .tags = tagsOf(photo)}, .coded = *file, .owner = file}};
}

}  // namespace

const PhotoKind kHeif{beginsLikeHeif, partsOf};

}  // namespace relievo
