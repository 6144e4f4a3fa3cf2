// SPDX-License-Identifier: Apache-2.0
// Three panes side by side, and a profile as wide as all of them.
#include "app/author/preview/preview.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "platform/atomic_file.h"

extern "C" {
#include <libswscale/swscale.h>
}

namespace relievo {
namespace {

constexpr RgbPixel kWhite{255, 255, 255}, kPaper{243, 243, 243}, kGrid{222, 222, 222}, kHole{94, 53, 177};
constexpr RgbPixel kOfBefore{224, 142, 11}, kOfAfter{30, 136, 229};
constexpr int kGap = 12, kPaneRows = 432, kMostCols = 864, kProfileRows = 300;

constexpr double kMmPerCode = DisplayVolume::kDefaultDepthMm / static_cast<double>(DepthMap::kHighest);

struct Pane {
  int x = 0, y = 0, width = 0, height = 0;
};

void drawColor(RgbPicture& picture, const Pane& pane, const ColorPicture420& color) {
  const auto destroy = [](SwsContext* scaling) { sws_freeContext(scaling); };
  const std::unique_ptr<SwsContext, decltype(destroy)> scaling(
      sws_getContext(color.width, color.height, AV_PIX_FMT_YUV420P, pane.width, pane.height, AV_PIX_FMT_RGB24, SWS_AREA,
                     nullptr, nullptr, nullptr));
  if (!scaling) return;
  const int matrix = color.matrix == ColorMatrix::Bt709    ? SWS_CS_ITU709
                     : color.matrix == ColorMatrix::Bt2020 ? SWS_CS_BT2020
                                                           : SWS_CS_ITU601;
  constexpr int kOne = 1 << 16;
  sws_setColorspaceDetails(scaling.get(), sws_getCoefficients(matrix), color.range == ColorRange::Full ? 1 : 0,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kOne, kOne);
  const std::uint8_t* const from[] = {color.y.data(), color.u.data(), color.v.data()};
  const int from_stride[] = {color.width, color.width / 2, color.width / 2};
  std::uint8_t* const to[] = {picture.at(pane.x, pane.y).data()};
  const int to_stride[] = {3 * picture.width};
  sws_scale(scaling.get(), from, from_stride, 0, color.height, to, to_stride);
}

// Lambert shading by a light from above left; 1 at normal incidence.
double lightOn(double across, double down) {
  constexpr double kX = -0.5, kUp = 0.5, kNear = 0.70711;
  return std::max((-across * kX + down * kUp + kNear) / std::sqrt(across * across + down * down + 1), 0.0);
}

RgbPixel reliefAt(const DepthMap& map, int c, int r, double mm_across, double mm_down) {
  if (map.holes[map.at(c, r)] != 0) return kHole;
  const auto height = [&](int x, int y) {
    const std::size_t i = map.at(std::clamp(x, 0, map.cols - 1), std::clamp(y, 0, map.rows - 1));
    return kMmPerCode * static_cast<double>(map.codes[map.holes[i] != 0 ? map.at(c, r) : i]);
  };
  const double across = (height(c + 1, r) - height(c - 1, r)) / (2 * mm_across);
  const double down = (height(c, r + 1) - height(c, r - 1)) / (2 * mm_down);
  const double gray = (120 + 135 * height(c, r) / DisplayVolume::kDefaultDepthMm) * lightOn(across, down);
  const auto level = static_cast<std::uint8_t>(std::lround(std::min(gray, 255.0)));
  return {level, level, level};
}

void drawRelief(RgbPicture& picture, const Pane& pane, const DepthMap& map, const DisplayVolume& box) {
  const double across = box.width_mm / map.cols, down = box.height_mm / map.rows;
  for (int y = 0; y < pane.height; ++y) {
    for (int x = 0; x < pane.width; ++x) {
      picture.at(pane.x + x, pane.y + y) =
          reliefAt(map, x * map.cols / pane.width, y * map.rows / pane.height, across, down);
    }
  }
}

void drawRule(RgbPicture& picture, const Pane& pane, int y, const RgbPixel& color) {
  for (int x = 0; x < pane.width; ++x) picture.at(pane.x + x, pane.y + y) = color;
}

struct Span {
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
};
Span spanOf(const DepthMap& map, int row) {
  Span span;
  for (std::size_t i = map.at(0, row); i < map.at(0, row) + map.cols; ++i) {
    if (map.holes[i] != 0) continue;
    span = {std::min(span.low, map.codes[i]), std::max(span.high, map.codes[i])};
  }
  return span;
}

int rowOfWidestSpan(const DepthMap& map) {
  int best = map.rows / 2;
  float widest = 0;
  for (int r = 0; r < map.rows; ++r) {
    const Span span = spanOf(map, r);
    if (span.high - span.low <= widest) continue;
    widest = span.high - span.low;
    best = r;
  }
  return best;
}

// The profile of a row, with `low_mm` at the pane's bottom, clipped to the pane.
void drawProfile(RgbPicture& picture, const Pane& pane, const DepthMap& map, int row, double low_mm, double mm_per_row,
                 const RgbPixel& color, int thickness) {
  int last = -1;
  for (int x = 0; x < pane.width; ++x) {
    const std::size_t i = map.at(x * map.cols / pane.width, row);
    if (map.holes[i] != 0) {
      last = -1;
      continue;
    }
    const double above = (kMmPerCode * static_cast<double>(map.codes[i]) - low_mm) / mm_per_row;
    const int y = pane.height - 1 - static_cast<int>(std::lround(std::clamp(above, 0.0, pane.height - 1.0)));
    const auto [from, to] = std::minmax(y, last < 0 ? y : last);
    for (int at = from; at <= std::min(to + thickness - 1, pane.height - 1); ++at) {
      picture.at(pane.x + x, pane.y + at) = color;
    }
    last = y;
  }
}

void drawProfiles(RgbPicture& picture, const Pane& pane, const DepthMap& before, const DepthMap& after, int row) {
  const Span span = spanOf(after, row);
  if (span.low > span.high) return;  // nothing but holes
  constexpr double kLeastMm = 2, kMarginShare = 0.1;
  const double middle = 0.5 * kMmPerCode * static_cast<double>(span.low + span.high);
  const double shown =
      (1 + 2 * kMarginShare) * std::max(kMmPerCode * static_cast<double>(span.high - span.low), kLeastMm);
  const double low = middle - 0.5 * shown, mm_per_row = shown / pane.height;
  for (int mm = static_cast<int>(std::ceil(low)); mm < low + shown; ++mm) {
    drawRule(picture, pane, pane.height - 1 - static_cast<int>((mm - low) / mm_per_row), kGrid);
  }
  drawProfile(picture, pane, before, row, low, mm_per_row, kOfBefore, 1);
  drawProfile(picture, pane, after, row, low, mm_per_row, kOfAfter, 2);
}

}  // namespace

void Preview::before(const ColorPicture420& color, const DisplayVolume& box, const Frame& depth,
                     const DepthCalibration& calibration, std::optional<std::uint64_t> expected) {
  const std::uint64_t index = seen_++;
  if (index != 0 && (!expected || index != *expected / 2)) return;
  auto map = readDepth(depth, calibration);
  if (!map) return;  // the packager reports the error
  before_ = std::move(*map);
  color_ = color;
  time_ = depth.pts;
  box_ = box;
  waits_ = true;
}

void Preview::after(const Frame& depth, const DepthCalibration& calibration) {
  if (!waits_ || depth.pts != time_) return;
  auto map = readDepth(depth, calibration);
  if (!map) return;
  after_ = std::move(*map);
  waits_ = false;
}

Result<RgbPicture> Preview::draw() const {
  if (waits_ || after_.size() == 0) return fail(ErrorCode::NotFound, "there is no depth to show");
  const double shape = box_.width_mm / box_.height_mm;
  const int pane_cols = std::clamp(static_cast<int>(std::lround(kPaneRows * shape)), kPaneRows / 4, kMostCols);
  const int pane_rows = std::clamp(static_cast<int>(std::lround(pane_cols / shape)), 1, kPaneRows);
  RgbPicture picture(3 * pane_cols + 4 * kGap, pane_rows + kProfileRows + 3 * kGap, kPaper);
  const auto pane = [&](int i) { return Pane{kGap + i * (pane_cols + kGap), kGap, pane_cols, pane_rows}; };
  const int row = rowOfWidestSpan(after_), line = (2 * row + 1) * pane_rows / (2 * after_.rows);
  drawColor(picture, pane(0), color_);
  drawRelief(picture, pane(1), before_, box_);
  drawRelief(picture, pane(2), after_, box_);
  drawRule(picture, pane(0), line, kWhite);
  drawRule(picture, pane(1), line, kOfBefore);
  drawRule(picture, pane(2), line, kOfAfter);
  const Pane profile{kGap, pane_rows + 2 * kGap, picture.width - 2 * kGap, kProfileRows};
  for (int y = 0; y < profile.height; ++y) drawRule(picture, profile, y, kWhite);
  drawProfiles(picture, profile, before_, after_, row);
  return picture;
}

Result<void> Preview::writePng(const std::string& path) const {
  const auto picture = draw();
  if (!picture) return std::unexpected(picture.error());
  const auto png = encodePng(*picture);
  if (!png) return std::unexpected(png.error());
  auto file = AtomicFile::create(path);
  if (!file) return std::unexpected(file.error());
  file->write(*png);
  return file->commit();
}

}  // namespace relievo
