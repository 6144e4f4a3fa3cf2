// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/stereo_depth.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/stereo/block_matching.h"
#include "app/stereo/edge_snapping.h"
#include "app/stereo/hole_filling.h"
#include "app/stereo/quick/outline_snapping.h"
#include "app/stereo/quick/quick_matching.h"
#include "app/stereo/quick/sub_pixel.h"

namespace relievo {
namespace {

constexpr float kHighest = 65535;
// Not OpenCV's semi-global matcher: on the sample film and two still lifes it loses up to 1.7 times as many steps, and
// up to 2.3 times as many pixels are wrong by over two pixels.
constexpr MatchingRule kRule{.slope = 8, .step = 80, .least_step = 25, .by_color = true, .diagonals = true};

// The matcher keeps three bytes for each pixel and each disparity that it tries: 0.6 GB at most.
constexpr double kMostCells = 2e8;

DisparityMap matched(const ViewPicture& left, const ViewPicture& right, DisparityRange range) {
  DisparityMap map = QuickMatching(kRule).match(left, right, range);
  fillHoles(map, left);
  snapEdges(map, left, right);
  return map;
}

DisparityMap matchedReduced(const ViewPicture& left, const ViewPicture& right, DisparityRange range, ViewSize size) {
  ViewPicture small_left, small_right;
  reduce(left, size, small_left);
  reduce(right, size, small_right);
  const double scale = static_cast<double>(size.cols) / left.cols;
  const DisparityRange small{static_cast<int>(std::floor(range.lowest * scale)),
                             static_cast<int>(std::ceil(range.highest * scale))};
  DisparityMap map(left.cols, left.rows);
  enlarge(matched(small_left, small_right, small), small_left, left, map);
  return map;
}

std::shared_ptr<std::vector<std::uint16_t>> codesOf(const DisparityMap& map, DisparityRange range) {
  auto codes = std::make_shared<std::vector<std::uint16_t>>(map.size());
  const auto low = static_cast<float>(range.lowest), span = static_cast<float>(range.highest - range.lowest);
  std::ranges::transform(map.pixels, codes->begin(), [&](float d) {
    return static_cast<std::uint16_t>(std::lround(std::clamp((d - low) / span, 0.0F, 1.0F) * kHighest));
  });
  return codes;
}

// A shot without depth, and the black before a fade, get the middle code.
std::shared_ptr<std::vector<std::uint16_t>> flatCodes(std::size_t size) {
  return std::make_shared<std::vector<std::uint16_t>>(size, static_cast<std::uint16_t>(kHighest / 2));
}

}  // namespace

ViewSize matchedSize(ViewSize view, DisparityRange range) {
  const double levels = range.highest - range.lowest + 1, cells = levels * view.cols * view.rows;
  const double scale = std::cbrt(std::min(1.0, kMostCells / cells));
  return {std::max(1, static_cast<int>(view.cols * scale)), std::max(1, static_cast<int>(view.rows * scale))};
}

DisparityMap disparityOf(const ViewPicture& left, const ViewPicture& right, DisparityRange range) {
  const ViewSize whole{left.cols, left.rows}, size = matchedSize(whole, range);
  DisparityMap map = size == whole ? matched(left, right, range) : matchedReduced(left, right, range, size);
  SubPixel().refine(map, left, right);
  return map;
}

DisparityMap plainDisparityOf(const ViewPicture& left, const ViewPicture& right, DisparityRange range,
                              PlainMatcher matcher) {
  const bool blocks = matcher == PlainMatcher::Blocks;
  const cv::Mat found = (blocks ? matchBlocks : matchPlainly)(lumaOf(left), lumaOf(right), range);
  DisparityMap map(left.cols, left.rows);
  for (int r = 0; r < map.rows; ++r) {
    const float* const row = found.ptr<float>(r);
    for (int c = 0; c < map.cols; ++c) {
      int end = c;
      while (end < map.cols && !std::isfinite(row[end])) ++end;
      const float before = c > 0 ? map.pixels[map.at(c - 1, r)] : static_cast<float>(range.highest);
      const float after = end < map.cols ? row[end] : static_cast<float>(range.highest);
      for (; c < end; ++c) map.pixels[map.at(c, r)] = std::min(before, after);
      if (c == map.cols) break;
      map.pixels[map.at(c, r)] = row[c];
      map.seen[map.at(c, r)] = 1;
    }
  }
  return map;
}

DepthCalibration StereoDepth::calibration() {
  return {.law = DepthLaw::Linear, .range = ColorRange::Full, .bits = 16};
}

Result<Frame> StereoDepth::depthOf(const Frame& left, const Frame& right) {
  for (const Frame* view : {&left, &right}) {
    if (view->width == plan_.cols && view->height == plan_.rows) continue;
    return fail(ErrorCode::Unsupported, "the picture size changes; split the film there");
  }
  const ShotPlan& shot = plan_.at(left.pts);
  const ViewPicture fixed = readView(left);
  ViewPicture moved = readView(right);
  const bool left_black = isBlank(fixed), right_black = isBlank(moved), black = left_black || right_black;
  const bool goes_on = last_ && &plan_.at(last_->pts) == &shot;
  const bool stays = black && last_ && (goes_on || (left_black && right_black));
  if (!stays && shot.has_depth && !black) {
    if (shot.is_balanced) balance(moved, shot.exposure);
    if (shot.is_aligned) moved = aligned(moved, shot.alignment);
    last_ = grayFrame(codesOf(disparityOf(fixed, moved, shot.range), shot.range), left.width, left.height);
  } else if (!stays) {
    last_ = grayFrame(flatCodes(fixed.size()), left.width, left.height);
  }
  Frame& depth = *last_;
  depth.pts = left.pts;
  depth.duration = left.duration;
  depth.sample_aspect = left.sample_aspect;
  return depth;
}

}  // namespace relievo
