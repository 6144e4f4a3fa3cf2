// SPDX-License-Identifier: Apache-2.0
// Uploads colour planes and converts them to RGB in one pass, or uploads what SeenColor made of them.
#include "app/render/gl/color_picture.h"

#include <algorithm>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <string_view>
#include <utility>

#include "app/render/gl/color_shader.h"
#include "app/render/gl/dma_import.h"
#include "hal/media/samples.h"

namespace relievo {
namespace {

// Column k: the contribution of component k to red, green and blue.
glm::mat3 rgbFromComponents(const Frame& frame) noexcept {
  if (frame.model == ColorModel::Gray) return {glm::vec3(1), glm::vec3(0), glm::vec3(0)};
  if (frame.model == ColorModel::Rgb) return glm::mat3(1);
  const auto weights = lumaWeights(frame);
  const auto red = static_cast<float>(weights.red), blue = static_cast<float>(weights.blue);
  const float green = 1 - red - blue;
  return {glm::vec3(1), glm::vec3(0, -2 * blue * (1 - blue) / green, 2 * (1 - blue)),
          glm::vec3(2 * (1 - red), -2 * red * (1 - red) / green, 0)};
}

}  // namespace

Result<ColorPicture::Arrangement> ColorPicture::arrangementOf(const Frame& frame) noexcept {
  if (frame.empty() || frame.width < 1 || frame.height < 1) {
    return fail(ErrorCode::InvalidArgument, "the colour picture is empty");
  }
  const auto& [first, second, third] = frame.components;
  const int bytes = first.bits > 8 ? 2 : 1;
  const auto isWhole = [](const Component& c) { return c.bits >= 8 && c.bits <= 16 && (c.bits > 8 || c.shift == 0); };
  const bool gray = frame.model == ColorModel::Gray;
  if (!isWhole(first) || (!gray && (!isWhole(second) || !isWhole(third)))) {
    return fail(ErrorCode::Unsupported, "samples of under 8 or over 16 bits cannot be drawn; decode to others");
  }
  const auto alone = [&](const Component& c) { return c.step_bytes == bytes && c.offset_bytes == 0; };
  if (gray) return alone(first) ? Arrangement::Gray : Arrangement::Scattered;

  const auto likeFirst = [&](const Component& c) { return c.bits == first.bits && c.shift == first.shift; };
  if (!likeFirst(second) || !likeFirst(third)) return Arrangement::Scattered;
  if (alone(first) && alone(second) && alone(third)) return Arrangement::Planar;

  const auto isPair = [&](const Component& c) { return c.step_bytes == 2 * bytes && c.offset_bytes <= bytes; };
  if (alone(first) && isPair(second) && isPair(third) && second.plane == third.plane) return Arrangement::SemiPlanar;

  const int step = first.step_bytes;
  const auto isPacked = [&](const Component& c) {
    return c.plane == first.plane && c.step_bytes == step && c.offset_bytes + bytes <= step;
  };
  const bool whole = step == 3 * bytes || step == 4 * bytes;
  const bool subsampled = frame.chroma_shift_x != 0 || frame.chroma_shift_y != 0;
  if (whole && !subsampled && isPacked(first) && isPacked(second) && isPacked(third)) return Arrangement::Packed;
  return Arrangement::Scattered;
}

const char* ColorPicture::sampling(Arrangement arrangement) noexcept {
  switch (arrangement) {
    case Arrangement::Gray:
      return "#define SAMPLE vec4(texture(plane0, luma_at).r, 0.0, 0.0, 0.0)\n";
    case Arrangement::Planar:
      return "#define SAMPLE vec4(texture(plane0, luma_at).r, texture(plane1, chroma_at).r, "
             "texture(plane2, chroma_at).r, 0.0)\n";
    case Arrangement::SemiPlanar:
      return "#define SAMPLE vec4(texture(plane0, luma_at).r, texture(plane1, chroma_at).rg, 0.0)\n";
    case Arrangement::Packed:
      return "#define SAMPLE texture(plane0, luma_at)\n";
    case Arrangement::Scattered:
      break;  // not GL's
  }
  return "";
}

Result<void> ColorPicture::check(const Frame& frame) noexcept {
  if (auto arrangement = arrangementOf(frame); !arrangement) return std::unexpected(arrangement.error());
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (std::max(frame.width, frame.height) > largest) {
    return fail(ErrorCode::Unsupported, "the picture is larger than this GL driver's textures; use a smaller video");
  }
  return {};
}

Result<void> ColorPicture::setFrame(const Frame& frame) {
  if (auto drawable = check(frame); !drawable) return drawable;
  const auto arrangement = arrangementOf(frame);
  if (*arrangement != Arrangement::Scattered) {
    auto prepared = gpu_.prepare(sampling(*arrangement) + sdrDefines(frame.transfer, frame.primaries));
    if (!prepared) return prepared;
  }
  arrangement_ = *arrangement;
  width_ = frame.width;
  height_ = frame.height;
  glActiveTexture(GL_TEXTURE0);
  imported_ = in_planes_ = import(frame);
  uploaded_bytes_ = 0;
  seen_samples_ = {};
  // If the picture's size is odd, the last chroma sample extends beyond its edge.
  const glm::ivec2 chroma = samplesOf(frame, 1);
  colors_.chroma_scale = {static_cast<float>(width_) / static_cast<float>(chroma.x << frame.chroma_shift_x),
                          static_cast<float>(height_) / static_cast<float>(chroma.y << frame.chroma_shift_y)};
  frame_ = frame;
  setColors(frame);
  converted_ = false;
  return {};
}

// Texture i holds the plane of component i.
std::size_t ColorPicture::textureCount() const noexcept {
  return arrangement_ == Arrangement::Planar ? 3 : arrangement_ == Arrangement::SemiPlanar ? 2 : 1;
}

glm::ivec2 ColorPicture::samplesOf(const Frame& frame, std::size_t component) noexcept {
  if (component == 0) return {frame.width, frame.height};
  return {(frame.width + (1 << frame.chroma_shift_x) - 1) >> frame.chroma_shift_x,
          (frame.height + (1 << frame.chroma_shift_y) - 1) >> frame.chroma_shift_y};
}

// Imports all planes or none: after the first refusal the driver is not asked again.
bool ColorPicture::import(const Frame& frame) {
  if (arrangement_ == Arrangement::Scattered) return false;
  const std::size_t count = textureCount();
  for (std::size_t i = 0; i < count; ++i) {
    const Component& component = frame.components[i];
    if (frame.dma_bufs[component.plane].fd < 0 || component.bits > 8 || component.step_bytes > 2) return false;
  }
  if (!takes_dma_bufs_) takes_dma_bufs_ = takesDmaBufs();
  for (std::size_t i = 0; i < count && *takes_dma_bufs_; ++i) {
    const Component& component = frame.components[i];
    const glm::ivec2 samples = samplesOf(frame, i);
    takes_dma_bufs_ =
        planes_[i].import(component.step_bytes, frame.dma_bufs[component.plane],
                          frame.planes[component.plane].stride_bytes, samples.x, samples.y, frame.dma_modifier);
  }
  return *takes_dma_bufs_;
}

void ColorPicture::upload(const Frame& frame) {
  in_planes_ = true;
  const Component& first = frame.components[0];
  const bool narrow = first.bits > 8;
  const int narrowing = first.shift + first.bits - 8;
  for (std::size_t i = 0; i < textureCount(); ++i) {
    const Component& component = frame.components[i];
    const Plane& plane = frame.planes[component.plane];
    const glm::ivec2 samples = samplesOf(frame, i);
    const auto channels = static_cast<std::uint8_t>(component.step_bytes / (narrow ? 2 : 1));
    uploaded_bytes_ +=
        std::size_t{channels} * static_cast<std::size_t>(samples.x) * static_cast<std::size_t>(samples.y);
    if (narrow) {
      planes_[i].uploadNarrowed(channels, plane, samples.x, samples.y, narrowing);
    } else {
      planes_[i].upload(channels, plane, samples.x, samples.y);
    }
  }
}

// Whether GL has no GPU: what it would do to a picture's planes is done here in a tenth of the time.
bool ColorPicture::drawsOnCpu() {
  if (!draws_on_cpu_) {
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const std::string_view name = renderer == nullptr ? "" : renderer;
    constexpr std::array<std::string_view, 3> kSoftware{"llvmpipe", "softpipe", "SwiftShader"};
    draws_on_cpu_ = std::ranges::any_of(
        kSoftware, [&](std::string_view each) { return name.find(each) != std::string_view::npos; });
  }
  return *draws_on_cpu_;
}

void ColorPicture::makeSeen(glm::ivec2 samples) {
  seen_samples_ = samples;
  seen_.make(frame_, samples, components_to_rgb_, colors_.bias);
  sdr_.prepare(frame_.transfer, frame_.primaries);
  sdr_.apply(seen_.rgba());
  seen_texture_.upload(4, {seen_.rgba().data(), std::ptrdiff_t{4} * seen_.width()}, seen_.width(), seen_.height());
  uploaded_bytes_ += seen_.rgba().size();
}

// Codes arrive as fractions of 255: rgb = sum of column x scale x (fraction - zero point).
void ColorPicture::setColors(const Frame& frame) noexcept {
  const glm::mat3 columns = rgbFromComponents(frame);
  const bool is_limited = isLimited(frame);
  const int count = frame.model == ColorModel::Gray ? 1 : 3;
  colors_.to_rgb = glm::mat4x3(0);
  components_to_rgb_ = glm::mat3(0);
  colors_.bias = glm::vec3(0);
  for (int i = 0; i < count; ++i) {
    const Component& component = frame.components[static_cast<std::size_t>(i)];
    const int channel = component.offset_bytes / (component.bits > 8 ? 2 : 1);
    const bool chroma = frame.model == ColorModel::Yuv && i > 0;
    const float span = chroma ? 224.0f : 219.0f;
    const float scale = is_limited ? 255.0f / span : 1.0f;
    const float zero = (chroma ? 128.0f : is_limited ? 16.0f : 0.0f) / 255.0f;
    const int sampled = arrangement_ == Arrangement::Packed                ? channel
                        : arrangement_ == Arrangement::SemiPlanar && i > 0 ? 1 + channel
                                                                           : i;
    colors_.to_rgb[sampled] = components_to_rgb_[i] = scale * columns[i];
    colors_.bias -= zero * scale * columns[i];
  }
}

void ColorPicture::bind(GLuint unit, const PixelArea& area, const DisplayVolume& volume) {
  const double area_aspect = static_cast<double>(area.width) / area.height;
  const double picture_aspect = volume.width_mm / volume.height_mm;
  const int shown_width = std::max(1, static_cast<int>(area.width * std::min(1.0, picture_aspect / area_aspect)));
  const int shown_height = std::max(1, static_cast<int>(area.height * std::min(1.0, area_aspect / picture_aspect)));
  const glm::ivec2 samples(SeenColor::factorFor(width_, shown_width), SeenColor::factorFor(height_, shown_height));
  const bool by_cpu = arrangement_ == Arrangement::Scattered || converter_ == Converter::Cpu ||
                      (converter_ == Converter::Automatic && (samples != glm::ivec2(1) || drawsOnCpu()));
  glActiveTexture(GL_TEXTURE0 + unit);
  if (by_cpu && !imported_) {
    if (seen_samples_ != samples) makeSeen(samples);
    return seen_texture_.bind(unit);
  }
  if (!in_planes_) upload(frame_);
  const auto reduced = [](int all, int factor) { return factor > 1 ? (all + 1) / 2 : all; };
  const glm::ivec2 size(reduced(width_, samples.x), reduced(height_, samples.y));
  if (!converted_ || size != gpu_.size()) gpu_.convert(planes_, colors_, size, size == glm::ivec2(width_, height_));
  converted_ = true;
  glActiveTexture(GL_TEXTURE0 + unit);
  gpu_.bind();
}

}  // namespace relievo
