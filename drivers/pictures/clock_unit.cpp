// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/clock_unit.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace relievo::pictures {
namespace {

// By their size. At least one number, in order.
std::vector<std::int64_t> stepsOf(const std::vector<std::int64_t>& values) {
  std::vector<std::int64_t> steps(values.size());
  std::adjacent_difference(values.begin(), values.end(), steps.begin());
  steps.erase(steps.begin());
  std::ranges::sort(steps);
  return steps;
}

}  // namespace

bool areIds(std::vector<std::int64_t> values) {
  std::ranges::sort(values);
  if (values.front() <= kMostSeconds || values.back() - values.front() < values.front() / 4) return false;
  const std::vector<std::int64_t> steps = stepsOf(values);
  constexpr std::int64_t kFarNs = 3'000'000'000;
  const std::int64_t usual = steps.empty() ? 0 : steps[(steps.size() - 1) / 2];
  const auto odd = std::ranges::count_if(steps, [&](auto step) { return step < usual / 2 || step / 2 > usual; });
  return usual >= kFarNs || 4 * odd > std::ssize(steps);
}

std::int64_t clockUnit(std::vector<std::int64_t> values) {
  constexpr std::size_t kFewest = 3;
  constexpr std::int64_t kUnixMs = 1'000'000'000'000, kUnixUs = 1000 * kUnixMs, kUnixNs = 1000 * kUnixUs;  // 2001
  constexpr std::int64_t kLeastStepNs = 1'000'000, kLeastStepUs = 10'000, kLeastUsualNs = 4'000'000, kJitter = 2;
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
  if (values.empty() || values.front() < 0) return 0;
  std::int64_t ns = 0;
  if (values.front() >= kUnixMs) {
    ns = values.front() >= kUnixNs ? 1 : values.front() >= kUnixUs ? 1000 : 1'000'000;
  } else if (values.size() >= kFewest || (values.size() > 1 && values.front() > kMostSeconds)) {
    const std::vector<std::int64_t> steps = stepsOf(values);
    const std::int64_t usual = steps[(steps.size() - 1) / 2];
    const bool regular = usual / kJitter <= steps.front();  // the numbers of photos are not
    const bool is_30_hz = (usual == 33 || usual == 34) &&
                          std::ranges::any_of(steps, [&](std::int64_t step) { return step % usual != 0; });
    if (values.front() > kMostSeconds) ns = usual >= kLeastUsualNs ? 1 : 1000;
    else if (is_30_hz) ns = 1'000'000;
    else if (regular) ns = steps.front() >= kLeastStepNs ? 1 : steps.front() >= kLeastStepUs ? 1000 : 0;
  }
  return ns > 0 && values.back() <= kMostSeconds * (1'000'000'000 / ns) ? ns : 0;
}

}  // namespace relievo::pictures
