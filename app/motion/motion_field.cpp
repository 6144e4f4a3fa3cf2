// SPDX-License-Identifier: Apache-2.0
// Recursive block matching on a pyramid of three levels.
#include "app/motion/motion_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

namespace relievo {
namespace {

constexpr int kHighest = 1 << 30;
constexpr int kBlock = 8, kLevels = 3, kPasses = 3;
constexpr int kMargin = 2;     // a block is compared with so much of its neighbourhood
constexpr float kUnlike = 12;  // cost of a sample's difference from the neighbours' vectors: noise moves nothing

// The part of `now` from (left, top) to before (right, bottom), within the picture, as one of `before` at a distance:
// the sum of the differences, or a sum above `most`. Beyond the last samples of `before` they go on.
struct Part {
  int left, top, right, bottom;
};
int differenceOf(const GrayPicture& before, const GrayPicture& now, const Part& part, const Motion& v, int most) {
  const int x4 = static_cast<int>(std::lround(4 * v.x)), y4 = static_cast<int>(std::lround(4 * v.y));
  const int dx = x4 >> 2, dy = y4 >> 2, fx = x4 & 3, fy = y4 & 3;
  const int w00 = (4 - fx) * (4 - fy), w01 = fx * (4 - fy), w10 = (4 - fx) * fy, w11 = fx * fy;
  const bool inside = part.left + dx >= 0 && part.right + dx < before.cols;
  int sum = 0;
  for (int r = part.top; r < part.bottom && sum <= most; ++r) {
    const std::uint8_t* const here = &now.codes[static_cast<std::size_t>(r) * static_cast<std::size_t>(now.cols)];
    const auto rowOf = [&](int row) {
      row = std::clamp(row, 0, before.rows - 1);
      return &before.codes[static_cast<std::size_t>(row) * static_cast<std::size_t>(before.cols)];
    };
    const std::uint8_t *const upper = rowOf(r + dy), *const lower = rowOf(r + dy + 1);
    for (int c = part.left; c < part.right; ++c) {
      const int x = inside ? c + dx : std::clamp(c + dx, 0, before.cols - 1);
      const int next = inside ? x + 1 : std::clamp(c + dx + 1, 0, before.cols - 1);
      const int there = (w00 * upper[x] + w01 * upper[next] + w10 * lower[x] + w11 * lower[next] + 8) >> 4;
      sum += std::abs(here[c] - there);
    }
  }
  return sum;
}

// The vectors of a level's blocks.
class BlockSearch {
 public:
  BlockSearch(const GrayPicture& before, const GrayPicture& now)
      : before_(&before),
        now_(&now),
        across_((now.cols + kBlock - 1) / kBlock),
        down_((now.rows + kBlock - 1) / kBlock),
        vectors_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)) {}

  // From the vectors of a picture of half the size.
  void begin(const BlockSearch& coarse) {
    for (int j = 0; j < down_; ++j) {
      for (int i = 0; i < across_; ++i) {
        const Motion& from = coarse.of(i / 2, j / 2);
        at(i, j) = {2 * from.x, 2 * from.y};
      }
    }
  }
  void search(int least_quarters) {
    for (int pass = 0; pass < kPasses; ++pass) {
      for (int k = 0; k < across_ * down_; ++k) {
        const int n = pass % 2 == 0 ? k : across_ * down_ - 1 - k;
        improve(n % across_, n / across_, least_quarters);
      }
    }
  }
  [[nodiscard]] const Motion& of(int i, int j) const {
    i = std::clamp(i, 0, across_ - 1);
    j = std::clamp(j, 0, down_ - 1);
    return vectors_[static_cast<std::size_t>(j) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(i)];
  }

 private:
  static constexpr std::array<std::array<int, 2>, 4> kAround{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  Motion& at(int i, int j) {
    return vectors_[static_cast<std::size_t>(j) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(i)];
  }

  // The best of its own vector, the neighbours' and none; then steps from it, ever shorter.
  void improve(int i, int j, int least_quarters) {
    Motion best = of(i, j);
    int cost = costOf(i, j, best, kHighest);
    const auto look = [&](const Motion& other) {
      const int there = costOf(i, j, other, cost);
      if (there >= cost) return false;
      best = other;
      cost = there;
      return true;
    };
    look({});
    for (const auto& [x, y] : kAround) look(of(i + x, j + y));
    for (int quarters = 8; quarters >= least_quarters; quarters /= 2) {
      const float step = 0.25F * static_cast<float>(quarters);
      for (bool better = true; better;) {
        better = false;
        for (const auto& [x, y] : kAround) {
          better = look({best.x + step * static_cast<float>(x), best.y + step * static_cast<float>(y)}) || better;
        }
      }
    }
    at(i, j) = best;
  }

  [[nodiscard]] int costOf(int i, int j, const Motion& v, int most) const {
    float unlike = 0;
    for (const auto& [x, y] : kAround) {
      const Motion& other = of(i + x, j + y);
      unlike += std::min(std::abs(v.x - other.x) + std::abs(v.y - other.y), 2.0F);
    }
    const Part part{std::max(i * kBlock - kMargin, 0), std::max(j * kBlock - kMargin, 0),
                    std::min((i + 1) * kBlock + kMargin, now_->cols), std::min((j + 1) * kBlock + kMargin, now_->rows)};
    const int own = static_cast<int>(0.25F * kUnlike * unlike);
    return own + differenceOf(*before_, *now_, part, v, most - own);
  }

  const GrayPicture *before_, *now_;
  int across_, down_;
  std::vector<Motion> vectors_;
};

GrayPicture halved(const GrayPicture& p) {
  return scaledTo(std::max(p.cols / 2, 1), std::max(p.rows / 2, 1), p.codes.data(), p.cols, p.rows);
}

Part around(const GrayPicture& p, int c, int r) {
  return {std::max(c - 2, 0), std::max(r - 2, 0), std::min(c + 3, p.cols), std::min(r + 3, p.rows)};
}

// A sample that has been there by chance, among those that have not.
std::vector<bool> withoutIslands(const std::vector<bool>& is_new, const GrayPicture& p) {
  std::vector<bool> result = is_new;
  for (std::size_t i = 0; i < is_new.size(); ++i) {
    const Part part = around(p, static_cast<int>(i) % p.cols, static_cast<int>(i) / p.cols);
    int count = 0;
    for (int r = part.top; r < part.bottom; ++r) {
      for (int c = part.left; c < part.right; ++c) {
        count += is_new[static_cast<std::size_t>(r) * static_cast<std::size_t>(p.cols) + static_cast<std::size_t>(c)]
                     ? 1
                     : 0;
      }
    }
    result[i] = is_new[i] || 3 * count > (part.right - part.left) * (part.bottom - part.top);
  }
  return result;
}

// The vector of the nine blocks around a sample that fits best over 5 x 5 samples; of equal ones the own block's.
Motion bestHere(const BlockSearch& blocks, const GrayPicture& before, const GrayPicture& now, int c, int r) {
  const Motion own = blocks.of(c / kBlock, r / kBlock);
  const Part part = around(now, c, r);
  Motion best = own;
  std::optional<int> cost;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const Motion& other = blocks.of(c / kBlock + i, r / kBlock + j);
      if (std::abs(other.x - own.x) + std::abs(other.y - own.y) < 0.5F) continue;
      if (!cost) cost = differenceOf(before, now, part, own, kHighest) - 1;
      const int there = differenceOf(before, now, part, other, *cost);
      if (there >= *cost) continue;
      best = other;
      cost = there;
    }
  }
  return best;
}

}  // namespace

GrayPicture scaledTo(int cols, int rows, const std::uint8_t* codes, int width, int height) {
  GrayPicture scaled(cols, rows);
  auto out = scaled.codes.begin();
  for (int r = 0; r < rows; ++r) {
    const int top = r * height / rows, bottom = std::max((r + 1) * height / rows, top + 1);
    for (int c = 0; c < cols; ++c) {
      const int left = c * width / cols, right = std::max((c + 1) * width / cols, left + 1);
      int sum = 0;
      for (int y = top; y < bottom; ++y) {
        for (int x = left; x < right; ++x) sum += codes[static_cast<std::ptrdiff_t>(y) * width + x];
      }
      *out++ = static_cast<std::uint8_t>(sum / ((bottom - top) * (right - left)));
    }
  }
  return scaled;
}

std::vector<Motion> motionBetween(const GrayPicture& before, const GrayPicture& now) {
  std::array<GrayPicture, kLevels> from{before}, to{now};
  for (std::size_t k = 1; k < kLevels; ++k) {
    from[k] = halved(from[k - 1]);
    to[k] = halved(to[k - 1]);
  }
  BlockSearch blocks(from[kLevels - 1], to[kLevels - 1]);
  blocks.search(4);
  for (std::size_t k = kLevels - 1; k-- > 0;) {
    BlockSearch finer(from[k], to[k]);
    finer.begin(blocks);
    finer.search(k == 0 ? 1 : 4);
    blocks = std::move(finer);
  }
  std::vector<Motion> motion;
  motion.reserve(now.codes.size());
  for (int r = 0; r < now.rows; ++r) {
    for (int c = 0; c < now.cols; ++c) motion.push_back(bestHere(blocks, before, now, c, r));
  }
  return motion;
}

std::vector<bool> uncovered(const GrayPicture& before, const GrayPicture& now, const std::vector<Motion>& motion,
                            const std::vector<Motion>& back) {
  constexpr float kElsewhere = 1.5F;  // samples
  constexpr int kUnlikeIt = 6;        // codes, in the mean
  std::vector<bool> result(motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const int c = static_cast<int>(i) % now.cols, r = static_cast<int>(i) / now.cols;
    const Motion& v = motion[i];
    const int from_c = std::clamp(c + static_cast<int>(std::lround(v.x)), 0, now.cols - 1);
    const int from_r = std::clamp(r + static_cast<int>(std::lround(v.y)), 0, now.rows - 1);
    const Motion& u =
        back[static_cast<std::size_t>(from_r) * static_cast<std::size_t>(now.cols) + static_cast<std::size_t>(from_c)];
    if (std::abs(u.x + v.x) + std::abs(u.y + v.y) < kElsewhere) continue;
    const Part part = around(now, c, r);
    const int samples = (part.right - part.left) * (part.bottom - part.top);
    result[i] = differenceOf(before, now, part, v, kHighest) > kUnlikeIt * samples;
  }
  return withoutIslands(result, now);
}

}  // namespace relievo
