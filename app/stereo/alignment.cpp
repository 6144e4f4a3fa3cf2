// SPDX-License-Identifier: Apache-2.0
// Least squares on the vertical positions of the points, with Tukey's weights, starting from the median shift.
#include "app/stereo/alignment.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "app/stereo/block_matching.h"

namespace relievo {
namespace {

constexpr float kAlone = 0.8F;  // of the second-best description's distance
constexpr double kWidest = 0.25, kHighest = 0.1;
constexpr float kFaint = 0.0001F;  // least response of a point
constexpr int kMostPoints = 2000;  // of a view
constexpr int kRounds = 20;

double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Described {
  std::vector<cv::KeyPoint> points;
  cv::Mat words;
};
Described describe(const ViewPicture& view) {
  Described found;
  const cv::Mat luma = lumaOf(view);
  const auto finder = cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, kFaint);
  finder->detect(luma, found.points);
  cv::KeyPointsFilter::retainBest(found.points, kMostPoints);
  finder->compute(luma, found.points, found.words);
  return found;
}

// y of the left less y of the right = a + b x + c y of the right.
struct HeightModel {
  double a = 0, b = 0, c = 0;
  [[nodiscard]] double rest(const PointPair& p) const {
    const double x = p.right_x, y = p.right_y;
    return p.left_y - y - a - b * x - c * y;
  }
};

HeightModel weighted(const std::vector<PointPair>& pairs, const HeightModel& before, double reach) {
  cv::Matx33d normal = cv::Matx33d::zeros();
  cv::Vec3d right(0, 0, 0);
  for (const PointPair& p : pairs) {
    const double away = before.rest(p) / reach;
    if (std::abs(away) >= 1) continue;
    const double w = (1 - away * away) * (1 - away * away);
    const cv::Vec3d row(1, p.right_x, p.right_y);
    normal += w * (row * row.t());
    right += w * (p.left_y - p.right_y) * row;
  }
  cv::Vec3d solved;
  if (!cv::solve(normal, right, solved, cv::DECOMP_SVD)) return before;
  return {solved[0], solved[1], solved[2]};
}

std::vector<double> restsOf(const std::vector<PointPair>& pairs, const HeightModel& model) {
  std::vector<double> rests;
  rests.reserve(pairs.size());
  for (const PointPair& p : pairs) rests.push_back(std::abs(model.rest(p)));
  return rests;
}

}  // namespace

std::vector<PointPair> findPairs(const ViewPicture& left, const ViewPicture& right) {
  const Described of_left = describe(left), of_right = describe(right);
  std::vector<PointPair> pairs;
  if (of_left.points.empty() || of_right.points.size() < 2) return pairs;
  std::vector<std::vector<cv::DMatch>> near;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(of_left.words, of_right.words, near, 2);
  const cv::Point2d middle(0.5 * (left.cols - 1), 0.5 * (left.rows - 1));
  for (const auto& both : near) {
    if (both.size() < 2 || both[0].distance > kAlone * both[1].distance) continue;
    const cv::Point2d l = cv::Point2d(of_left.points[static_cast<std::size_t>(both[0].queryIdx)].pt) - middle;
    const cv::Point2d r = cv::Point2d(of_right.points[static_cast<std::size_t>(both[0].trainIdx)].pt) - middle;
    const bool far = std::abs(l.x - r.x) > kWidest * left.cols || std::abs(l.y - r.y) > kHighest * left.rows;
    if (!far) pairs.push_back({l.x, l.y, r.x, r.y});
  }
  return pairs;
}

double Alignment::reach(int cols, int rows) const {
  return std::abs(shift) + std::abs(turn) * cols / 2 + std::abs(zoom - 1) * rows / 2;
}

AlignmentFit fitAlignment(const std::vector<PointPair>& pairs) {
  constexpr double kLeastReach = 1, kRests = 4;  // pixels, and times the median
  if (static_cast<int>(pairs.size()) < kLeastPairs) return {};
  std::vector<double> shifts;
  shifts.reserve(pairs.size());
  for (const PointPair& p : pairs) shifts.push_back(p.left_y - p.right_y);
  HeightModel model{.a = medianOf(shifts)};
  for (int i = 0; i < kRounds; ++i) {
    model = weighted(pairs, model, std::max(kLeastReach, kRests * medianOf(restsOf(pairs, model))));
  }
  const double zoom = 1 + model.c;
  return {{.shift = model.a, .turn = model.b / zoom, .zoom = zoom},
          medianOf(restsOf(pairs, model)),
          static_cast<int>(pairs.size())};
}

ViewPicture aligned(const ViewPicture& right, const Alignment& alignment) {
  const double x = 0.5 * (right.cols - 1), y = 0.5 * (right.rows - 1);
  const double scale = alignment.zoom, turned = alignment.zoom * alignment.turn;
  const cv::Matx23d place(scale, -turned, x - scale * x + turned * y,  //
                          turned, scale, y + alignment.shift - scale * y - turned * x);
  ViewPicture moved(right.cols, right.rows);
  cv::Mat result = asMat(moved);
  cv::warpAffine(asMat(right), result, place, result.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return moved;
}

}  // namespace relievo
