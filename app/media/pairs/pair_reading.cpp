// SPDX-License-Identifier: Apache-2.0
// Finds out where a film's depth is, while the film is opened.
#include <algorithm>
#include <utility>

#include "app/media/film_folder.h"
#include "app/media/pairs/pair_film.h"
#include "app/media/reading/code_count.h"
#include "app/media/reading/color_map_fit.h"
#include "app/media/reading/float_reading.h"
#include "app/media/reading/picture_look.h"
#include "app/media/reading/stereo/stereo_pair.h"
#include "hal/media/media_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kAllGray = 0.99;

// True if the name of the file or of its folder has a word for depth.
bool namesDepth(const std::string& url) {
  return saysDepth(url) || saysDisparity(url) || saysDepth(url.substr(0, url.rfind('/')));
}

// Floating-point numbers, a sensor's codes and a colour map are depth; so are gray, hues and a ramp of blue in a file
// whose name says depth.
bool isDepthAlone(const Frame& picture, const std::string& url) {
  if (picture.value_per_code != 0) return true;
  if (picture.model == ColorModel::Gray && picture.components[0].bits > 8) return true;  // no photo has as many shades
  const bool may_be_codes =
      picture.model == ColorModel::Gray || hasEqualColors(picture) || packedOrder(picture) != SampleOrder::AsStored;
  if (may_be_codes && sensorKind(picture, CodeCount(picture)) != nullptr) return true;
  if (namesDepth(url) && lookAt(picture).gray >= kAllGray) return true;
  const auto map = bestColorMap(picture);
  if (!map) return false;
  return saysDepth(url) || (map->code != DepthCode::Hue && map->code != DepthCode::Kinect);
}

// The second source; else the first file of a recording's depth. Empty if there is neither.
std::string depthFileOf(const MediaSource& source, const std::string& depth_url) {
  const StreamInfo* const depth = depth_url.empty() ? findDepthTrack(source) : nullptr;
  if (depth == nullptr) return depth_url;
  const auto file = depth->tags.find(kFileTag);
  return file != depth->tags.end() ? file->second : "";
}

// The rows above the picture that are white but for words: a caption. 0 if there are none.
int captionRows(const Frame& picture) {
  constexpr int kAcross = 200, kLeast = 8;
  constexpr double kWhite = 0.9, kMostly = 0.7;
  const int across = std::min(kAcross, picture.width);
  const auto is_white = [&](int r) {
    int white = 0;
    for (int i = 0; i < across; ++i) {
      const PictureColor color = colorAt(picture, (2 * i + 1) * picture.width / (2 * across), r);
      white += std::min({color.red, color.green, color.blue}) >= kWhite ? 1 : 0;
    }
    return white >= kMostly * across;
  };
  int rows = 0;
  while (rows < picture.height / 2 && is_white(rows)) ++rows;
  return rows < kLeast || rows == picture.height / 2 ? 0 : rows;
}

// Depth Anything's first version writes the picture, white columns and its depth, all under a caption.
std::string captionLine(const Frame& look, bool still) {
  const int rows = whiteSeam(look) > 0 ? captionRows(look) : 0;
  if (rows == 0) return "";
  return print(
      "white columns part two pictures below a caption of %d rows; if one is depth, cut it off: ffmpeg -i FILE "
      "-vf crop=iw:ih-%d:0:%d %s",
      rows, rows, rows, still ? "OUT.png" : "-crf 12 OUT.mkv");
}

// The luma of shades of red alone: from black to the share of red in white.
CalibrationSettings redAsLuma(const Frame& picture) {
  if (picture.model != ColorModel::Yuv) return {};
  const bool full = picture.range == ColorRange::Full;
  const double scale = 1 << (picture.components[0].bits - 8);
  const double low = full ? 0 : 16 * scale, reach = (full ? 255 : 219) * scale * lumaWeights(picture).red;
  return {{"codes", print("%.0f-%.0f", low, low + reach)}};
}

}  // namespace

// Collects what the user has stated, and what the recording's folder and files show.
void PairReader::Impl::lookAround() {
  const MediaSource& source = sources.color()->source();
  clues = {.command_line = options.command_line, .side_file = options.side_file, .as = options.as, .place = {}};
  packed.gray = GrayFrom::Luma;
  views = {};
  reordering.kind = nullptr;
  clues.place = lookAtTags(source.tags());
  if (clues.place.kind == nullptr) clues.place = lookAtPlace(options.url, depthFileOf(source, options.depth_url));
  reordering.order = options.as != nullptr ? options.as->order : SampleOrder::AsStored;
  info.reading = {};
  if (options.depth_code) {
    clues.code = *options.depth_code;
    clues.code_by = CalibrationOrigin::CommandLine;
  } else if (options.as != nullptr && options.as->code) {
    clues.code = *options.as->code;
    clues.code_by = CalibrationOrigin::StatedKind;
  }
}

// If nothing states where the depth is and there is only one track, the picture itself may show it.
void PairReader::Impl::lookForHalves(const StreamInfo& color) {
  if (options.packing != Packing::Auto || !options.depth_url.empty() || depth_beside.stream != nullptr || isPacked())
    return;
  if (options.registration) return;
  const Frame look = scout.tellingPicture(color_ahead[0], options.url, color.index);
  if (takeSaidViews(color, look) || lookForAlpha(color, look)) return;
  if (isDepthAlone(look, options.url)) {
    info.packing = Packing::DepthAlone;
    clues.packing_by = CalibrationOrigin::FirstPicture;
    clues.why.emplace_back("depth without colour: it is shown as gray");
    return;
  }
  auto found = findPacking(look);
  if (!found && color.codec == "gif") found = findPacking(meansOf(look));
  if (std::string caption = captionLine(look, info.duration == Duration(0)); !caption.empty())
    info.notes.push_back(std::move(caption));
  if (!found) {
    lookForViews(look);
    const PictureLook seen = lookAt(look);
    const char* const like = seen.gray >= kAllGray ? "gray" : isHue(seen) ? "of pure colours" : nullptr;
    if (info.packing == Packing::Tracks && like != nullptr) {
      info.notes.push_back(print("the picture is %s; if it is depth: --packing depth-alone", like));
    }
    return;
  }
  info.packing = found->packing;
  clues.packing_by = CalibrationOrigin::FirstPicture;
  if (clues.code_by == CalibrationOrigin::Default) {
    clues.code = found->code;
    clues.code_by = CalibrationOrigin::FirstPicture;
    packed.gray = found->gray;
    if (packed.gray == GrayFrom::Red) clues.pictures.merge(redAsLuma(look));
  }
  clues.why.push_back(std::move(found->why));
  if (found->parted) {
    info.notes.push_back(
        "a part of the colour looks like depth too: the film may show three pictures or more; keep two of one size, "
        "such as ffmpeg -i FILE -vf crop=WIDTH:HEIGHT:0:0 -crf 12 OUT.mkv");
  }
}

// Returns the first depth picture with its samples in order; the order may be found only from the picture itself.
Result<const Frame*> PairReader::Impl::firstDepth() {
  auto first = depth->peek();
  if (!first || *first == nullptr || registrar) return first;
  if (reordering.order != SampleOrder::AsStored) return firstAsStated(**first);
  const StreamInfo& stream = depthStream();
  takeTags(stream);
  const Frame look = scout.tellingPicture(**first, depthUrl(), stream.index);
  const KnownKind* const kind = kindOf(clues, look);
  const SampleOrder order = kind != nullptr && kind->order != SampleOrder::AsStored ? kind->order : orderOf(kind, look);
  if (order == SampleOrder::AsStored) return first;
  reordering.kind = kind;
  reordering.order = order;
  reordering.again = **first;
  depth.emplace([this] { return supplyDepth(); });
  return depth->peek();
}

// Returns the first depth picture of a stated kind; its reader may already have put the samples in order.
Result<const Frame*> PairReader::Impl::firstAsStated(const Frame& first) {
  if (options.as == nullptr || reordering.order != SampleOrder::Swapped) return &first;
  auto stored = inOrder(first, SampleOrder::Swapped);  // back
  if (!stored) return std::unexpected(stored.error());
  reordering.order = orderOf(*options.as, *stored);
  if (reordering.order != SampleOrder::AsStored) return &first;
  reordering.again = std::move(*stored);
  depth.emplace([this] { return supplyDepth(); });
  return depth->peek();
}

}  // namespace relievo
