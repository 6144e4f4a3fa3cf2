// SPDX-License-Identifier: Apache-2.0
// Owners of libheif's objects.
#pragma once

#include <libheif/heif.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace relievo::heif {

struct Freer {
  void operator()(heif_context* context) const noexcept { heif_context_free(context); }
  void operator()(heif_image_handle* handle) const noexcept { heif_image_handle_release(handle); }
  void operator()(heif_image* image) const noexcept { heif_image_release(image); }
};
using ContextPtr = std::unique_ptr<heif_context, Freer>;
using HandlePtr = std::unique_ptr<heif_image_handle, Freer>;
using ImagePtr = std::unique_ptr<heif_image, Freer>;

[[nodiscard]] inline bool failed(const heif_error& error) noexcept {
  return error.code != heif_error_Ok;
}

// The file's pictures that matter here. Null if there is none; `file` must outlive it.
struct Photo {
  ContextPtr context;
  HandlePtr color, depth;
  heif_item_id depth_id = 0;
};
[[nodiscard]] Photo openPhoto(std::span<const std::uint8_t> file);

// The item numbers of a stereo pair's pictures.
struct StereoPair {
  heif_item_id left = 0, right = 0;
};
[[nodiscard]] std::optional<StereoPair> stereoPairIn(std::span<const std::uint8_t> file);

}  // namespace relievo::heif
