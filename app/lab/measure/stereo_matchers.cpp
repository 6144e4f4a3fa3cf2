// SPDX-License-Identifier: Apache-2.0
#include "app/lab/measure/stereo_matchers.h"

#include <cmath>
#include <ctime>
#include <memory>
#include <utility>

#include "app/stereo/quick/quick_depth.h"
#include "app/stereo/stereo_depth.h"
#include "platform/print.h"

namespace relievo {
namespace {

double processorMs() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

DisparityRange rangeOf(const ViewFilmFormat& format) {
  constexpr double kSpare = 2;  // pixels
  return {static_cast<int>(std::floor(format.cols * format.disparityOf(0) - kSpare)),
          static_cast<int>(std::ceil(format.cols * format.disparityOf(TrueSurface::kVolume.depth_mm) + kSpare))};
}

Frame depthOf(const ViewFilmFormat& format, const DisparityMap& map, MediaTime time) {
  return depthOfDisparity(format, map.cols, map.rows, time,
                          [&](std::size_t i) { return static_cast<double>(map.pixels[i]) / map.cols; });
}

MatchedPair matchQuickly(const ViewFilmFormat& format, QuickDepth& quick, const Frame& left, const Frame& right) {
  const double begin = processorMs();
  const Frame codes = quick.depthOf(left, right);
  const double ms = processorMs() - begin;
  const QuickDepth::Range range = quick.range().value_or(QuickDepth::Range{});
  const auto* const code = reinterpret_cast<const std::uint16_t*>(codes.planes[0].data);  // as grayFrame lays them
  Frame depth = depthOfDisparity(format, codes.width, codes.height, codes.pts, [&](std::size_t i) {
    return static_cast<double>(range.low) + code[i] / 65535.0 * static_cast<double>(range.high - range.low);
  });
  return {std::move(depth), ms};
}

}  // namespace

Matcher Contestant::make(const ViewFilmFormat& format) const {
  if (quick_cols > 0) {
    const auto quick = std::make_shared<QuickDepth>();
    quick->setMatchedCols(quick_cols);
    return [format, quick](const Frame& left, const Frame& right) { return matchQuickly(format, *quick, left, right); };
  }
  const bool author = name == kAuthors;
  const auto plain = name == "BM" ? PlainMatcher::Blocks : PlainMatcher::SemiGlobal;
  return [format, author, plain](const Frame& left, const Frame& right) {
    const double begin = processorMs();
    const ViewPicture a = readView(left), b = readView(right);
    const double read = processorMs();
    const DisparityRange range = rangeOf(format);
    const DisparityMap map = author ? disparityOf(a, b, range) : plainDisparityOf(a, b, range, plain);
    const double ms = processorMs() - (author ? begin : read);  // the others need only the luma, a plane of the frame
    return MatchedPair{depthOf(format, map, left.pts), ms};
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
