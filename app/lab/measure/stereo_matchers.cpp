// SPDX-License-Identifier: Apache-2.0
#include "app/lab/measure/stereo_matchers.h"

#include <cmath>
#include <memory>

#include "app/stereo/quick/quick_depth.h"
#include "app/stereo/stereo_depth.h"
#include "platform/print.h"

namespace relievo {
namespace {

DisparityRange rangeOf(const ViewFilmFormat& format) {
  constexpr double kSpare = 2;  // pixels
  return {static_cast<int>(std::floor(format.cols * format.disparityOf(0) - kSpare)),
          static_cast<int>(std::ceil(format.cols * format.disparityOf(TrueSurface::kVolume.depth_mm) + kSpare))};
}

Frame depthOf(const ViewFilmFormat& format, const DisparityMap& map, MediaTime time) {
  return depthOfDisparity(format, map.cols, map.rows, time,
                          [&](std::size_t i) { return static_cast<double>(map.pixels[i]) / map.cols; });
}

Frame quickDepthOf(const ViewFilmFormat& format, QuickDepth& quick, const Frame& left, const Frame& right) {
  const Frame codes = quick.depthOf(left, right);
  const QuickDepth::Range range = quick.range().value_or(QuickDepth::Range{});
  const auto* const code = reinterpret_cast<const std::uint16_t*>(codes.planes[0].data);  // as grayFrame lays them
  return depthOfDisparity(format, codes.width, codes.height, codes.pts, [&](std::size_t i) {
    return static_cast<double>(range.low) + code[i] / 65535.0 * static_cast<double>(range.high - range.low);
  });
}

}  // namespace

Matcher Contestant::make(const ViewFilmFormat& format) const {
  if (quick_cols > 0) {
    const auto quick = std::make_shared<QuickDepth>();
    quick->setMatchedCols(quick_cols);
    return [format, quick](const Frame& left, const Frame& right) { return quickDepthOf(format, *quick, left, right); };
  }
  const bool author = name == kAuthors;
  const auto plain = name == "BM" ? PlainMatcher::Blocks : PlainMatcher::SemiGlobal;
  return [format, author, plain](const Frame& left, const Frame& right) {
    const ViewPicture a = readView(left), b = readView(right);
    const DisparityRange range = rangeOf(format);
    return depthOf(format, author ? disparityOf(a, b, range) : plainDisparityOf(a, b, range, plain), left.pts);
  };
}

std::vector<Contestant> contestantsOn(const ViewFilmFormat& film) {
  std::vector<Contestant> all{{kAuthors}, {"SGBM"}, {"BM"}};
  for (const int cols : {160, 320, 640}) {
    if (cols <= film.cols) all.push_back({print("quick %d", cols), cols});
  }
  return all;
}

}  // namespace relievo
