// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/row_shift.h"

#include <cmath>
#include <vector>

namespace relievo {
namespace {

constexpr int kReachOf = 20;         // a part of the rows: the most that is looked for
constexpr double kAlike = 0.7;       // correlation of the rows at the shift that is taken,
constexpr double kPlainly = 0.05;    // by which it is more than that without a shift
constexpr double kLeastShift = 0.6;  // rows

// How the mean brightness changes from each row to the next but one.
std::vector<double> changesDown(const ViewPicture& view) {
  std::vector<double> means, changes;
  const std::uint8_t* pixel = view.bytes.data();
  for (int r = 0; r < view.rows; ++r) {
    double sum = 0;
    for (int c = 0; c < view.cols; ++c, pixel += 3) sum += *pixel;
    means.push_back(sum / view.cols);
  }
  for (std::size_t r = 2; r < means.size(); ++r) changes.push_back(means[r] - means[r - 2]);
  return changes;
}

double correlation(const std::vector<double>& left, const std::vector<double>& right, int shift) {
  double both = 0, of_left = 0, of_right = 0;
  for (int r = 0; r < std::ssize(left); ++r) {
    const int there = r + shift;
    if (there < 0 || there >= std::ssize(right)) continue;
    const double a = left[static_cast<std::size_t>(r)], b = right[static_cast<std::size_t>(there)];
    both += a * b;
    of_left += a * a;
    of_right += b * b;
  }
  return of_left * of_right > 0 ? both / std::sqrt(of_left * of_right) : 0;
}

}  // namespace

double rowShift(const ViewPicture& left, const ViewPicture& right) {
  const std::vector<double> a = changesDown(left), b = changesDown(right);
  const int reach = left.rows / kReachOf;
  int best = 0;
  double most = correlation(a, b, 0);
  const double unmoved = most;
  for (int shift = -reach; shift <= reach; ++shift) {
    const double alike = correlation(a, b, shift);
    if (alike <= most) continue;
    most = alike;
    best = shift;
  }
  if (most < kAlike || most - unmoved < kPlainly) return 0;
  const double before = correlation(a, b, best - 1), after = correlation(a, b, best + 1);
  const double bend = 2 * most - before - after;
  const double shift = best + (bend > 0 ? 0.5 * (after - before) / bend : 0);
  return std::abs(shift) < kLeastShift ? 0 : shift;
}

}  // namespace relievo
