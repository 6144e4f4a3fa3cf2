// SPDX-License-Identifier: Apache-2.0
// Recursive block matching on a pyramid of three levels.
#include "app/motion/motion_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "app/motion/part_difference.h"

namespace relievo {
namespace {

constexpr int kHighest = 1 << 30;
constexpr int kBlock = 8, kLevels = 3, kPasses = 3;
constexpr int kNear = kSmallPart;  // samples across and down that are compared for a single one
constexpr int kMargin = 2;         // a block is compared with so much of its neighbourhood
static_assert(kBlock + 2 * kMargin == kLargePart);
constexpr float kUnlike = 12;  // cost of a sample's difference from the neighbours' vectors: noise moves nothing

// The vectors of a level's blocks.
class BlockSearch {
 public:
  BlockSearch(const QuarterPictures& before, const GrayPicture& now)
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

  // Chooses the best of its own vector, the neighbours' and zero; then searches around it in ever shorter steps.
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
    std::array<Motion, 6> looked{best};
    std::size_t count = 1;
    const auto lookOnce = [&](const Motion& other) {
      const auto end = looked.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(looked.begin(), end, other) != end) return;
      looked[count++] = other;
      look(other);
    };
    lookOnce({});
    for (const auto& [x, y] : kAround) lookOnce(of(i + x, j + y));
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
    const PicturePart part{std::max(i * kBlock - kMargin, 0), std::max(j * kBlock - kMargin, 0),
                           std::min((i + 1) * kBlock + kMargin, now_->cols),
                           std::min((j + 1) * kBlock + kMargin, now_->rows)};
    const int own = static_cast<int>(0.25F * kUnlike * unlike);
    return own + differenceOf(*before_, *now_, part, v, most - own);
  }

  const QuarterPictures* before_;
  const GrayPicture* now_;
  int across_, down_;
  std::vector<Motion> vectors_;
};

GrayPicture halved(const GrayPicture& p) {
  return scaledTo(std::max(p.cols / 2, 1), std::max(p.rows / 2, 1), p.bytes.data(), p.cols, p.rows);
}

PicturePart around(const GrayPicture& p, int c, int r) {
  constexpr int kReach = kNear / 2;
  return {std::max(c - kReach, 0), std::max(r - kReach, 0), std::min(c + kReach + 1, p.cols),
          std::min(r + kReach + 1, p.rows)};
}

// Removes isolated samples: those that differ from their neighbours by chance.
std::vector<bool> withoutIslands(const std::vector<bool>& is_new, const GrayPicture& p) {
  std::vector<bool> result = is_new;
  for (std::size_t i = 0; i < is_new.size(); ++i) {
    const PicturePart part = around(p, static_cast<int>(i) % p.cols, static_cast<int>(i) / p.cols);
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

// Of the vectors of the nine blocks around a sample, the one that fits best over 5 x 5 samples; if equal, its own
// block's.
Motion bestHere(const BlockSearch& blocks, const QuarterPictures& before, const GrayPicture& now, int c, int r) {
  const Motion own = blocks.of(c / kBlock, r / kBlock);
  const PicturePart part = around(now, c, r);
  Motion best = own, last = own;
  std::optional<int> cost;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const Motion& other = blocks.of(c / kBlock + i, r / kBlock + j);
      if (other == std::exchange(last, other) || std::abs(other.x - own.x) + std::abs(other.y - own.y) < 0.5F) continue;
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
  auto out = scaled.bytes.begin();
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
  std::vector<QuarterPictures> from{QuarterPictures(before)};
  std::vector<GrayPicture> to{now};
  for (std::size_t k = 1; k < kLevels; ++k) {
    from.emplace_back(halved(from.back().picture()));
    to.push_back(halved(to.back()));
  }
  BlockSearch blocks(from.back(), to.back());
  blocks.search(4);
  for (std::size_t k = kLevels - 1; k-- > 0;) {
    BlockSearch finer(from[k], to[k]);
    finer.begin(blocks);
    finer.search(k == 0 ? 1 : 4);
    blocks = std::move(finer);
  }
  std::vector<Motion> motion;
  motion.reserve(now.bytes.size());
  for (int r = 0; r < now.rows; ++r) {
    for (int c = 0; c < now.cols; ++c) motion.push_back(bestHere(blocks, from[0], now, c, r));
  }
  return motion;
}

std::vector<bool> uncovered(const GrayPicture& before, const GrayPicture& now, const std::vector<Motion>& motion,
                            const std::vector<Motion>& back) {
  constexpr float kElsewhere = 1.5F;  // samples
  constexpr int kUnlikeIt = 6;        // codes, in the mean
  const QuarterPictures from(before);
  std::vector<bool> result(motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const int c = static_cast<int>(i) % now.cols, r = static_cast<int>(i) / now.cols;
    const Motion& v = motion[i];
    const int from_c = std::clamp(c + static_cast<int>(std::lround(v.x)), 0, now.cols - 1);
    const int from_r = std::clamp(r + static_cast<int>(std::lround(v.y)), 0, now.rows - 1);
    const Motion& u =
        back[static_cast<std::size_t>(from_r) * static_cast<std::size_t>(now.cols) + static_cast<std::size_t>(from_c)];
    if (std::abs(u.x + v.x) + std::abs(u.y + v.y) < kElsewhere) continue;
    const PicturePart part = around(now, c, r);
    const int samples = (part.right - part.left) * (part.bottom - part.top);
    result[i] = differenceOf(from, now, part, v, kHighest) > kUnlikeIt * samples;
  }
  return withoutIslands(result, now);
}

}  // namespace relievo
