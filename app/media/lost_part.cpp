// SPDX-License-Identifier: Apache-2.0
#include "app/media/lost_part.h"

#include "platform/print.h"

namespace relievo {

std::vector<LostPart> lostParts(const std::string& url, const std::string& depth_url, const PairCounters& counters) {
  std::vector<LostPart> parts;
  if (counters.missing > Duration(0)) parts.push_back({.url = url, .length = counters.missing});
  if (counters.depth_missing > Duration(0)) {
    parts.push_back({.url = depth_url, .of_depth = true, .length = counters.depth_missing});
  }
  if (counters.damaged > 0) parts.push_back({.url = url, .damaged = counters.damaged});
  return parts;
}

std::string toText(const LostPart& part) {
  if (part.damaged > 0) {
    return part.url +
           print(": %llu damaged packets or pictures were left out", static_cast<unsigned long long>(part.damaged));
  }
  const int digits = part.length < std::chrono::milliseconds(100) ? 2 : 1;
  return part.url + print(" lacks at least %.*f s: truncated or damaged", digits, toSeconds(part.length));
}

Failure failureOf(const LostPart& part) {
  return {part.url, {ErrorCode::Corrupt, 0, "it is not whole: only what was there was used; get the whole file"}};
}

}  // namespace relievo
