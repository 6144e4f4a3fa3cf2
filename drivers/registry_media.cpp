// SPDX-License-Identifier: Apache-2.0
// Creates what reads a film: its source, by its address, and its decoders, by their names on the command line.
#include <atomic>
#include <optional>
#include <utility>

#include "drivers/failover/failover.h"
#include "drivers/registry.h"
#include "drivers/registry_pictures.h"
#ifdef RELIEVO_EXR
#include "drivers/exr/exr.h"
#endif
#include "drivers/ffmpeg/ffmpeg.h"
#include "drivers/floats/floats.h"
#ifdef RELIEVO_GSTREAMER
#include "drivers/gstreamer/gstreamer.h"
#endif
#ifdef RELIEVO_HEIF
#include "drivers/heif/heif.h"
#endif
#include "drivers/mock/mock.h"
#ifdef RELIEVO_OPENNI
#include "drivers/openni/openni.h"
#endif
#include "drivers/photo/photo.h"
#include "drivers/pictures/pictures.h"
#ifdef RELIEVO_ROSBAG
#include "drivers/rosbag/rosbag.h"
#endif
#ifdef RELIEVO_SCAN
#include "drivers/npz/npz.h"
#include "drivers/scan/scan.h"
#endif
#include "drivers/tiff/tiff.h"
#include "drivers/v4l2/v4l2.h"
#include "hal/media/media_names.h"

#define RELIEVO_DECODER_NAMES "v4l2 gstreamer[:ELEMENT] ffmpeg"

namespace relievo::drivers {

const char* const kDecoderNames = RELIEVO_DECODER_NAMES;
const char* const kMockFilm = "mock:";

namespace {

const PhotoKind kPhotoKinds[] = {
    kDepthJpeg,
    kStereoJpeg,
#ifdef RELIEVO_EXR
    kExrWithDepth,
#endif
#ifdef RELIEVO_HEIF
    kHeif,
#endif
};

bool holdsTwoLayers(const StreamInfo& stream) {
  const auto layers = stream.tags.find(kLayersTag);
  return layers != stream.tags.end() && layers->second == "2" && ffmpegDecodesBothViews();
}

// Hardware decoders omit an alpha channel and the second of two views.
bool isLeftToSoftware(const StreamInfo& stream) {
  return isMock(stream) || isV4l2Raw(stream) || pictureFormat(stream) || saysAlpha(stream) || holdsTwoLayers(stream);
}

std::unique_ptr<VideoDecoder> withSoftwareBehind(std::vector<std::unique_ptr<VideoDecoder>> decoders,
                                                 const StreamInfo& stream, bool asked_for = false) {
  decoders.push_back(makeSoftwareDecoder(stream));
  return decoders.size() == 1 ? std::move(decoders.front()) : makeFailoverDecoder(std::move(decoders), asked_for);
}

// Adds the software decoder behind one that was requested by name.
std::unique_ptr<VideoDecoder> backed(std::unique_ptr<VideoDecoder> decoder, const StreamInfo& stream) {
  std::vector<std::unique_ptr<VideoDecoder>> decoders;
  if (!isLeftToSoftware(stream)) decoders.push_back(std::move(decoder));
  return withSoftwareBehind(std::move(decoders), stream, true);
}

std::unexpected<Failure> unknown(const BackEndName& name, const char* message) {
  return failOn("--decoder " + name.text(), {ErrorCode::InvalidArgument, 0, message});
}

}  // namespace

std::unique_ptr<MediaSource> makeMediaSource(const std::string& url) {
  static MonotonicClock clock;
  const BackEndName name(url);
  if (name == kMockFilm) return makeMockSource(mockFilm(), clock);
#ifdef RELIEVO_ROSBAG
  if (isRosbag(url)) return makeRosbagSource();
#endif
#ifdef RELIEVO_OPENNI
  if (isOpenni(url)) return makeOpenniSource();
#endif
#ifdef RELIEVO_SCAN
  if (isScan(url)) return makeScanSource();
  if (isDepthBin(url)) return makeDepthBinSource();
  if (isNpz(url)) return makeNpzSource();
#endif
  if (name.word == "v4l2" && name.argument) return makeV4l2Source();
  if (isNpyFile(url)) return makeNpySource();
  if (isTiffFilm(url)) return makeTiffSource(describePicture);
  if (isPhoto(url, kPhotoKinds)) return makePhotoSource(kPhotoKinds);
  return isPictures(url) ? makePicturesSource(describePicture, unpackPicture) : makeFfmpegSource();
}

std::unique_ptr<VideoDecoder> makeSoftwareDecoder(const StreamInfo& stream) {
  if (isMock(stream)) return makeMockDecoder({.max_held_frames = 32});
  if (isV4l2Raw(stream)) return makeV4l2RawDecoder();
  const auto format = pictureFormat(stream);
  return format ? makePictureFileDecoder(*format) : makeFfmpegDecoder();
}

std::unique_ptr<VideoDecoder> makeVideoDecoder(const StreamInfo& stream) {
  if (isLeftToSoftware(stream)) return makeSoftwareDecoder(stream);
  std::vector<std::unique_ptr<VideoDecoder>> hardware;
  if (!lookAtV4l2M2mNodes().empty()) hardware.push_back(makeV4l2M2mDecoder());
#ifdef RELIEVO_GSTREAMER
  if (gstreamerHasDevices()) hardware.push_back(makeGstreamerDecoder());
#endif
  return withSoftwareBehind(std::move(hardware), stream);
}

Outcome<DecoderMaker> decoderMaker(const BackEndName& name) {
  if (name.word.empty()) return makeVideoDecoder;
  if (name.plain("ffmpeg")) return makeSoftwareDecoder;
  if (name.plain("v4l2")) return [](const StreamInfo& stream) { return backed(makeV4l2M2mDecoder(), stream); };
  if (name.plain("gstreamer") || name.withArgument("gstreamer")) {
#ifdef RELIEVO_GSTREAMER
    return [element = name.argument.value_or("")](const StreamInfo& stream) {
      return backed(makeGstreamerDecoder(element), stream);
    };
#else
    return unknown(name, "this relievo was built without GStreamer; build it with -DRELIEVO_GSTREAMER=ON");
#endif
  }
  return unknown(name, "no such decoder; it is one of: " RELIEVO_DECODER_NAMES);
}

Result<std::string> readText(const std::string& url, std::size_t most_bytes, const std::atomic<bool>& cancelled) {
  return readFfmpegText(url, most_bytes, cancelled);
}

std::unique_ptr<AudioDecoder> makeAudioDecoder() {
  return makeFfmpegAudioDecoder();
}

std::unique_ptr<SubtitleDecoder> makeSubtitleDecoder() {
  return makeFfmpegSubtitleDecoder();
}

void boundDecoderMemory() noexcept {
  boundFfmpegBlocks();
}

}  // namespace relievo::drivers
