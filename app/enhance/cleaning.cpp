// SPDX-License-Identifier: Apache-2.0
// The few samples that are unknown or near a step are processed one by one, all others in whole rows.
#include "app/enhance/cleaning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "app/enhance/in_bands.h"
#include "app/enhance/wide_areas.h"

namespace relievo {
namespace {

constexpr int kReach = 2;  // half width of a window of 5 x 5 samples

cv::Mat viewOf(std::vector<float>& codes, const DepthMap& map) {
  return {map.rows, map.cols, CV_32F, codes.data()};
}
cv::Mat viewOf(std::vector<std::uint8_t>& mask, const DepthMap& map) {
  return {map.rows, map.cols, CV_8U, mask.data()};
}

// The number of the window's samples, along one axis, that lie inside the picture.
int inside(int at, int size) {
  return std::min(at + kReach, size - 1) - std::max(at - kReach, 0) + 1;
}

// For each sample, how many of its eight known neighbours have a similar code. Each pair is compared once, in whole
// rows.
std::vector<std::uint8_t> countAlikeNearby(const DepthMap& map, float alike) {
  std::vector<std::uint8_t> counts(map.size());
  const auto compare = [&](std::size_t first, std::ptrdiff_t away, int count) {
    const float *const a = map.codes.data() + first, *const b = a + away;
    const std::uint8_t *const hole_a = map.holes.data() + first, *const hole_b = hole_a + away;
    std::uint8_t *const of_a = counts.data() + first, *const of_b = of_a + away;
    std::array<std::uint8_t, 64> both{};
    for (int done = 0; done < count; done += static_cast<int>(both.size())) {
      const int end = std::min(count - done, static_cast<int>(both.size()));
      for (int i = 0; i < end; ++i) {
        const bool is = std::abs(b[done + i] - a[done + i]) <= alike;
        both[i] = static_cast<std::uint8_t>(static_cast<int>(is) & ~(hole_a[done + i] | hole_b[done + i]));
      }
      for (int i = 0; i < end; ++i) of_a[done + i] = static_cast<std::uint8_t>(of_a[done + i] + both[i]);
      for (int i = 0; i < end; ++i) of_b[done + i] = static_cast<std::uint8_t>(of_b[done + i] + both[i]);
    }
  };
  for (int r = 0; r < map.rows; ++r) {
    compare(map.at(0, r), 1, map.cols - 1);
    if (r + 1 == map.rows) break;
    compare(map.at(0, r), map.cols, map.cols);
    compare(map.at(0, r), map.cols + 1, map.cols - 1);
    compare(map.at(1, r), map.cols - 1, map.cols - 1);
  }
  return counts;
}

int countAlike(const DepthMap& map, int c, int r, float alike) {
  const float code = map.codes[map.at(c, r)];
  int count = -1;  // minus the sample itself
  for (int y = std::max(r - kReach, 0); y <= std::min(r + kReach, map.rows - 1); ++y) {
    for (int x = std::max(c - kReach, 0); x <= std::min(c + kReach, map.cols - 1); ++x) {
      const std::size_t i = map.at(x, y);
      count += map.holes[i] == 0 && std::abs(map.codes[i] - code) <= alike ? 1 : 0;
    }
  }
  return count;
}

// 1 where a known sample resembles too few of the 24 around it; at the picture's corners fewer are required. For nearly
// all samples the eight nearest suffice to decide.
std::vector<std::uint8_t> findOutliers(const DepthMap& map, float noise) {
  constexpr int kAlike = 3, kOneOf = 4;
  const float alike = DepthMap::kStep + 4 * noise;
  std::vector<std::uint8_t> outliers = countAlikeNearby(map, alike);
  for (int r = 0; r < map.rows; ++r) {
    for (int c = 0; c < map.cols; ++c) {
      std::uint8_t& outlier = outliers[map.at(c, r)];
      if (outlier >= kAlike || map.holes[map.at(c, r)] != 0) {
        outlier = 0;
        continue;
      }
      const int wanted = std::min(kAlike, (inside(c, map.cols) * inside(r, map.rows) - 1) / kOneOf);
      outlier = countAlike(map, c, r, alike) < wanted ? 1 : 0;
    }
  }
  return outliers;
}

// The nearest known sample in each of 32 directions, with its distance.
class Surroundings {
 public:
  Surroundings(const DepthMap& map, const std::vector<std::uint8_t>& unknown, int c, int r, int farthest) {
    for (const auto& [dc, dr] : kDirections) {
      for (int d = 1; d <= farthest; ++d) {
        const int x = c + d * dc, y = r + d * dr;
        if (x < 0 || y < 0 || x >= map.cols || y >= map.rows) break;
        const std::size_t i = map.at(x, y);
        if (unknown[i] != 0) continue;
        codes_[count_] = map.codes[i];
        weights_[count_++] = 1.0F / (static_cast<float>(d) * std::sqrt(static_cast<float>(dc * dc + dr * dr)));
        break;
      }
    }
  }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  // The farthest code, unless more directions see another one. In a fully enclosed hole a majority of one is enough,
  // since such a hole lies across an edge by chance. A long hole probably lies beside a near object, and there a
  // majority of a quarter of the directions is required.
  [[nodiscard]] float mostSeen(float alike) const {
    const int more = count_ == static_cast<int>(kDirections.size()) ? 1 : kDirections.size() / 4;
    float best = *std::min_element(begin(), end());
    int wanted = seen(best, alike) + more;
    for (int i = 0; i < count_; ++i) {
      if (seen(codes_[i], alike) < wanted) continue;
      best = codes_[i];
      wanted = seen(best, alike) + 1;
    }
    return best;
  }
  // Inverse-distance mean over the samples that continue `code`.
  [[nodiscard]] float meanAround(float code, float alike) const {
    float sum = 0, weight = 0;
    for (int i = 0; i < count_; ++i) {
      if (std::abs(codes_[i] - code) > alike) continue;
      sum += weights_[i] * codes_[i];
      weight += weights_[i];
    }
    return sum / weight;
  }

 private:
  // Directions to the samples within three rows and columns that no other sample hides.
  static constexpr auto kDirections = [] {
    std::array<std::pair<int, int>, 32> all{};
    std::size_t count = 0;
    for (int dr = -3; dr <= 3; ++dr) {
      for (int dc = -3; dc <= 3; ++dc) {
        if (std::gcd(dc, dr) == 1) all[count++] = {dc, dr};
      }
    }
    return all;
  }();
  [[nodiscard]] int seen(float code, float alike) const {
    return static_cast<int>(
        std::count_if(begin(), end(), [&](float other) { return std::abs(other - code) <= alike; }));
  }
  [[nodiscard]] const float* begin() const { return codes_.data(); }
  [[nodiscard]] const float* end() const { return codes_.data() + count_; }

  std::array<float, kDirections.size()> codes_{}, weights_{};
  int count_ = 0;
};

// Whether the 5 x 5 samples, row by row, lie on a plane: the residual of the plane of least squares is small compared
// to their range. For a step, the residual is a quarter of the range; for a step over two samples, a tenth.
bool isSlope(const std::array<float, 25>& samples, float reach) {
  constexpr float kLeft = 0.06F, kSpread = 50;  // kSpread: sum of x^2 over the window, x from its middle
  float sum = 0, squares = 0, across = 0, down = 0;
  for (int i = 0; i < 25; ++i) {
    const float code = samples[static_cast<std::size_t>(i)] - samples[12];
    sum += code;
    squares += code * code;
    const int col = i % 5, row = i / 5;
    across += static_cast<float>(col - kReach) * code;
    down += static_cast<float>(row - kReach) * code;
  }
  const float left = squares - sum * sum / 25 - (across * across + down * down) / kSpread;
  return left <= 25 * kLeft * kLeft * reach * reach;
}

// The median of the samples around (c, r) that lie on its side of a step, if there is one.
float medianOfSide(const DepthMap& map, int c, int r, float alike) {
  std::array<float, 25> samples{};
  int count = 0;
  for (int y = std::max(r - kReach, 0); y <= std::min(r + kReach, map.rows - 1); ++y) {
    for (int x = std::max(c - kReach, 0); x <= std::min(c + kReach, map.cols - 1); ++x) {
      const std::size_t i = map.at(x, y);
      if (map.holes[i] == 0) samples[count++] = map.codes[i];
    }
  }
  auto* first = samples.data();
  auto* last = first + count;
  const auto [low, high] = std::minmax_element(first, last);
  const bool whole = count == static_cast<int>(samples.size());
  if (*high - *low > alike && !(whole && isSlope(samples, *high - *low))) {
    // The sample's own code votes with a weight from -1 to 1, and so does the majority, at 3 to 10, so that the corner
    // of a square (9 of 25) and a line two samples wide (10) survive, and samples between two surfaces join the
    // majority.
    constexpr float kOwnVoice = 0.3F;
    const float middle = 0.5F * (*low + *high);
    const float own = 2 * (map.codes[map.at(c, r)] - middle) / (*high - *low);
    auto* const far = std::partition(first, last, [&](float code) { return code > middle; });
    const float majority = static_cast<float>((far - first) - (last - far)) / static_cast<float>(count);
    (kOwnVoice * own + majority > 0 ? last : first) = far;
  }
  auto* const median = first + (last - first) / 2;
  std::nth_element(first, median, last);
  return *median;
}

// The codes of `kReach` rows above and below each seam between two bands, since bands change while others read them.
std::vector<float> codesAtSeams(const DepthMap& map) {
  std::vector<float> seams(map.at(0, 2 * kReach * (map.rows / kBandRows + 1)));
  for (int r = kBandRows; r < map.rows; r += kBandRows) {
    std::copy(&map.codes[map.at(0, r - kReach)], map.codes.data() + map.at(0, std::min(r + kReach, map.rows)),
              &seams[map.at(0, r / kBandRows * 2 * kReach)]);
  }
  return seams;
}

// A band with up to `kReach` rows on both sides, so that it has the same result as the whole picture.
DepthMap bandOf(const DepthMap& map, const std::vector<float>& seams, int first, int end) {
  const int top = std::max(first - kReach, 0), bottom = std::min(end + kReach, map.rows);
  const auto seamAt = [&](int r) { return seams.data() + map.at(0, r / kBandRows * 2 * kReach); };
  DepthMap band(map.cols, bottom - top);
  std::copy_n(map.holes.data() + map.at(0, top), band.size(), band.holes.data());
  auto out = std::copy_n(seamAt(first), map.at(0, first - top), band.codes.begin());
  out = std::copy_n(map.codes.data() + map.at(0, first), map.at(0, end - first), out);
  std::copy_n(seamAt(end) + map.at(0, kReach), map.at(0, bottom - end), out);
  return band;
}

}  // namespace

CleaningCounts fillHoles(DepthMap& map, float noise) {
  CleaningCounts counts;
  std::vector<std::uint8_t> unknown = findOutliers(map, noise);
  for (std::size_t i = 0; i < map.size(); ++i) {
    counts.holes += map.holes[i];
    counts.outliers += unknown[i];
    unknown[i] |= map.holes[i];
  }
  if (counts.holes + counts.outliers == 0) return counts;
  const int radius = std::max(2, map.cols / 80);
  const std::vector<std::uint8_t> wide = findWide(unknown, map, radius);
  const float alike = DepthMap::kStep + 2 * noise;
  struct Filling {
    std::size_t index = 0;
    float code = 0;
  };
  std::vector<Filling> fillings;  // applied at the end, since each looks at the samples as they were
  std::mutex mutex;
  inBands(map.rows, [&](int first, int end) {
    std::vector<Filling> found;
    for (std::size_t i = map.at(0, first); i < map.at(0, end); ++i) {
      if (unknown[i] == 0 || wide[i] != 0) continue;
      const int r = static_cast<int>(i / map.cols), c = static_cast<int>(i % map.cols);
      const Surroundings around(map, unknown, c, r, 2 * radius + 1);
      if (!around.empty()) found.push_back({i, around.meanAround(around.mostSeen(alike), alike)});
    }
    const std::lock_guard lock(mutex);
    fillings.insert(fillings.end(), found.begin(), found.end());
  });
  counts.filled = fillings.size();
  if (counts.holes > 0) {  // in a picture without holes, samples that fit nowhere keep their code
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (unknown[i] != 0) map.codes[i] = 0;
      map.holes[i] = unknown[i];
    }
  }
  for (const Filling& filling : fillings) {
    map.codes[filling.index] = filling.code;
    map.holes[filling.index] = 0;
  }
  return counts;
}

void filterByMedian(DepthMap& map, float noise) {
  const float alike = DepthMap::kStep + 7 * noise;  // the spread of more than 25 samples of one side
  const cv::Mat window = cv::getStructuringElement(cv::MORPH_RECT, {2 * kReach + 1, 2 * kReach + 1});
  const std::vector<float> seams = codesAtSeams(map);
  inBands(map.rows, [&](int first, int end) {
    DepthMap band = bandOf(map, seams, first, end);
    const cv::Mat codes = viewOf(band.codes, band), holes = viewOf(band.holes, band);
    cv::Mat lowest, highest, median, near_hole;
    cv::erode(codes, lowest, window);
    cv::dilate(codes, highest, window);
    cv::medianBlur(codes, median, 2 * kReach + 1);
    cv::dilate(holes, near_hole, window);
    for (int r = first; r < end; ++r) {
      const int at = r - std::max(first - kReach, 0);
      const auto *const low = lowest.ptr<float>(at), *const high = highest.ptr<float>(at);
      const auto* const hole = band.holes.data() + band.at(0, at);
      const auto* const beside = near_hole.ptr<std::uint8_t>(at);
      auto* const out = median.ptr<float>(at);
      for (int c = 0; c < map.cols; ++c) {
        if (beside[c] == 0 && high[c] - low[c] <= alike) continue;
        out[c] = hole[c] != 0 ? 0 : medianOfSide(band, c, at, alike);
      }
      std::copy_n(out, map.cols, map.codes.data() + map.at(0, r));
    }
  });
}

}  // namespace relievo
