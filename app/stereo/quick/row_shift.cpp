// SPDX-License-Identifier: Apache-2.0
#include "app/stereo/quick/row_shift.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace relievo {
namespace {

constexpr int kReachOf = 20;                              // shifts of up to rows / kReachOf are tried
constexpr double kAlike = 0.7;                            // correlation of the rows at the shift that is taken,
constexpr double kPlainly = 0.05;                         // by which it is more than that without a shift
constexpr double kLeastShift = 0.6;                       // rows
constexpr double kBlurred = 0.4;                          // correlation of the rows of a third of a turned view
constexpr double kLeastTurn = 0.0044, kMostTurn = 0.035;  // radians

struct Columns {
  int begin = 0, end = 0;
};

// The change of the mean brightness between rows two apart.
std::vector<double> changesDown(const ViewPicture& view, Columns columns) {
  std::vector<double> means, changes;
  for (int r = 0; r < view.rows; ++r) {
    const std::uint8_t* pixel = view.pixel(columns.begin, r);
    double sum = 0;
    for (int c = columns.begin; c < columns.end; ++c, pixel += 3) sum += *pixel;
    means.push_back(sum / (columns.end - columns.begin));
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

struct Found {
  double rows = 0, alike = 0, alike_unmoved = 0;  // correlations of the rows there and where they are
};

Found findShift(const ViewPicture& left, const ViewPicture& right, Columns columns) {
  const std::vector<double> a = changesDown(left, columns), b = changesDown(right, columns);
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
  const double before = correlation(a, b, best - 1), after = correlation(a, b, best + 1);
  const double bend = 2 * most - before - after;
  return {best + (bend > 0 ? 0.5 * (after - before) / bend : 0), most, unmoved};
}

struct Turn {
  double clockwise = 0, alike = 0;  // radians; the lesser correlation
};

Turn findTurn(const ViewPicture& left, const ViewPicture& right) {
  const int third = left.cols / 3;
  if (third == 0) return {};
  const Found first = findShift(left, right, {0, third}), last = findShift(left, right, {left.cols - third, left.cols});
  return {(last.rows - first.rows) / (left.cols - third), std::min(first.alike, last.alike)};
}

}  // namespace

double rowShift(const ViewPicture& left, const ViewPicture& right) {
  const Found found = findShift(left, right, {0, left.cols});
  if (found.alike < kAlike || found.alike - found.alike_unmoved < kPlainly) return 0;
  return std::abs(found.rows) < kLeastShift ? 0 : found.rows;
}

// A turn blurs the means of rows, so a low correlation suffices to try a correction, which must then raise it much.
double turnBetween(const ViewPicture& left, const ViewPicture& right) {
  const Turn seen = findTurn(left, right);
  if (std::abs(seen.clockwise) < kLeastTurn || std::abs(seen.clockwise) > kMostTurn || seen.alike < kBlurred) return 0;
  ViewPicture straight = right;
  turnBack(straight, seen.clockwise);
  const Turn rest = findTurn(left, straight);
  return std::abs(rest.clockwise) > kLeastTurn || rest.alike < kAlike ? 0 : seen.clockwise + rest.clockwise;
}

void turnBack(ViewPicture& view, double clockwise) {
  const ViewPicture from = view;
  const double across = std::cos(clockwise), down = std::sin(clockwise);
  const double middle_x = 0.5 * (view.cols - 1), middle_y = 0.5 * (view.rows - 1);
  constexpr int kOne = 1 << 8;  // parts of a pixel
  std::uint8_t* out = view.bytes.data();
  for (int r = 0; r < view.rows; ++r) {
    for (int c = 0; c < view.cols; ++c, out += 3) {
      const double dx = c - middle_x, dy = r - middle_y;
      const double x = std::clamp(middle_x + across * dx - down * dy, 0.0, view.cols - 1.0),
                   y = std::clamp(middle_y + down * dx + across * dy, 0.0, view.rows - 1.0);
      const int i = std::min(static_cast<int>(x), std::max(view.cols - 2, 0)),
                j = std::min(static_cast<int>(y), std::max(view.rows - 2, 0));
      const int u = static_cast<int>((x - i) * kOne), v = static_cast<int>((y - j) * kOne);
      const std::uint8_t *const a = from.pixel(i, j), *const b = from.pixel(std::min(i + 1, view.cols - 1), j);
      const std::ptrdiff_t below = j + 1 < view.rows ? std::ptrdiff_t{3} * view.cols : 0;
      for (int k = 0; k < 3; ++k) {
        const int top = a[k] * (kOne - u) + b[k] * u, bottom = a[k + below] * (kOne - u) + b[k + below] * u;
        out[k] = static_cast<std::uint8_t>((top * (kOne - v) + bottom * v + kOne * kOne / 2) / (kOne * kOne));
      }
    }
  }
}

}  // namespace relievo
