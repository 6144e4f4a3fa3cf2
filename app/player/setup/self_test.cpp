// SPDX-License-Identifier: Apache-2.0
// Each check uses the same calls as a film would.
#include "app/player/setup/self_test.h"

#include <array>
#include <atomic>

#include "app/player/player.h"
#include "app/render/text/ass_text.h"
#include "platform/print.h"

namespace relievo {
namespace {

using Verdict = SelfTestLine::Verdict;

constexpr std::array kPictureCodecs{"h264", "hevc", "vp8", "vp9", "ffv1"};
constexpr std::array kSoundCodecs{"aac", "ac3", "mp3", "opus", "vorbis"};
constexpr double kFelt_n = 0.1;
constexpr double kMost_n = 10;  // of the task's limits

SelfTestLine text() {
  const auto words = AssText::create();
  if (words) return {Verdict::Good, "text", "there is a font"};
  return {Verdict::Note, "text", words.error().message};
}

// One line for all of a kind. Opened without parameter sets, a known codec may answer that its parameters
// make no sense.
template <class Codecs, class Open>
SelfTestLine decoders(const char* thing, const Codecs& codecs, Open&& open) {
  std::string there, missing;
  for (const char* codec : codecs) {
    const Result<void> opened = open(codec);
    std::string& words = opened || opened.error().code != ErrorCode::Unsupported ? there : missing;
    words += (words.empty() ? "" : " ") + std::string(codec);
  }
  if (missing.empty()) return {Verdict::Good, thing, there};
  return {there.empty() ? Verdict::Bad : Verdict::Note, thing, "films with " + missing + " cannot be decoded"};
}

SelfTestLine pictureDecoders(const PairReader::Backends& backends) {
  return decoders("pictures", kPictureCodecs, [&](const char* codec) {
    StreamInfo stream;
    stream.kind = StreamKind::Video;
    stream.codec = codec;
    stream.width = 64, stream.height = 48;
    return backends.make_decoder(stream)->open(stream);
  });
}

SelfTestLine soundDecoders(const PairReader::Backends& backends) {
  return decoders("sound", kSoundCodecs, [&](const char* codec) {
    StreamInfo stream;
    stream.kind = StreamKind::Audio;
    stream.codec = codec;
    stream.sample_rate_hz = 48000, stream.channels = 2;
    return backends.make_audio_decoder()->open(stream, {});
  });
}

SelfTestLine display(const PlayReport& report) {
  if (report.frames_shown == 0) return {Verdict::Bad, "display", "no picture was shown"};
  return {Verdict::Good, "display",
          print("%s, %dx%d, %llu pictures, %zu triangles, drawn in %.1f ms", report.display.c_str(),
                report.surface_width, report.surface_height, static_cast<unsigned long long>(report.frames_shown),
                report.triangles, report.draw_ms)};
}

SelfTestLine touch(const HapticSummary& haptic) {
  const std::string said = print("%s, %llu ticks, force up to %.2f N, %llu allocations", haptic.device.c_str(),
                                 static_cast<unsigned long long>(haptic.ticks), haptic.max_force_n,
                                 static_cast<unsigned long long>(haptic.allocations));
  if (haptic.ticks == 0) return {Verdict::Bad, "touch", "the haptic task did not run"};
  const bool good = haptic.max_force_n > kFelt_n && haptic.max_force_n <= kMost_n && haptic.allocations == 0;
  if (good) return {Verdict::Good, "touch", said};
  return {Verdict::Bad, "touch", said + "; there should be a force, under 10 N, and no allocation"};
}

SelfTestLine realTime(const HapticSummary& haptic) {
  if (haptic.scheduler != "SCHED_FIFO")
    return {Verdict::Note, "real time",
            "no permission for SCHED_FIFO: touch will be rough under load; as relievo.service "
            "does, raise LimitRTPRIO (ulimit -r)"};
  if (!haptic.memory_locked)
    return {Verdict::Note, "real time", "memory is not locked; raise LimitMEMLOCK (ulimit -l)"};
  return {Verdict::Good, "real time", "SCHED_FIFO, memory locked"};
}

}  // namespace

std::vector<SelfTestLine> selfTest(SelfTestParts parts) {
  std::vector<SelfTestLine> lines{text(), pictureDecoders(parts.backends), soundDecoders(parts.backends)};
  PlayerConfig config;
  config.source.url = std::move(parts.film);
  config.display = {.width = 640, .height = 360};
  Player player(
      std::move(config),
      {.clock = parts.clock, .display = parts.display, .haptic = &parts.haptic, .backends = std::move(parts.backends)});
  const std::atomic<bool> stop{false};
  const auto played = player.run(stop);
  const PlayReport report = player.report();
  if (!played) lines.push_back({Verdict::Bad, played.error().thing, played.error().error.message});
  lines.insert(lines.end(), {display(report), touch(report.haptic), realTime(report.haptic)});
  return lines;
}

}  // namespace relievo
