// SPDX-License-Identifier: Apache-2.0
// A frame's colour picture as one RGBA texture, converted from the decoder's planes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <optional>

#include "app/render/gl/color_converter.h"
#include "app/render/gl/gl_objects.h"
#include "app/render/gl/plane_texture.h"
#include "app/render/gl/sdr_table.h"
#include "app/render/gl/seen_color.h"
#include "app/render/relief/stereo.h"
#include "app/scene/display_volume.h"
#include "hal/media/frame.h"
#include "platform/error.h"

namespace relievo {

// Each frame is converted once, into a texture that every eye's view samples: sampling three planes for every pixel of
// both eyes doubled the frame time in software rendering. The GPU converts it, unless there is none, or the picture has
// at least twice as many samples in a direction as are visible: then SeenColor reduces it on the CPU, and only the
// reduced picture is uploaded.
class ColorPicture {
 public:
  enum class Converter : std::uint8_t { Automatic, Gpu, Cpu };  // imported planes are always converted by the GPU
  explicit ColorPicture(Converter converter = Converter::Automatic) noexcept : converter_(converter) {}

  // Accepts whole samples of 8 to 16 bits, wherever they lie, of a picture that a texture can hold; Unsupported for
  // anything else. GL reads planar and semi-planar YUV, packed and planar RGB, and gray; SeenColor reads the rest
  // (packed 4:2:2 of webcams, gray beside alpha). Needs the GL context.
  [[nodiscard]] static Result<void> check(const Frame& frame) noexcept;

  // Takes the planes of a frame that passes `check`: 8 bits unchanged, from dma-bufs without a copy if the GL driver
  // allows it; more bits are cut to the top 8, which is what a display shows. Keeps a reference to the frame until the
  // next one. HDR (PQ, HLG) is tone-mapped for an SDR screen: asSdr of the 8 bits.
  [[nodiscard]] Result<void> setFrame(const Frame& frame);
  // Whether the planes of the last frame were used without a copy.
  [[nodiscard]] bool isImported() const noexcept { return imported_; }

  // Bytes of the last frame that were uploaded: 0 until it is bound, and if it is imported.
  [[nodiscard]] std::size_t uploadedBytes() const noexcept { return uploaded_bytes_; }

  // Uploads and converts the last frame, if that has not been done, and leaves the texture bound to `unit`, row 0 at
  // the top. The picture will fill `area`, in the aspect ratio of `volume`, minus bars; a picture with twice as many
  // pixels or more is averaged, to avoid aliasing. Changes the framebuffer and the viewport.
  void bind(GLuint unit, const PixelArea& area, const DisplayVolume& volume);

 private:
  enum class Arrangement : std::uint8_t { Gray, Planar, SemiPlanar, Packed, Scattered };
  static Result<Arrangement> arrangementOf(const Frame& frame) noexcept;
  static const char* sampling(Arrangement arrangement) noexcept;
  [[nodiscard]] std::size_t textureCount() const noexcept;
  [[nodiscard]] static glm::ivec2 samplesOf(const Frame& frame, std::size_t component) noexcept;
  [[nodiscard]] bool import(const Frame& frame);
  void upload(const Frame& frame);
  [[nodiscard]] bool drawsOnCpu();
  void makeSeen(glm::ivec2 samples);
  void setColors(const Frame& frame) noexcept;

  std::optional<Arrangement> arrangement_;
  int width_ = 0;
  int height_ = 0;
  ColorUniforms colors_;
  glm::mat3 components_to_rgb_{0};
  std::array<PlaneTexture, 3> planes_;
  std::optional<bool> takes_dma_bufs_;  // false after the first refusal
  Converter converter_;
  std::optional<bool> draws_on_cpu_;
  SeenColor seen_;
  SdrTable sdr_;
  PlaneTexture seen_texture_;
  glm::ivec2 seen_samples_{0};  // per pixel of the texture; 0 if it does not hold the last frame
  std::size_t uploaded_bytes_ = 0;
  bool imported_ = false;
  bool in_planes_ = false;  // the last frame's planes are on the GPU
  bool converted_ = false;
  Frame frame_;  // kept because a texture may use its memory
  ColorConverter gpu_;
};

}  // namespace relievo
