// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/picture_look.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "app/media/reading/code_count.h"
#include "app/media/reading/color_map_fit.h"
#include "app/scene/color/color_shares.h"
#include "hal/media/samples.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr int kAcross = 128, kDown = 96;  // samples examined

// Coding shifts the chroma of gray samples by a few codes.
constexpr double kGraySpread = 0.06;
constexpr double kVividSaturation = 0.8, kDarkValue = 0.15;
constexpr double kRedAlone = 0.25, kBright = 0.9;  // hues of full saturation are brighter

// A half is depth if nearly all its samples are gray (or vivid) and clearly fewer of the other half's are.
constexpr double kAllGray = 0.99, kPhotoGray = 0.7;
// A pale scene has little colour: it is taken as the other half if the picture has a break at the seam, as no photo
// has.
constexpr double kPaleGray = 0.97, kSeamStep = 0.05, kSeamTimes = 3;
constexpr double kAllVivid = 0.85, kPhotoVivid = 0.3;
constexpr double kLeastSpread = 0.03;  // a half of one brightness is not depth
constexpr double kMostDark = 0.95;

using Color = PictureColor;

// Visits the (column, row) of each examined sample.
template <class Visit>
void visit(const Frame& picture, Visit&& visit_sample) {
  const int across = std::min(kAcross, picture.width), down = std::min(kDown, picture.height);
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < across; ++i) {
      visit_sample((2 * i + 1) * picture.width / (2 * across), (2 * j + 1) * picture.height / (2 * down));
    }
  }
}

struct Sides {
  Frame first, second;
};
// The two complete halves of a picture, with chroma.
std::optional<Sides> halvesOf(const Frame& picture, Packing packing, int seam) noexcept {
  auto halves = splitPacked(picture, packing, DepthCode::Hue, GrayFrom::Luma, seam);
  if (!halves) return std::nullopt;
  return Sides{std::move(halves->color), std::move(halves->depth)};
}

bool isGrayDepth(const PictureLook& half, const PictureLook& other, bool breaks) noexcept {
  if (half.gray < kAllGray || half.spread < kLeastSpread) return false;
  return other.gray <= kPhotoGray || (other.gray <= kPaleGray && breaks);
}
bool isHueDepth(const PictureLook& half, const PictureLook& other) noexcept {
  return isHue(half) && other.vivid <= kPhotoVivid;
}
bool isRedDepth(const PictureLook& half, const PictureLook& other) noexcept {
  return isRedAlone(half) && other.red <= kPhotoVivid && half.spread >= kLeastSpread;
}

// True if `picture`, and not the half beside it, is depth. `breaks`: the whole picture has a break between the halves.
std::optional<FoundPacking> found(const Frame& picture, const Frame& beside, bool breaks, Packing packing,
                                  const char* where) {
  const PictureLook half = lookAt(picture), other = lookAt(beside);
  if (packedOrder(picture) != SampleOrder::AsStored && packedOrder(beside) == SampleOrder::AsStored) {
    return FoundPacking{packing, DepthCode::Luma, GrayFrom::Luma, print("%s, in several bytes of its colours", where)};
  }
  if (isRedDepth(half, other)) {
    return FoundPacking{packing, DepthCode::Luma, GrayFrom::Red,
                        print("%s, in red alone: %.0f %% of that half is shades of red, against %.0f %% of the other",
                              where, 100 * half.red, 100 * other.red)};
  }
  if (isGrayDepth(half, other, breaks)) {
    return FoundPacking{packing, DepthCode::Luma, GrayFrom::Luma,
                        print("%s: %.0f %% of that half is gray, against %.0f %% of the other", where, 100 * half.gray,
                              100 * other.gray)};
  }
  const auto map = bestColorMap(picture);
  if (map && map->code != DepthCode::Hue && other.vivid <= kPhotoVivid && !bestColorMap(beside)) {
    return FoundPacking{
        packing, map->code, GrayFrom::Luma,
        print("%s, as colour map %s: %.0f %% of that half lies on it", where, name(map->code), 100 * map->share)};
  }
  if (!isHueDepth(half, other)) return std::nullopt;
  return FoundPacking{packing, DepthCode::Hue, GrayFrom::Luma,
                      print("%s, as hue: %.0f %% of that half is pure colour, against %.0f %% of the other", where,
                            100 * half.vivid, 100 * other.vivid)};
}

// True if one end of the half that is not depth is depth too: three pictures in a row, or two by two.
bool isParted(const Frame& colored) {
  for (const auto& [packing, between] : {std::pair{Packing::SideBySide, colored.width / 3}, {Packing::TopBottom, 0}}) {
    const auto ends = halvesOf(colored, packing, between);
    if (!ends) continue;
    if (found(ends->first, ends->second, false, packing, "") || found(ends->second, ends->first, false, packing, ""))
      return true;
  }
  return false;
}

// True if the lower half of a half of hues is a mask of black and pure red, which codes in blue may lie beside.
bool isAboveMask(const Frame& hues) {
  constexpr double kNearlyAll = 0.95, kLeast = 0.02;
  const auto parts = halvesOf(hues, Packing::TopBottom, 0);
  if (!parts) return false;
  if (const PictureLook above = lookAt(parts->first); !isHue(above) || above.dark > kLeast) return false;
  double black = 0, red = 0, blue = 0, all = 0;
  visit(parts->second, [&](int c, int r) {
    const Color color = colorAt(parts->second, c, r);
    ++all;
    if (color.green > kRedAlone) return;
    red += color.red > kBright ? 1 : 0;
    blue += color.blue > kBright ? 1 : 0;
    black += std::max(color.red, color.blue) < kRedAlone ? 1 : 0;
  });
  return black + red + blue >= kNearlyAll * all && std::min(black, red) >= kLeast * all;
}

// What a user can make of such films.
constexpr const char* kParted =
    "a part of the colour looks like depth too: the film may show three pictures or more; keep two of one size, such "
    "as ffmpeg -i FILE -vf crop=WIDTH:HEIGHT:0:0 -crf 12 OUT.mkv";
constexpr const char* kMasked =
    "below the depth is a mask, as in Metavido's films: keep depth and colour, ffmpeg -i FILE -filter_complex "
    "\"crop=iw/2:ih/2:0:0[d];[0:v]crop=iw/2:ih:iw/2:0,scale=iw:ih/2[c];[d][c]hstack\" -crf 12 OUT.mkv";

}  // namespace

PictureColor colorAt(const Frame& f, int c, int r) noexcept {
  if (f.model == ColorModel::Gray) {  // its codes may be depth of any range
    const double y = static_cast<double>(codeAt(f, f.components[0], c, r)) / ((1U << f.components[0].bits) - 1);
    return {y, y, y};
  }
  const auto [red, green, blue] = ColorShares(f).at(c, r);
  return {std::clamp(red, 0.0, 1.0), std::clamp(green, 0.0, 1.0), std::clamp(blue, 0.0, 1.0)};
}

PictureLook lookAt(const Frame& picture) noexcept {
  PictureLook look;
  double count = 0, lit = 0, sum = 0, squares = 0;
  visit(picture, [&](int c, int r) {
    const Color color = colorAt(picture, c, r);
    const double high = std::max({color.red, color.green, color.blue});
    const double spread = high - std::min({color.red, color.green, color.blue});
    const double y = (color.red + color.green + color.blue) / 3;
    ++count;
    sum += y;
    squares += y * y;
    if (spread <= kGraySpread) ++look.gray;
    if (high <= kDarkValue) {
      ++look.dark;
      return;
    }
    ++lit;
    if (spread >= kVividSaturation * high) ++look.vivid;
    if (std::max(color.green, color.blue) <= kRedAlone * color.red) ++look.red;
    if (high < kBright) ++look.pale;
  });
  if (count == 0) return look;
  look.gray /= count;
  look.dark /= count;
  for (double* share : {&look.vivid, &look.red, &look.pale}) *share = lit > 0 ? *share / lit : 0;
  look.spread = std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
  return look;
}

Frame meansOf(const Frame& picture) {
  constexpr int kAcrossMean = 4, kParts = 3;
  Frame means;
  means.width = picture.width / kAcrossMean;
  means.height = picture.height / kAcrossMean;
  means.model = ColorModel::Rgb;
  means.range = ColorRange::Full;
  means.plane_count = 1;
  auto bytes = std::make_shared<std::vector<std::uint8_t>>();
  for (int i = 0; i < means.width * means.height; ++i) {
    Color sum;
    for (int k = 0; k < kAcrossMean * kAcrossMean; ++k) {
      const int c = kAcrossMean * (i % means.width) + k % kAcrossMean;
      const int r = kAcrossMean * (i / means.width) + k / kAcrossMean;
      const Color color = colorAt(picture, c, r);
      sum = {sum.red + color.red, sum.green + color.green, sum.blue + color.blue};
    }
    for (const double part : {sum.red, sum.green, sum.blue})
      bytes->push_back(static_cast<std::uint8_t>(std::lround(255 * part / (kAcrossMean * kAcrossMean))));
  }
  for (std::uint8_t part = 0; part < kParts; ++part)
    means.components[part] = {.offset_bytes = part, .step_bytes = kParts};
  means.planes[0] = {bytes->data(), std::ptrdiff_t{kParts} * means.width};
  means.owner = std::move(bytes);
  return means;
}

bool isHue(const PictureLook& look) noexcept {
  return look.vivid >= kAllVivid && look.dark <= kMostDark;
}

bool isRedAlone(const PictureLook& look) noexcept {
  constexpr double kAllRed = 0.95, kPale = 0.3;
  return look.red >= kAllRed && look.pale >= kPale && look.dark <= kMostDark;
}

bool isBlank(const Frame& picture) noexcept {
  constexpr double kEven = 0.012, kDark = 0.9, kOneCode = 0.98;
  if (picture.model != ColorModel::Gray) {
    const PictureLook look = lookAt(picture);
    return look.spread < kEven || look.dark > kDark;
  }
  const CodeCount count(picture);
  const std::uint32_t median = count.quantile(0.5, 0, 0xffff);
  return count.share(median, median) > kOneCode;
}

std::optional<AlphaLook> lookAtAlpha(const Frame& picture) {
  const auto halves = splitPacked(picture, Packing::Alpha, DepthCode::Luma);
  if (!halves) return std::nullopt;
  const CodeCount count(halves->depth);
  return AlphaLook{count.kinds(), count.share(1, (1u << count.bits()) - 2)};
}

bool isAlphaDepth(const AlphaLook& look) noexcept {
  constexpr int kLeastShades = 32;
  constexpr double kLeastBetween = 0.3;  // the rest are holes, or at the ends of the range
  return look.shades >= kLeastShades && look.between >= kLeastBetween;
}

bool breaksInTheMiddle(const Frame& picture, bool side_by_side) noexcept {
  constexpr int kApart = 3;  // coding smears a seam over a sample or two
  const int length = side_by_side ? picture.width : picture.height,
            across = side_by_side ? picture.height : picture.width;
  if (length < 8 * kApart) return false;
  const auto stepAt = [&](int at, int place) {
    const auto brightness = [&](int along) {
      const Color color = side_by_side ? colorAt(picture, along, place) : colorAt(picture, place, along);
      return (color.red + color.green + color.blue) / 3;
    };
    return std::abs(brightness(at) - brightness(at + kApart));
  };
  double seam = 0, beside = 0;
  const int places = std::min(kDown, across), before_seam = length / 2 - 2;
  for (int i = 0; i < places; ++i) {
    const int place = (2 * i + 1) * across / (2 * places);
    seam += stepAt(before_seam, place) / places;
    beside += (stepAt(before_seam - kApart, place) + stepAt(before_seam + kApart, place)) / (2 * places);
  }
  return seam >= kSeamStep && seam >= kSeamTimes * beside;
}

int whiteSeam(const Frame& picture) noexcept {
  constexpr int kLeast = 8, kUsual = 50, kSmeared = 6;  // coding smears its ends
  constexpr double kWhite = 0.9, kNearlyAll = 0.95;
  const int places = std::min(kDown, picture.height), middle = picture.width / 2;
  const auto isWhite = [&](int column) {
    int white = 0;
    for (int i = 0; i < places; ++i) {
      const Color color = colorAt(picture, column, (2 * i + 1) * picture.height / (2 * places));
      white += std::min({color.red, color.green, color.blue}) >= kWhite ? 1 : 0;
    }
    return white >= kNearlyAll * places;
  };
  int half = 0;
  while (half < middle / 4 && isWhite(middle - 1 - half) && isWhite(middle + half)) ++half;
  if (2 * half < kLeast || half >= middle / 4) return 0;
  return std::abs(2 * half - kUsual) <= kSmeared ? kUsual : 2 * half;
}

std::optional<FoundPacking> findPacking(const Frame& picture) {
  if (picture.model == ColorModel::Gray) return std::nullopt;
  const struct {
    Packing first, second;
    const char *first_where, *second_where;
  } ways[] = {{Packing::SideBySideDepthFirst, Packing::SideBySide, "depth left", "depth right"},
              {Packing::TopBottomDepthFirst, Packing::TopBottom, "depth above", "depth below"}};
  for (const auto& way : ways) {
    const bool beside = way.second == Packing::SideBySide;
    const int seam = beside ? whiteSeam(picture) : 0;
    const auto halves = halvesOf(picture, way.second, seam);
    if (!halves) continue;
    const bool breaks = seam > 0 || breaksInTheMiddle(picture, beside);
    auto is = found(halves->second, halves->first, breaks, way.second, way.second_where);
    const Frame& colored = is ? halves->first : halves->second;
    if (!is) is = found(halves->first, halves->second, breaks, way.first, way.first_where);
    if (!is) continue;
    const bool hues_left = is->packing == Packing::SideBySideDepthFirst && is->code == DepthCode::Hue;
    is->note = hues_left && isAboveMask(halves->first) ? kMasked : isParted(colored) ? kParted : "";
    return is;
  }
  return std::nullopt;
}

}  // namespace relievo
