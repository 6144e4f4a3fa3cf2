// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/file_times.h"

#include <algorithm>

#include "platform/log.h"

namespace relievo::ffmpeg {
namespace {

constexpr Duration kReordering = std::chrono::seconds(1);  // behind a jump FFmpeg gives out decoding times that fall
constexpr Duration kAnyGap = std::chrono::hours(24 * 365);

}  // namespace

void FileTimes::begin() noexcept {
  continuous_.begin(kAnyGap);
  highest_.clear();
  mended_by_ = Duration(0);
}

void FileTimes::mend(Packet& packet, const std::string& url) {
  if (packet.dts) {
    const auto [known, first] = highest_.try_emplace(packet.stream, *packet.dts);
    if (first || *packet.dts > known->second || *packet.dts < known->second - kReordering) known->second = *packet.dts;
    const Duration offset = continuous_.offsetFor(packet.stream, known->second);
    if (offset > mended_by_) {
      log(LogLevel::Warning, "media", "%s: its times jump back by %.1f s at %.1f s; they are made continuous",
          url.c_str(), toSeconds(offset - mended_by_), toSeconds(*packet.dts + offset));
    }
    mended_by_ = std::max(mended_by_, offset);
    *packet.dts += offset;
    if (packet.pts) *packet.pts += offset;
  } else if (packet.pts) {
    *packet.pts += mended_by_;
  }
}

}  // namespace relievo::ffmpeg
