// SPDX-License-Identifier: Apache-2.0
#include "app/media/subtitle_file.h"

#include <utility>

namespace relievo {
namespace {

constexpr std::size_t kMostLines = 100'000;

}  // namespace

Result<std::deque<Subtitle>> readSubtitleFile(const std::string& path, const PairReader::Backends& backends) {
  if (!backends.make_subtitle_decoder) return fail(ErrorCode::Unsupported, "nothing here decodes subtitles");
  const auto source = backends.make_source(path);
  if (auto opened = source->open(path); !opened) return std::unexpected(opened.error());
  if (source->streams().empty()) return fail(ErrorCode::Corrupt, "there is no text in it");
  const auto decoder = backends.make_subtitle_decoder();
  if (auto opened = decoder->open(source->streams().front()); !opened) return std::unexpected(opened.error());
  const Duration start = source->senderStart().value_or(Duration(0));  // its first line's time is not the film's
  std::deque<Subtitle> lines;
  while (lines.size() < kMostLines) {
    const auto packet = source->read();
    if (!packet || !*packet) break;
    auto subtitle = decoder->decode(**packet);
    if (!subtitle) continue;
    subtitle->begin += start;
    if (subtitle->end) *subtitle->end += start;
    lines.push_back(std::move(*subtitle));
  }
  return lines;
}

}  // namespace relievo
