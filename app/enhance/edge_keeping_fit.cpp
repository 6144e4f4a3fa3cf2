// SPDX-License-Identifier: Apache-2.0
// Inside a run of samples the fit is a mean, from prefix sums; near the run's ends it is computed in full.
#include "app/enhance/edge_keeping_fit.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "app/enhance/in_bands.h"

namespace relievo {
namespace {

class LineFit {
 public:
  LineFit(int length, int reach) : reach_(reach), sums_(length + 1), before_(length) {}

  // A run ends after each sample marked 1 in `ends`; the last one always is.
  void row(const std::uint8_t* ends, float* codes, int length) {
    std::copy_n(codes, length, before_.begin());
    for (int begin = 0; begin < length;) {
      int end = begin + 1;
      while (ends[end - 1] == 0) ++end;
      if (end - begin > 2) run(before_.data() + begin, codes + begin, end - begin);
      begin = end;
    }
  }

 private:
  // If the window is symmetric, the line's value is the mean.
  void run(const float* codes, float* out, int length) {
    const int inner_end = length - reach_;
    for (int i = 0; i < std::min(reach_, length); ++i) out[i] = atEnd(codes, i, length);
    for (int i = std::max(inner_end, reach_); i < length; ++i) out[i] = atEnd(codes, i, length);
    if (inner_end <= reach_) return;
    for (int i = 0; i < length; ++i) sums_[i + 1] = sums_[i] + static_cast<double>(codes[i]);
    const double share = 1.0 / (2 * reach_ + 1);
    for (int i = reach_; i < inner_end; ++i) {
      out[i] = static_cast<float>((sums_[i + reach_ + 1] - sums_[i - reach_]) * share);
    }
  }

  [[nodiscard]] float atEnd(const float* codes, int i, int length) const {
    const int a = std::max(i - reach_, 0), b = std::min(i + reach_, length - 1);
    const float n = static_cast<float>(b - a + 1), middle = 0.5F * static_cast<float>(a + b);
    float sum = 0, moment = 0;
    for (int k = a; k <= b; ++k) {
      const float code = codes[k] - codes[i];  // keeps the sums small
      sum += code;
      moment += code * (static_cast<float>(k) - middle);
    }
    return codes[i] + sum / n + 12 * moment / (n * (n * n - 1)) * (static_cast<float>(i) - middle);
  }

  int reach_;
  std::vector<double> sums_;
  std::vector<float> before_;
};

// 1 at the last sample before a step, a hole or the end of its row.
cv::Mat endsOfRuns(const cv::Mat& codes, const cv::Mat& holes) {
  cv::Mat ends(codes.size(), CV_8U);
  inBands(codes.rows, [&](int first, int last) {
    for (int r = first; r < last; ++r) {
      const float* const z = codes.ptr<float>(r);
      const auto* const hole = holes.ptr<std::uint8_t>(r);
      auto* const end = ends.ptr<std::uint8_t>(r);
      for (int c = 0; c + 1 < codes.cols; ++c) {
        end[c] = static_cast<std::uint8_t>((std::abs(z[c + 1] - z[c]) > DepthMap::kStep) | (hole[c] != hole[c + 1]));
      }
      end[codes.cols - 1] = 1;
    }
  });
  return ends;
}

void fitRows(cv::Mat& codes, const cv::Mat& ends, int reach) {
  inBands(codes.rows, [&](int first, int last) {
    LineFit line(codes.cols, reach);
    for (int r = first; r < last; ++r) line.row(ends.ptr<std::uint8_t>(r), codes.ptr<float>(r), codes.cols);
  });
}

}  // namespace

void fitLines(DepthMap& map, int reach) {
  if (reach < 1 || map.size() == 0) return;
  cv::Mat codes(map.rows, map.cols, CV_32F, map.codes.data());
  const cv::Mat holes(map.rows, map.cols, CV_8U, map.holes.data());
  cv::Mat turned, turned_holes;
  cv::transpose(codes, turned);
  cv::transpose(holes, turned_holes);
  const cv::Mat across = endsOfRuns(codes, holes), down = endsOfRuns(turned, turned_holes);
  turned_holes.release();
  for (int round = 0; round < 2; ++round) {
    fitRows(codes, across, reach);
    cv::transpose(codes, turned);
    fitRows(turned, down, reach);
    cv::transpose(turned, codes);
  }
}

}  // namespace relievo
