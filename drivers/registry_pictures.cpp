// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry_pictures.h"

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/floats/floats.h"
#include "drivers/pictures/pictures.h"
#ifdef RELIEVO_EXR
#include "drivers/exr/exr.h"
#endif
#ifdef RELIEVO_HEIF
#include "drivers/heif/heif.h"
#endif
#include "drivers/tiff/tiff.h"

namespace relievo::drivers {
namespace {

void lookInside([[maybe_unused]] const std::string& path, [[maybe_unused]] StreamInfo& stream) {
#ifdef RELIEVO_EXR
  const PhotoKind kinds[] = {kExrWithDepth};
  if (stream.codec != kExr.codec) return;
  const auto parts = photoParts(path, kinds);
  if (parts.empty()) return;
  for (const auto& [key, value] : parts.back().stream.tags) {
    if (key != "TITLE") stream.tags[key] = value;
  }
  stream.codec = kExrColor.codec;
  stream.tags[kInsideTag] = kExr.codec;
#endif
}

}  // namespace

Result<StreamInfo> describePicture(const std::string& path) {
  if (auto dpt = describeDpt(path)) return *std::move(dpt);
  const auto source = isNpyFile(path) ? makeNpySource() : makeFfmpegSource();
  if (auto opened = source->open(path); !opened) return std::unexpected(opened.error());
  for (const StreamInfo& stream : source->streams()) {
    if (stream.kind != StreamKind::Video) continue;
    StreamInfo picture = stream;
    lookInside(path, picture);
    return picture;
  }
  return fail(ErrorCode::Corrupt, "is no picture; check the file");
}

std::optional<PictureFormat> pictureFormat(const StreamInfo& stream) {
  if (isFloatTiff(stream)) return kTiff;
  const PictureFormat formats[] = {
      kPfm,       kNpy,       kDpt,
#ifdef RELIEVO_EXR
      kExr,       kExrColor,
#endif
#ifdef RELIEVO_HEIF
      kHeifColor, kHeifDepth, kHeifLeft, kHeifRight,
#endif
  };
  for (const PictureFormat& format : formats) {
    if (stream.codec == format.codec) return format;
  }
  return std::nullopt;
}

}  // namespace relievo::drivers
