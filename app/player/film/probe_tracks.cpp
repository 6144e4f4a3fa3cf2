// SPDX-License-Identifier: Apache-2.0
#include "app/player/film/probe_tracks.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "platform/print.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostTimes = 4096, kMostBytes = std::size_t{64} << 20;

struct Names {
  std::uint8_t code;
  const char* name;
};
// ITU-T H.273, 8.1 and 8.2, in FFmpeg's words.
constexpr Names kPrimaries[] = {{1, "bt709"}, {4, "bt470m"}, {5, "bt470bg"},   {6, "smpte170m"}, {7, "smpte240m"},
                                {8, "film"},  {9, "bt2020"}, {10, "smpte428"}, {11, "smpte431"}, {12, "smpte432"}};
constexpr Names kTransfers[] = {{1, "bt709"},      {4, "bt470m"},     {5, "bt470bg"},       {6, "smpte170m"},
                                {7, "smpte240m"},  {8, "linear"},     {13, "iec61966-2-1"}, {14, "bt2020-10"},
                                {15, "bt2020-12"}, {16, "smpte2084"}, {18, "arib-std-b67"}};

template <std::size_t N>
std::string nameOf(const Names (&names)[N], std::uint8_t code) {
  for (const Names& known : names) {
    if (known.code == code) return known.name;
  }
  return "";
}

const char* nameOf(FieldOrder order) {
  switch (order) {
    case FieldOrder::Unknown:
      return "unknown";
    case FieldOrder::Progressive:
      return "progressive";
    case FieldOrder::TopTop:
      return "tt";
    case FieldOrder::BottomBottom:
      return "bb";
    case FieldOrder::TopBottom:
      return "tb";
    case FieldOrder::BottomTop:
      return "bt";
  }
  return "unknown";
}

bool isInterlaced(FieldOrder order) {
  return order != FieldOrder::Unknown && order != FieldOrder::Progressive;
}

const char* kindName(StreamKind kind) {
  switch (kind) {
    case StreamKind::Video:
      return "video";
    case StreamKind::Audio:
      return "sound";
    case StreamKind::Subtitle:
      return "subtitles";
    case StreamKind::Other:
      break;
  }
  return "other";
}

// The simplest fraction within a millionth: the convergents of its continued fraction.
Ratio ratioOf(double value) {
  if (!std::isfinite(value) || value <= 0) return {};
  int num = 1, den = 0, last_num = 0, last_den = 1;
  double rest = value;
  for (int i = 0; i < 12; ++i) {
    const double whole = std::floor(rest);
    if (whole * num + last_num > 1e6 || whole * den + last_den > 1e6) break;
    const int next_num = static_cast<int>(whole) * num + last_num, next_den = static_cast<int>(whole) * den + last_den;
    last_num = num, last_den = den;
    num = next_num, den = next_den;
    if (den > 0 && std::abs(static_cast<double>(num) / den - value) < 1e-6 * value) break;
    rest = 1 / (rest - whole);
  }
  return {num, den};
}

std::string text(const Ratio& ratio, char between) {
  return std::to_string(ratio.num) + between + std::to_string(ratio.den);
}

std::string tag(const StreamInfo& s, const char* key) {
  const auto found = s.tags.find(key);
  return found == s.tags.end() ? "" : found->second;
}

// The container's title of a track; empty if a muxer wrote its default word there.
std::string titleOf(const StreamInfo& s) {
  for (const char* key : {"TITLE", "NAME", "HANDLER_NAME"}) {
    const std::string title = tag(s, key);
    if (!title.empty() && !title.ends_with("Handler")) return title;
  }
  return "";
}

std::string videoText(const ProbedTrack& t) {
  const StreamInfo& s = t.stream;
  std::string words = print(" %d x %d", s.width, s.height);
  if (s.auxiliary) words += ", signalled as depth by its stream type";
  if (!s.pixel_format.empty()) words += ", " + s.pixel_format + print(" of %d bits", s.bits);
  words += ", " + rateText(t.rate);
  if (isInterlaced(s.fields)) {
    const bool top = s.fields == FieldOrder::TopTop || s.fields == FieldOrder::BottomTop;
    words += top ? ", interlaced, top field first" : ", interlaced, bottom field first";
  }
  if (std::abs(s.sample_aspect - 1) > 1e-6) words += ", sample aspect " + text(ratioOf(s.sample_aspect), ':');
  if (s.rotation != 0) words += print(", turned by %d degrees", 90 * s.rotation);
  const std::string primaries = nameOf(kPrimaries, s.primaries), transfer = nameOf(kTransfers, s.transfer);
  if (!primaries.empty() && primaries != "bt709") words += ", primaries " + primaries;
  if (!transfer.empty() && transfer != "bt709") words += ", transfer " + transfer;
  return words;
}

std::string soundText(const StreamInfo& s) {
  return print(" %d Hz, ", s.sample_rate_hz) +
         (s.channel_layout.empty() ? std::to_string(s.channels) + " channels" : s.channel_layout);
}

// The timestamps of the video tracks.
struct TimeStudy {
  std::map<int, std::vector<MediaTime>> times;
  bool whole = false;

  void read(MediaSource& source) {
    std::size_t bytes = 0;
    bool more = true;
    while (more && bytes < kMostBytes) {
      const auto packet = source.read();
      whole = packet && !*packet;
      if (!packet || !*packet) return;
      bytes += (*packet)->bytes;
      const auto found = times.find((*packet)->stream);
      if (found == times.end()) continue;
      if (const auto time = (*packet)->pts ? (*packet)->pts : (*packet)->dts) found->second.push_back(*time);
      more = found->second.size() < kMostTimes;
    }
  }
};

}  // namespace

Outcome<ProbedSource> readTracks(const std::string& url, std::optional<double> frames_per_s,
                                 const PairReader::Backends& backends) {
  const auto source = backends.make_source(url);
  source->setPictureRate(frames_per_s);
  if (auto opened = source->open(url); !opened) return failOn(url, opened.error());
  TimeStudy study;
  for (const StreamInfo& stream : source->streams()) {
    if (stream.kind == StreamKind::Video) study.times[stream.index];
  }
  std::error_code unknown;
  if (!source->remote() && !std::filesystem::is_fifo(url, unknown)) study.read(*source);
  ProbedSource probed;
  probed.chapters = source->chapters();
  for (const StreamInfo& stream : source->streams()) {
    FrameRate rate;
    if (stream.kind == StreamKind::Video) rate = frameRateOf(stream, study.times[stream.index], study.whole);
    probed.tracks.push_back({url, stream, rate});
  }
  return probed;
}

std::string trackText(const ProbedTrack& track) {
  const StreamInfo& s = track.stream;
  std::string words = track.source + print(" %d ", s.index) + kindName(s.kind) + " " + s.codec;
  if (s.kind == StreamKind::Video) words += videoText(track);
  if (s.kind == StreamKind::Audio) words += soundText(s);
  const std::string language = tag(s, "LANGUAGE"), title = titleOf(s);
  if (!language.empty() && language != "und") words += ", language " + language;
  return title.empty() ? words : words + " \"" + title + "\"";
}

std::string chapterText(const Chapter& chapter) {
  return print("%.3f to %.3f s \"", toSeconds(chapter.begin), toSeconds(chapter.end)) + oneLine(chapter.title) + "\"";
}

Json rateJson(const FrameRate& rate) {
  Json json{{"average", rate.average}, {"variable", rate.varies()}, {"still", rate.still}};
  if (rate.exact.known()) json["exact"] = text(rate.exact, '/');
  if (rate.varies()) json["range"] = {rate.lowest, rate.highest};
  return json;
}

Json trackJson(const ProbedTrack& track) {
  const StreamInfo& s = track.stream;
  Json json{{"source", track.source},
            {"index", s.index},
            {"kind", kindName(s.kind)},
            {"video", s.kind == StreamKind::Video},
            {"codec", s.codec},
            {"width", s.width},
            {"height", s.height},
            {"auxiliary", s.auxiliary},
            {"duration_s", toSeconds(s.duration)},
            {"tags", s.tags}};
  if (s.kind == StreamKind::Video) {
    json["pixel_format"] = s.pixel_format;
    json["bits"] = s.bits;
    json["rate"] = rateJson(track.rate);
    json["average_rate"] = text(s.average_rate, '/');
    json["base_rate"] = text(s.base_rate, '/');
    json["sample_aspect_ratio"] = text(ratioOf(s.sample_aspect), ':');
    json["rotation"] = 90 * s.rotation;
    json["field_order"] = nameOf(s.fields);
    json["primaries"] = nameOf(kPrimaries, s.primaries);
    json["transfer"] = nameOf(kTransfers, s.transfer);
  }
  if (s.kind == StreamKind::Audio) {
    json["sample_rate_hz"] = s.sample_rate_hz;
    json["channels"] = s.channels;
    json["channel_layout"] = s.channel_layout;
  }
  if (const std::string language = tag(s, "LANGUAGE"); !language.empty()) json["language"] = language;
  return json;
}

}  // namespace relievo
