// SPDX-License-Identifier: Apache-2.0
// Applies a camera's faults in its own order: edges mix, noise is added, codes are rounded, samples fail.
#include "app/lab/film/sensor_depth.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

namespace relievo {
namespace {

constexpr double kHighest = 255, kStepLevels = 8;

double levelAt(const Frame& exact, int c, int r) {
  const auto* row = reinterpret_cast<const std::uint16_t*>(exact.planes[0].data + r * exact.planes[0].stride_bytes);
  return row[c] * (kHighest / 65535);
}

Frame frameOf(std::vector<std::uint8_t> codes, const Frame& like) {
  const auto samples = std::make_shared<const std::vector<std::uint8_t>>(std::move(codes));
  Frame frame = like;
  frame.components[0] = {.step_bytes = 1, .bits = 8};
  frame.planes[0] = {samples->data(), like.width};
  frame.owner = samples;
  return frame;
}

class Sensor {
 public:
  Sensor(const Frame& exact, const SensorModel& model, std::uint64_t seed)
      : exact_(exact), model_(model), random_(seed), noise_(0, 1) {}

  std::vector<std::uint8_t> codes() {
    std::vector<std::uint8_t> codes;
    codes.reserve(static_cast<std::size_t>(exact_.width) * exact_.height);
    for (int r = 0; r < exact_.height; ++r) {
      for (int c = 0; c < exact_.width; ++c) {
        double level = model_.faults ? mixed(c, r) : levelAt(exact_, c, r);
        level += model_.noise_levels * noise_(random_);
        if (model_.faults && share() < 0.002) level = kHighest * share();
        codes.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(level, 1.0, kHighest))));
      }
    }
    if (model_.faults) punchHoles(codes);
    return codes;
  }

 private:
  double share() { return share_(random_); }

  double mixed(int c, int r) {
    double low = levelAt(exact_, c, r), high = low;
    const double own = low;
    for (const auto& [dc, dr] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int x = std::clamp(c + dc, 0, exact_.width - 1), y = std::clamp(r + dr, 0, exact_.height - 1);
      low = std::min(low, levelAt(exact_, x, y));
      high = std::max(high, levelAt(exact_, x, y));
    }
    return high - low > kStepLevels && share() < 0.5 ? low + (high - low) * share() : own;
  }

  void punchHoles(std::vector<std::uint8_t>& codes) {
    const std::size_t wanted = codes.size() / 100;
    for (std::size_t made = 0; made < wanted;) {
      const int radius = static_cast<int>(1 + 4 * share());
      const int x = static_cast<int>(exact_.width * share()), y = static_cast<int>(exact_.height * share());
      for (int r = std::max(y - radius, 0); r <= std::min(y + radius, exact_.height - 1); ++r) {
        for (int c = std::max(x - radius, 0); c <= std::min(x + radius, exact_.width - 1); ++c) {
          if ((c - x) * (c - x) + (r - y) * (r - y) > radius * radius) continue;
          codes[static_cast<std::size_t>(r) * exact_.width + c] = 0;
          ++made;
        }
      }
    }
  }

  const Frame& exact_;
  SensorModel model_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_;
  std::uniform_real_distribution<double> share_{0, 1};
};

}  // namespace

Frame sensedDepth(const Frame& exact, const SensorModel& sensor, std::uint64_t seed) {
  return frameOf(Sensor(exact, sensor, seed).codes(), exact);
}

Frame asEightBits(const Frame& wide) {
  std::vector<std::uint8_t> codes;
  codes.reserve(static_cast<std::size_t>(wide.width) * wide.height);
  for (int r = 0; r < wide.height; ++r) {
    for (int c = 0; c < wide.width; ++c) {
      const double level = levelAt(wide, c, r);
      codes.push_back(static_cast<std::uint8_t>(level > 0 ? std::max(std::lround(level), 1L) : 0));
    }
  }
  return frameOf(std::move(codes), wide);
}

}  // namespace relievo
