// SPDX-License-Identifier: Apache-2.0
// Sums along a run of samples from its begin on: a window of any width costs two differences.
#include "app/enhance/edge_keeping_fit.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

namespace relievo {
namespace {

class LineFit {
 public:
  LineFit(int length, int reach) : reach_(reach), sums_(length + 1), moments_(length + 1) {}

  void run(const std::uint8_t* ends, float* codes, int length) {
    for (int begin = 0; begin < length;) {
      int end = begin + 1;
      while (ends[end - 1] == 0) ++end;
      fit(codes + begin, end - begin);
      begin = end;
    }
  }

 private:
  // No step inside.
  void fit(float* codes, int length) {
    if (length < 3) return;
    const double first = static_cast<double>(codes[0]);  // keeps the sums small
    for (int i = 0; i < length; ++i) {
      const double code = static_cast<double>(codes[i]) - first;
      sums_[i + 1] = sums_[i] + code;
      moments_[i + 1] = moments_[i] + code * i;
    }
    for (int i = 0; i < length; ++i) {
      const int a = std::max(i - reach_, 0), b = std::min(i + reach_, length - 1);
      const double n = b - a + 1, middle = 0.5 * (a + b);
      const double sum = sums_[b + 1] - sums_[a];
      double value = sum / n;
      if (middle != i) {
        const double moment = moments_[b + 1] - moments_[a] - middle * sum;
        value += 12 * moment / (n * (n * n - 1)) * (i - middle);
      }
      codes[i] = static_cast<float>(first + value);
    }
  }

  int reach_;
  std::vector<double> sums_, moments_;
};

// 1 at the last sample before a step, a hole or the end of its row.
cv::Mat endsOfRuns(const cv::Mat& codes, const cv::Mat& holes) {
  cv::Mat ends(codes.size(), CV_8U);
  for (int r = 0; r < codes.rows; ++r) {
    const float* const z = codes.ptr<float>(r);
    const auto* const hole = holes.ptr<std::uint8_t>(r);
    auto* const end = ends.ptr<std::uint8_t>(r);
    for (int c = 0; c + 1 < codes.cols; ++c) {
      end[c] = std::abs(z[c + 1] - z[c]) > DepthMap::kStep || hole[c] != hole[c + 1] ? 1 : 0;
    }
    end[codes.cols - 1] = 1;
  }
  return ends;
}

void fitRows(cv::Mat& codes, const cv::Mat& ends, int reach) {
  LineFit line(codes.cols, reach);
  for (int r = 0; r < codes.rows; ++r) line.run(ends.ptr<std::uint8_t>(r), codes.ptr<float>(r), codes.cols);
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
  for (int round = 0; round < 2; ++round) {
    fitRows(codes, across, reach);
    cv::transpose(codes, turned);
    fitRows(turned, down, reach);
    cv::transpose(turned, codes);
  }
}

}  // namespace relievo
