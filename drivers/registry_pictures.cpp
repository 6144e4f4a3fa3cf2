// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry_pictures.h"

#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/floats/floats.h"
#include "drivers/photo/photo.h"
#include "drivers/pictures/pictures.h"
#ifdef RELIEVO_EXR
#include "drivers/exr/exr.h"
#endif
#ifdef RELIEVO_HEIF
#include "drivers/heif/heif.h"
#endif
#ifdef RELIEVO_SCAN
#include "drivers/npz/npz.h"
#endif
#include "drivers/tiff/tiff.h"
#include "hal/media/media_names.h"

namespace relievo::drivers {
namespace {

void lookInside(const std::string& path, StreamInfo& stream) {
  if (const char* const unread = stream.codec == "mjpeg" ? unreadDepth(path) : nullptr; unread != nullptr)
    stream.tags[kNoteTag] = unread;
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

std::unique_ptr<MediaSource> unpackPicture([[maybe_unused]] const std::string& path) {
#ifdef RELIEVO_SCAN
  if (endingOf(path) == "npz" && isNpz(path)) return makeNpzSource();
#endif
  return nullptr;
}

Result<StreamInfo> describePicture(const std::string& path) {
  if (auto dpt = describeDpt(path)) return *std::move(dpt);
  auto source = unpackPicture(path);
  if (!source) source = isNpyFile(path) ? makeNpySource() : makeFfmpegSource();
  if (auto opened = source->open(path); !opened) return std::unexpected(opened.error());
  for (const StreamInfo& stream : source->streams()) {
    if (stream.kind != StreamKind::Video) continue;
    StreamInfo picture = stream;
    if (!source->notes().empty()) picture.tags[kNoteTag] = source->notes().front();
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
