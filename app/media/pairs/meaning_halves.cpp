// SPDX-License-Identifier: Apache-2.0
// Depth in the colour's picture, and depth without colour.
#include <algorithm>
#include <optional>
#include <utility>

#include "app/media/folder/film_folder.h"
#include "app/media/pairs/film_meaning.h"
#include "app/media/reading/code_count.h"
#include "app/media/reading/color_map_fit.h"
#include "app/media/reading/float_reading.h"
#include "hal/media/media_names.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kAllGray = 0.99;

// An AVI file does not say more of such pictures than their bits.
constexpr const char* kRaw16 =
    "its raw pictures of 16 bits are read as colours of 5 bits each; if they are depth: ffmpeg -i FILE -f rawvideo - | "
    "ffmpeg -f rawvideo -pix_fmt gray16le -video_size WIDTHxHEIGHT -framerate F -i - -c:v ffv1 OUT.mkv";

// True if the name of the file or of its folder has a word for depth.
bool namesDepth(const std::string& url) {
  return saysDepth(url) || saysDisparity(url) || saysDepth(url.substr(0, url.rfind('/')));
}

// Floating-point numbers, a sensor's codes and a colour map are depth; so are gray, hues and a ramp of blue in a file
// whose name says depth.
bool isDepthAlone(const Frame& picture, const std::string& url, const std::string& file) {
  if (picture.value_per_code != 0) return true;
  if (picture.model == ColorModel::Gray && picture.components[0].bits > 8) return true;  // no photo has as many shades
  const bool may_be_codes =
      picture.model == ColorModel::Gray || hasEqualColors(picture) || packedOrder(picture) != SampleOrder::AsStored;
  if (may_be_codes && sensorKind(picture, CodeCount(picture)) != nullptr) return true;
  if ((namesDepth(url) || saysDepth(file)) && lookAt(picture).gray >= kAllGray) return true;
  const auto map = bestColorMap(picture);
  if (!map) return false;
  return saysDepth(url) || saysDepth(file) || (map->code != DepthCode::Hue && map->code != DepthCode::Kinect);
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

// The layout of a picture without colour of which one half is smooth, as depth is, and the other as rough as a photo.
// Black-and-white photos, too, have a smooth sky: a guess, to be told in a note.
std::optional<Packing> smoothHalf(const Frame& look) {
  constexpr double kTimes = 4, kRough = 0.02, kFewShades = 1;  // what roughnessOf says of those
  for (const auto& [first, second] : {std::pair(Packing::SideBySideDepthFirst, Packing::SideBySide),
                                      std::pair(Packing::TopBottomDepthFirst, Packing::TopBottom)}) {
    const auto halves = splitPacked(look, second, DepthCode::Hue);
    if (!halves) continue;
    const double before = roughnessOf(halves->color), behind = roughnessOf(halves->depth);
    const double rough = std::max(before, behind), smooth = std::min(before, behind);
    if (rough == kFewShades || rough < kRough || kTimes * smooth >= rough) continue;
    return smooth == before ? first : second;
  }
  return std::nullopt;
}

// Whether the first or the last word of the file's name says depth: no title of several words, nor a folder's name.
bool beginsOrEndsWithDepth(const std::string& url) {
  const std::string name = url.substr(url.rfind('/') + 1), stem(stemOf(name));
  const std::vector<std::string> words = wordsOf(stem);
  const bool title = stem.find_first_of(" .") != stem.npos;
  const auto isDepth = [](const std::string& word) {
    return std::ranges::find(kDepthWords, word) != kDepthWords.end();
  };
  return !title && !words.empty() && (isDepth(words.front()) || isDepth(words.back()));
}

// For a picture in colours whose name says depth: a small palette hides its colour map.
std::string namedLine(const Frame& look) {
  const auto map = bestColorMap(look);
  return print(
      "its name says depth, but its colours are of %s, and it plays flat; if it is depth: --packing depth-alone "
      "--depth-code %s",
      map ? "a small palette" : "no known map", map ? name(map->code) : "turbo (or jet, ..)");
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

// Finds the depth code by the colours of a picture.
void FilmMeaning::lookForCode(const Frame& look) {
  if (clues_.code_by != CalibrationOrigin::Default || look.model == ColorModel::Gray) return;
  const PictureLook seen = lookAt(look);
  if (isRedAlone(seen) || packedOrder(look) != SampleOrder::AsStored) return;
  const auto map = bestColorMap(look);
  if (!map && !isHue(seen)) return;
  takeCode(map ? map->code : DepthCode::Hue, CalibrationOrigin::FirstPicture);
  clues_.why.push_back(
      clues_.code == DepthCode::Hue
          ? print("%.0f %% of the depth is pure colour: read as hue", 100 * seen.vivid)
          : print("%.0f %% of the depth lies on the colour map %s", 100 * map->share, name(map->code)));
}

// Finds the code and, of depth in colours, the matrix, which the picture then states.
void FilmMeaning::lookForColors(Frame& depth) {
  lookForCode(depth);
  form_.matrix = matrixOf(depth, clues_.code);
  form_.stateMatrix(depth);
}

// If nothing states where the depth is and there is only one track, the picture itself may show it.
void FilmMeaning::lookForHalves(const StreamInfo& color, const std::deque<Frame>& pictures) {
  const SourceOptions& options = film_.options;
  FilmInfo& info = film_.info;
  const bool elsewhere = !options.depth_url.empty() || film_.depth_beside.stream != nullptr || options.registration;
  if (options.packing != Packing::Auto || elsewhere || film_.isPacked()) return;
  const Frame look = scout_.tellingPicture(pictures[0], options.url, color.index);
  if (takeSaidViews(color, look, pictures) || lookForAlpha(color, look)) return;
  const auto file = color.tags.find(kFileTag);  // of a series: its first picture
  if (isDepthAlone(look, options.url, file == color.tags.end() ? "" : file->second)) {
    info.packing = Packing::DepthAlone;
    clues_.packing_by = CalibrationOrigin::FirstPicture;
    clues_.why.emplace_back("depth without colour: it is shown as gray");
    return;
  }
  auto found = findPacking(look);
  if (!found && color.codec == "gif") found = findPacking(meansOf(look));
  if (std::string caption = captionLine(look, info.duration == Duration(0)); !caption.empty())
    info.notes.push_back(std::move(caption));
  if (found) return takeHalves(std::move(*found), look);
  const bool gray = lookAt(look).gray >= kAllGray;
  lookForViews(look);
  if (color.codec == "rawvideo" && color.pixel_format == "rgb555le") info.reading.doubts.emplace_back(kRaw16);
  const char* const like = gray ? "gray" : isHue(lookAt(look)) ? "of pure colours" : nullptr;
  if (info.packing != Packing::Tracks) return;
  if (like != nullptr) info.notes.push_back(print("the picture is %s; if it is depth: --packing depth-alone", like));
  else if (namesDepth(options.url))
    (beginsOrEndsWithDepth(options.url) ? info.reading.doubts : info.notes)
        .push_back(namedLine(color.codec == "gif" ? meansOf(look) : look));
  if (const auto half = gray ? smoothHalf(look) : std::nullopt)
    info.notes.push_back(
        print("one half of it is as smooth as depth beside a photo; if it is: --packing %s", name(*half)));
}

void FilmMeaning::takeHalves(FoundPacking found, const Frame& look) {
  film_.info.packing = found.packing;
  clues_.packing_by = CalibrationOrigin::FirstPicture;
  if (clues_.code_by == CalibrationOrigin::Default) {
    takeCode(found.code, CalibrationOrigin::FirstPicture);
    form_.gray = found.gray;
    if (form_.gray == GrayFrom::Red) clues_.pictures.merge(redAsLuma(look));
  }
  clues_.why.push_back(std::move(found.why));
  if (!found.note.empty()) film_.info.notes.push_back(std::move(found.note));
}

// The samples are put in order as they are read.
Result<void> FilmMeaning::describeAlone(const StreamInfo& track, const Frame& picture) {
  Frame look = scout_.tellingPicture(picture, film_.options.url, track.index);
  lookForColors(look);
  takeTags(track);
  const KnownKind* const kind = kindOf(clues_, look);
  form_.order = orderOf(kind, look);
  if (form_.order != SampleOrder::AsStored) {
    kind_ = kind;
    auto ordered = inOrder(look, form_.order);
    if (!ordered) return film_.failOn(film_.options.url, ordered.error());
    look = std::move(*ordered);
  }
  return describe(picture, look, {}, track);
}

Result<void> FilmMeaning::describeHalves(const StreamInfo& color, const Frame& picture) {
  const Packing packing = film_.info.packing;
  const Frame look = scout_.tellingPicture(picture, film_.options.url, color.index);
  const bool beside = packing == Packing::SideBySide || packing == Packing::SideBySideDepthFirst;
  form_.seam = beside ? whiteSeam(look) : 0;
  if (form_.seam > 0) {
    clues_.why.push_back(print("the %d white columns between the halves are left out", form_.seam));
  }
  auto whole = splitPacked(look, packing, DepthCode::Hue, GrayFrom::Luma, form_.seam);
  if (whole) lookForColors(whole->depth);
  if (whole && clues_.code == DepthCode::Luma && film_.options.as == nullptr) form_.order = packedOrder(whole->depth);
  const auto seen = form_.halvesOf(look, packing);
  const auto halves = form_.halvesOf(picture, packing);
  if (!halves || !seen) return film_.failOn(film_.options.url, halves ? seen.error() : halves.error());
  film_.info.color_width = halves->color.width;
  film_.info.color_height = halves->color.height;
  // A half of YUV as it is still has its signalling and its chroma.
  const bool in_yuv = whole && look.model == ColorModel::Yuv && form_.gray == GrayFrom::Luma;
  const Frame& depth_look = in_yuv ? whole->depth : seen->depth;
  return describe(halves->depth, depth_look, seen->color, color);
}

Result<void> FilmMeaning::measureHalves(const Frame& picture) {
  if (!film_.isPacked() || film_.info.packing == Packing::DepthAlone) return {};
  const auto halves = form_.halvesOf(picture, film_.info.packing);
  if (!halves) return film_.failOn(film_.options.url, halves.error());
  film_.info.color_width = halves->color.width;
  film_.info.color_height = halves->color.height;
  return {};
}

}  // namespace relievo
