// SPDX-License-Identifier: Apache-2.0
// A colour's code is that of its own light times a factor of the brightest component's light, since gamma turns the
// ratio of two lights into that of two codes.
#include "app/render/gl/sdr_table.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "app/scene/sdr_color.h"

namespace relievo {
namespace {

constexpr int kSteps = 4096;

float rootOf(float light) noexcept {
  return std::sqrt(std::sqrt(light)) * static_cast<float>(kSteps);
}

// At the nearest step. Light over 1, which a saturated colour of other primaries can have, counts as 1.
float valueAt(const std::vector<float>& values, float root) noexcept {
  return values[static_cast<std::size_t>(std::min(root + 0.5F, static_cast<float>(kSteps)))];
}

template <typename F>
std::vector<float> tableOf(F&& valueOfLight) {
  std::vector<float> values;
  values.reserve(kSteps + 1);
  for (int i = 0; i <= kSteps; ++i) {
    const double root = static_cast<double>(std::max(i, 1)) / kSteps;  // not 0, where a ratio has no value
    values.push_back(static_cast<float>(valueOfLight(root * root * root * root)));
  }
  return values;
}

}  // namespace

void SdrTable::prepare(std::uint8_t transfer, std::uint8_t primaries) {
  if (transfer == transfer_ && primaries == primaries_) return;
  transfer_ = transfer;
  primaries_ = primaries;
  if (hdrName(transfer) == nullptr) return;
  const double most = hdrLight(1, transfer);
  const double most_cd_m2 = isHlg(transfer) ? kHdrPeakCdM2 : most;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    light_[i] = static_cast<float>(hdrLight(static_cast<double>(i) / 255, transfer) / most);
  }
  to_bt709_ = isBt2020(primaries) ? glm::mat3(kBt709FromBt2020) : glm::mat3(1);
  const auto systemGamma = [](double luminance) { return std::pow(luminance, kHlgGamma - 1); };
  system_ = isHlg(transfer) ? tableOf(systemGamma) : std::vector<float>{};
  code_ = tableOf([&](double light) { return 255 * std::pow(light * most_cd_m2 / kSdrWhiteCdM2, 1 / kSdrGamma); });
  factor_ = tableOf([&](double light) {
    return std::pow(compressedLight(light * most_cd_m2) / (light * most_cd_m2), 1 / kSdrGamma);
  });
}

template <bool kHasSystemGamma>
void SdrTable::applyTo(std::span<std::uint8_t> rgba) const noexcept {
  for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
    glm::vec3 light(light_[rgba[i]], light_[rgba[i + 1]], light_[rgba[i + 2]]);
    if constexpr (kHasSystemGamma) {
      light *= valueAt(system_, rootOf(glm::dot(light, glm::vec3(kBt2020Luminance))));
    }
    light = glm::max(to_bt709_ * light, 0.0F);
    constexpr float kRounds = 0.5F;
    const glm::vec3 roots(rootOf(light.r), rootOf(light.g), rootOf(light.b));
    const float factor = valueAt(factor_, std::max({roots.r, roots.g, roots.b}));
    for (int k = 0; k < 3; ++k) {
      const float code = light[k] > 0 ? valueAt(code_, roots[k]) * factor : 0;
      rgba[i + static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::min(code, 255.0F) + kRounds);
    }
  }
}

void SdrTable::apply(std::span<std::uint8_t> rgba) const noexcept {
  if (hdrName(transfer_) == nullptr) return;
  if (system_.empty()) return applyTo<false>(rgba);
  applyTo<true>(rgba);
}

}  // namespace relievo
