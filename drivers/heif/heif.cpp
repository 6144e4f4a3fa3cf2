// SPDX-License-Identifier: Apache-2.0
// Decodes the pictures of a HEIF file.
#include "drivers/heif/heif.h"

#include <utility>

#include "drivers/heif/heif_handle.h"
#include "hal/media/halved.h"

namespace relievo {
namespace heif {

Photo openPhoto(std::span<const std::uint8_t> file) {
  constexpr int kLongestSide = 32768;
  Photo photo;
  photo.context.reset(heif_context_alloc());
  if (!photo.context) return photo;
  heif_context_set_maximum_image_size_limit(photo.context.get(), kLongestSide);
  if (failed(heif_context_read_from_memory_without_copy(photo.context.get(), file.data(), file.size(), nullptr))) {
    return photo;
  }
  heif_image_handle* handle = nullptr;
  if (failed(heif_context_get_primary_image_handle(photo.context.get(), &handle))) return photo;
  photo.color.reset(handle);
  if (heif_image_handle_get_list_of_depth_image_IDs(handle, &photo.depth_id, 1) != 1) return photo;
  heif_image_handle* depth = nullptr;
  if (!failed(heif_image_handle_get_depth_image_handle(handle, photo.depth_id, &depth))) photo.depth.reset(depth);
  return photo;
}

}  // namespace heif

namespace {

using namespace heif;

// Decoded, with its rotation applied. Null if it is damaged or too large.
std::shared_ptr<const heif_image> decode(const heif_image_handle* handle, heif_colorspace space, heif_chroma chroma) {
  const int cols = heif_image_handle_get_width(handle), rows = heif_image_handle_get_height(handle);
  if (cols < 1 || rows < 1 || std::int64_t{cols} * rows > kMostOfPhoto) return nullptr;
  heif_image* image = nullptr;
  if (failed(heif_decode_image(handle, &image, space, chroma, nullptr))) return nullptr;
  return {ImagePtr(image)};
}

std::optional<FilePicture> pictureOf(std::shared_ptr<const heif_image> image, heif_channel channel) {
  if (!image) return std::nullopt;
  int stride = 0;
  const std::uint8_t* const samples = heif_image_get_plane_readonly(image.get(), channel, &stride);
  Frame frame;
  frame.width = heif_image_get_width(image.get(), channel);
  frame.height = heif_image_get_height(image.get(), channel);
  if (samples == nullptr || frame.width < 1 || frame.height < 1) return std::nullopt;
  frame.range = ColorRange::Full;
  frame.plane_count = 1;
  frame.planes[0] = {samples, stride};
  frame.owner = std::move(image);
  return FilePicture{.width = frame.width, .height = frame.height, .frame = std::move(frame)};
}

// The picture, halved if it is larger than a film's may be.
std::optional<FilePicture> withinLimit(FilePicture picture) {
  if (std::int64_t{picture.width} * picture.height <= VideoDecoder::kMostSamples) return picture;
  auto half = halved(picture.frame);
  if (!half) return std::nullopt;
  return FilePicture{.width = half->width, .height = half->height, .frame = std::move(*half)};
}

std::optional<FilePicture> readRgb(const heif_image_handle* handle) {
  if (handle == nullptr) return std::nullopt;
  auto picture = pictureOf(decode(handle, heif_colorspace_RGB, heif_chroma_interleaved_RGB), heif_channel_interleaved);
  if (!picture) return picture;
  picture->frame.model = ColorModel::Rgb;
  for (std::uint8_t k = 0; k < 3; ++k) picture->frame.components[k] = {.offset_bytes = k, .step_bytes = 3, .bits = 8};
  return withinLimit(std::move(*picture));
}

std::optional<FilePicture> readColor(std::span<const std::uint8_t> file) {
  return readRgb(openPhoto(file).color.get());
}

std::optional<FilePicture> readView(std::span<const std::uint8_t> file, heif_item_id StereoPair::* which) {
  const auto pair = stereoPairIn(file);
  const Photo photo = openPhoto(file);
  heif_image_handle* handle = nullptr;
  if (!pair || !photo.color || failed(heif_context_get_image_handle(photo.context.get(), *pair.*which, &handle)))
    return std::nullopt;
  return readRgb(HandlePtr(handle).get());
}

std::optional<FilePicture> readLeft(std::span<const std::uint8_t> file) {
  return readView(file, &StereoPair::left);
}
std::optional<FilePicture> readRight(std::span<const std::uint8_t> file) {
  return readView(file, &StereoPair::right);
}

// Luma alone: the depth may be coded with flat chroma.
std::optional<FilePicture> readDepth(std::span<const std::uint8_t> file) {
  const Photo photo = openPhoto(file);
  if (!photo.depth) return std::nullopt;
  auto image = decode(photo.depth.get(), heif_colorspace_YCbCr, heif_chroma_420);
  if (!image) return std::nullopt;
  const int bits = heif_image_get_bits_per_pixel_range(image.get(), heif_channel_Y);
  auto picture = pictureOf(std::move(image), heif_channel_Y);
  if (!picture || bits < 8 || bits > 16) return std::nullopt;
  picture->frame.components[0] = {.step_bytes = static_cast<std::uint8_t>(bits > 8 ? 2 : 1),
                                  .bits = static_cast<std::uint8_t>(bits)};
  return withinLimit(std::move(*picture));
}

}  // namespace

const PictureFormat kHeifColor{"heif-color", readColor};
const PictureFormat kHeifDepth{"heif-depth", readDepth};
const PictureFormat kHeifLeft{"heif-left", readLeft};
const PictureFormat kHeifRight{"heif-right", readRight};

}  // namespace relievo
