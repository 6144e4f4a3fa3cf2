// SPDX-License-Identifier: Apache-2.0
#include "app/media/reading/codes/far_background.h"

#include <algorithm>

#include "platform/print.h"

namespace relievo {
namespace {

constexpr std::uint32_t kTop = 0xffff;

// `invalid`: as a calibration has it.
std::string withBackground(const std::string& invalid, const CodeSet::Range& background) {
  std::string holes = invalid == "none" ? "" : invalid;
  const std::string top = print("+%u", kTop);
  if (holes.ends_with(top)) holes.resize(holes.size() - top.size());
  return holes + (holes.empty() ? "" : "+") + CodeSet(background).text();
}

}  // namespace

std::optional<CodeSet::Range> farBackground(const CodeCount& count) {
  constexpr double kOutliers = 0.002, kLeastShare = 0.005, kTimes = 2;
  constexpr double kSame = 0.999;   // a depth buffer's far plane is not exact
  constexpr int kFewestCodes = 32;  // of a shape; fewer are labels, or a few flat walls
  if (count.bits() != 16) return std::nullopt;
  const CodeCount all = count.together().without(CodeSet(0)).without(CodeSet(kTop));
  if (all.samples() == 0) return std::nullopt;
  const std::uint32_t high = all.quantile(1 - kOutliers, 1, kTop);
  const auto far = static_cast<std::uint32_t>(kSame * high);
  const CodeCount rest = all.without(CodeSet(CodeSet::Range{far, kTop}));
  if (all.share(far, kTop) < kLeastShare || rest.kinds() < kFewestCodes) return std::nullopt;
  const std::uint32_t low = rest.quantile(kOutliers, 1, kTop), next = rest.quantile(1 - kOutliers, 1, kTop);
  const bool stands_clear = far >= kTimes * next && far - next > next - low;
  return stands_clear ? std::optional(CodeSet::Range{far, kTop}) : std::nullopt;
}

void leaveOut(const CodeSet::Range& background, const CodeCount& count, CalibrationLayers& layers, DepthReading& read) {
  for (CalibrationSettings* layer : {&layers.stated_kind, &layers.tags, &layers.beside, &layers.names}) {
    if (const auto holes = layer->find("invalid"); holes != layer->end())
      holes->second = withBackground(holes->second, background);
  }
  std::string& holes = read.settings.try_emplace("invalid", "none").first->second;
  holes = withBackground(holes, background);
  read.doubt += read.doubt.empty() ? "" : "; ";
  read.doubt += print(
      "%.1f %% of the depth is one distance far behind all else: taken for background, which is not felt; if it is a "
      "wall: --calibration invalid=0",
      100 * count.share(background.low, background.high));
}

}  // namespace relievo
