// SPDX-License-Identifier: Apache-2.0
// Lines are blurred across as they are read, then down, sixteen samples at a time in registers.
#include "app/lab/rival/depth_smoother.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace relievo {
namespace {

constexpr double kCutOff = 3.5;     // in standard deviations
constexpr int kSamplesOfSigma = 3;  // that are left in a standard deviation at least
constexpr std::size_t kLanes = 16;  // worked on at once; lines are a multiple of it

using Vector = float __attribute__((vector_size(16)));

Vector load(const float* p) {
  Vector v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

// out[c] = sum of taps[k] x (before[k][c] + after[k][c]); of the centre both are the same, and its tap is half.
void weigh(std::span<const DepthSmoother::Pair> pairs, const float* taps, std::size_t length, float* out) {
  for (std::size_t c = 0; c < length; c += kLanes) {
    Vector s0{}, s1{}, s2{}, s3{};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const float *a = pairs[k].before + c, *b = pairs[k].after + c;
      const float tap = taps[k];
      s0 += tap * (load(a) + load(b));
      s1 += tap * (load(a + 4) + load(b + 4));
      s2 += tap * (load(a + 8) + load(b + 8));
      s3 += tap * (load(a + 12) + load(b + 12));
    }
    for (const Vector& s : {s0, s1, s2, s3}) {
      __builtin_memcpy(out, &s, sizeof s);
      out += 4;
    }
  }
}

std::size_t wholeLanes(int length) {
  return (static_cast<std::size_t>(length) + kLanes - 1) / kLanes * kLanes;
}

void writeCodes(const float* heights, float per_mm, std::span<std::uint16_t> out) {
  for (std::size_t c = 0; c < out.size(); ++c) {
    const float code = std::min(std::max(heights[c] * per_mm + 0.5F, 1.0F), 65535.0F);
    out[c] = static_cast<std::uint16_t>(static_cast<int>(code));
  }
}

// A Gaussian from its centre outwards, the centre at half its weight; their sum is a half.
std::vector<double> gaussian(double sigma) {
  std::vector<double> weights;
  double sum = 0;
  for (int k = 0; k <= static_cast<int>(std::ceil(kCutOff * sigma)); ++k) {
    weights.push_back((k == 0 ? 0.5 : 1.0) * std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += 2 * weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

// 2 g - g * g, in the same form.
std::vector<double> twiced(const std::vector<double>& g) {
  const int reach = static_cast<int>(g.size()) - 1;
  const auto at = [&](int k) {
    const auto from_centre = static_cast<std::size_t>(std::abs(k));
    return std::abs(k) > reach ? 0 : k == 0 ? 2 * g[0] : g[from_centre];
  };
  std::vector<double> weights;
  for (int k = 0; k <= 2 * reach; ++k) {
    double convolved = 0;
    for (int i = -reach; i <= reach; ++i) convolved += at(i) * at(k - i);
    weights.push_back((k == 0 ? 0.5 : 1.0) * (2 * at(k) - convolved));
  }
  return weights;
}

}  // namespace

DepthSmoother::Axis::Axis(int samples, double pitch_mm, double sigma_mm, Order order) {
  for (int n = 1; n * kSamplesOfSigma * pitch_mm <= sigma_mm; ++n) {
    if (samples % n == 0) factor = n;
  }
  size = samples / factor;
  // A block of n samples has a variance of (n^2 - 1)/12 of its own.
  const double wanted = sigma_mm * sigma_mm / (pitch_mm * pitch_mm), own = (factor * factor - 1) / 12.0;
  const std::vector<double> first = gaussian(std::sqrt(wanted - own) / factor);
  for (const double w : order == Order::First ? first : twiced(first)) taps.push_back(static_cast<float>(w));
}

DepthSmoother::DepthSmoother(const HeightField& like, double sigma_mm, Order order)
    : across_(like.cols(), 1 / like.grid().u_per_mm, sigma_mm, order),
      down_(like.rows(), -1 / like.grid().v_per_mm, sigma_mm, order),
      stride_(wholeLanes(across_.size)),
      columns_(static_cast<std::size_t>(like.cols())),
      samples_(columns_.size() * static_cast<std::size_t>(down_.factor)),
      heights_(stride_ + 2 * across_.taps.size()),
      shares_(heights_.size()),
      height_lines_(stride_ * static_cast<std::size_t>(down_.size)),
      share_lines_(height_lines_.size(), 1.0F),
      height_out_(stride_),
      share_out_(stride_),
      holed_(static_cast<std::size_t>(down_.size)) {
  std::iota(columns_.begin(), columns_.end(), 0);
}

bool DepthSmoother::smooth(const HeightField& field, std::span<std::uint16_t> out) {
  for (int row = 0; row < rows(); ++row) {
    const std::size_t at = static_cast<std::size_t>(row) * stride_;
    const bool holed = readLine(field, row);
    blurAcross(heights_, height_lines_.data() + at);
    if (holed) {
      blurAcross(shares_, share_lines_.data() + at);
    } else if (holed_[static_cast<std::size_t>(row)] != 0) {
      std::fill_n(share_lines_.data() + at, stride_, 1.0F);
    }
    holed_[static_cast<std::size_t>(row)] = holed ? 1 : 0;
  }
  const auto per_mm = static_cast<float>(65535 / field.depthMm());
  const auto length = static_cast<std::size_t>(cols());
  bool hole = false;
  for (int row = 0; row < rows(); ++row) {
    const auto line = out.subspan(static_cast<std::size_t>(row) * length, length);
    blurDown(height_lines_, row, height_out_.data());
    const bool holes_near = holesNear(row);
    if (holes_near) {
      blurDown(share_lines_, row, share_out_.data());
      for (std::size_t c = 0; c < length; ++c) height_out_[c] /= std::max(share_out_[c], 0.5F);
    }
    writeCodes(height_out_.data(), per_mm, line);
    for (std::size_t c = 0; holes_near && c < length; ++c) {
      if (share_out_[c] >= 0.5F) continue;
      line[c] = kHole;
      hole = true;
    }
  }
  return hole;
}

// The means over the blocks of one line: of heights, 0 at a hole, and of the marks of valid samples. If the line has no
// hole, the marks are left unchanged and are not used.
bool DepthSmoother::readLine(const HeightField& field, int row) {
  const auto length = static_cast<std::size_t>(field.cols());
  bool holed = false;
  for (int k = 0; k < down_.factor; ++k) {
    float* const samples = samples_.data() + static_cast<std::size_t>(k) * length;
    holed = field.readRow(row * down_.factor + k, columns_, samples) || holed;
  }
  if (!holed) {
    addBlocks(heights_);
    return false;
  }
  has_height_.resize(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    has_height_[i] = std::isnan(samples_[i]) ? 0.0F : 1.0F;
    if (std::isnan(samples_[i])) samples_[i] = 0;
  }
  addBlocks(heights_);
  samples_.swap(has_height_);
  addBlocks(shares_);
  return true;
}

// The mean of each block of `samples_`, behind the line's border.
void DepthSmoother::addBlocks(std::vector<float>& line) const {
  const auto begin = static_cast<std::size_t>(across_.radius()), factor = static_cast<std::size_t>(across_.factor);
  const auto length = static_cast<std::size_t>(cols());
  if (samples_.size() == length) {
    std::copy(samples_.begin(), samples_.end(), line.begin() + static_cast<std::ptrdiff_t>(begin));
    return;
  }
  std::fill(line.begin(), line.end(), 0.0F);
  const float share = 1.0F / static_cast<float>(across_.factor * down_.factor);
  for (std::size_t at = 0; at < samples_.size();) {
    for (std::size_t c = begin; c < begin + length; ++c) {
      float sum = 0;
      for (std::size_t i = 0; i < factor; ++i) sum += samples_[at++];
      line[c] += share * sum;
    }
  }
}

void DepthSmoother::blurAcross(std::vector<float>& line, float* out) {
  const auto reach = static_cast<std::size_t>(across_.radius()), end = reach + static_cast<std::size_t>(cols());
  std::fill_n(line.begin(), reach, line[reach]);
  std::fill(line.begin() + static_cast<std::ptrdiff_t>(end), line.end(), line[end - 1]);
  pairs_.clear();
  for (std::size_t k = 0; k <= reach; ++k) pairs_.push_back({line.data() + reach - k, line.data() + reach + k});
  weigh(pairs_, across_.taps.data(), stride_, out);
}

void DepthSmoother::blurDown(const std::vector<float>& picture, int row, float* out) {
  const auto lineAt = [&](int r) {
    return picture.data() + static_cast<std::size_t>(std::clamp(r, 0, rows() - 1)) * stride_;
  };
  pairs_.clear();
  for (int k = 0; k <= down_.radius(); ++k) pairs_.push_back({lineAt(row - k), lineAt(row + k)});
  weigh(pairs_, down_.taps.data(), stride_, out);
}

bool DepthSmoother::holesNear(int row) const {
  const auto first = holed_.begin() + std::max(0, row - down_.radius());
  const auto last = holed_.begin() + std::min(rows(), row + down_.radius() + 1);
  return std::any_of(first, last, [](std::uint8_t holed) { return holed != 0; });
}

}  // namespace relievo
