// SPDX-License-Identifier: Apache-2.0
// Lists the tracks, lets the pair reader find the film in them, and reads the first pairs' depth.
#include "app/player/film/probe.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/depth_window/shots.h"
#include "app/media/folder/film_folder.h"
#include "app/media/pairs/long_wait.h"
#include "app/media/photo_list.h"
#include "app/player/film/film_changes.h"
#include "app/player/report.h"
#include "app/scene/film_box.h"
#include "app/scene/height_field.h"
#include "platform/print.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr const char* kHasPhotos =
    "these are photos that hold their depth or two views each; name one of them, or play them all with relievo play";

using Json = nlohmann::ordered_json;

constexpr int kPairsLookedAt = 8;

// Adds one depth frame's samples to what was seen so far.
struct DepthLook {
  DepthUse use;
  std::uint64_t samples = 0, holes = 0;

  void add(const HeightField& field) {
    for (int r = 0; r < field.rows(); ++r) {
      for (int c = 0; c < field.cols(); ++c) add(field.code(c, r), field.heightMm(c, r));
    }
    use.holes = static_cast<double>(holes) / static_cast<double>(samples);
  }
  void add(std::uint32_t code, double height_mm) {
    ++samples;
    if (std::isnan(height_mm)) {
      ++holes;
      return;
    }
    const bool first = samples - holes == 1;
    use.lowest_code = first ? code : std::min(use.lowest_code, code);
    use.highest_code = first ? code : std::max(use.highest_code, code);
    use.lowest_mm = first ? height_mm : std::min(use.lowest_mm, height_mm);
    use.highest_mm = first ? height_mm : std::max(use.highest_mm, height_mm);
  }
};

Outcome<void> lookAtPairs(PairReader& reader, ProbeResult& result) {
  const FilmInfo& film = result.film;
  DepthLook look;
  std::vector<TimedSurface> surfaces;
  for (int i = 0; i < kPairsLookedAt; ++i) {
    const auto pair = reader.next();
    if (!pair) return failOn(reader.failedThing(), pair.error());
    if (!*pair) break;
    if (i == 0) result.volume = usualBox((*pair)->color, (*pair)->depth);
    if ((*pair)->depth.empty()) continue;
    const auto field = HeightField::make((*pair)->depth, film.calibration.calibration, result.volume);
    if (!field) return failOn("depth", field.error());
    look.add(*field);
    ++look.use.pairs;
    const MediaTime time = (*pair)->depth.pts;
    if (surfaces.empty() || time > surfaces.back().time) surfaces.push_back({*field, time, (*pair)->depth.owner});
  }
  result.depth = look.use;
  if (surfaces.size() > kPlanFrames) surfaces.resize(kPlanFrames);  // those on which the player plans, no more
  ShotFinder().mark(surfaces);
  if (!surfaces.empty()) result.touch = planFilm(surfaces);
  result.pairs = reader.counters();
  return {};
}

std::vector<std::string> needsOf(const ProbeResult& r) {
  const FilmInfo& f = r.film;
  std::vector<std::string> needs;
  const double pixels = double(f.color_width) * f.color_height + double(f.depth_width) * f.depth_height;
  needs.push_back(print("a decoder for %s%s%s, %.1f million pixels a second; %s is available", f.color_codec.c_str(),
                        f.depth_codec.empty() ? "" : " and ", f.depth_codec.c_str(), 1e-6 * pixels * r.rate.average,
                        r.decoder.c_str()));
  if (!f.has_depth) {
    needs.push_back("depth for touch: give --depth FILE, or --packing sbs or tb if one picture holds both");
    return needs;
  }
  if (r.depth.pairs == 0) {
    needs.push_back("depth at its beginning: the first pictures have none");
    return needs;
  }
  if (r.depth.highest_mm - r.depth.lowest_mm < 0.25 * r.volume.depth_mm) {
    needs.push_back(
        print("more relief: it takes up %.1f of %.0f mm; try --calibration range=.. or law=inverse,near=MM,far=MM",
              r.depth.highest_mm - r.depth.lowest_mm, r.volume.depth_mm));
  }
  if (r.depth.holes > 0.02) {
    needs.push_back(print("holes filled: %.0f %% of the depth samples are holes, and a hole cannot be touched",
                          100 * r.depth.holes));
  }
  if (r.pairs.mismatched > 0) needs.push_back("depth frames at the colour frames' times: some are missing");
  return needs;
}

// For a live source, from its first pictures.
FrameRate colorRate(const ProbeResult& r) {
  FrameRate rate = r.tracks.at(static_cast<std::size_t>(r.film.color_stream)).rate;
  if (rate.average <= 0 && r.film.frame_period > Duration(0)) rate.average = 1 / toSeconds(r.film.frame_period);
  return rate;
}

Outcome<void> lookAtFilm(const SourceOptions& options, const PairReader::Backends& backends, ProbeResult& result) {
  PairReader reader(backends);
  if (auto opened = openTelling(reader, options); !opened) {
    return failOn(reader.failedThing().empty() ? options.url : reader.failedThing(), opened.error());
  }
  result.film = reader.info();
  result.decoder = result.film.color_decoder;
  if (auto looked = lookAtPairs(reader, result); !looked) return looked;
  result.rate = colorRate(result);
  result.needs = needsOf(result);
  return {};
}

// A picture's file may not state its size before it is decoded; for packed halves, a track has the whole picture's
// size.
void takeSizes(ProbeResult& r) {
  using enum Packing;
  const FilmInfo& f = r.film;
  const bool whole = f.packing == Tracks || f.packing == DepthAlone || f.packing == Alpha ||
                     f.packing == StereoTracks || f.packing == StereoLayers;
  if (!whole) return;
  bool color_seen = false;
  for (ProbedTrack& track : r.tracks) {
    StreamInfo& s = track.stream;
    if (s.kind != StreamKind::Video) continue;
    const bool color = !color_seen && s.index == f.color_stream;
    color_seen = color_seen || color;
    if (s.width > 0 && s.height > 0) continue;
    const bool as_color = color || f.depth_width == 0;  // a second view is as large as the first
    s.width = as_color ? f.color_width : f.depth_width;
    s.height = as_color ? f.color_height : f.depth_height;
  }
}

std::string trackLines(const ProbeResult& r) {
  std::string text;
  for (const ProbedTrack& t : r.tracks) text += "track   " + oneLine(trackText(t)) + "\n";
  for (const Chapter& chapter : r.chapters) text += "chapter " + chapterText(chapter) + "\n";
  return text;
}

}  // namespace

Outcome<ProbeResult> probe(const SourceOptions& options, const PairReader::Backends& backends) {
  ProbeResult result;
  if (photosIn(options, backends.make_source)) return failOn(options.url, {ErrorCode::NotFound, 0, kHasPhotos});
  const bool may_be_folder = options.depth_url.empty() && options.packing == Packing::Auto;
  const auto pair = may_be_folder ? filmOverDepth(options.url) : std::nullopt;
  for (const std::string& url : {pair ? pair->film : options.url, pair ? pair->depth : options.depth_url}) {
    if (url.empty()) continue;
    const WaitTeller teller({.url = url});
    auto probed = readTracks(url, options.frames_per_s, backends);
    if (!probed) return std::unexpected(probed.error());
    result.tracks.insert(result.tracks.end(), probed->tracks.begin(), probed->tracks.end());
    if (result.chapters.empty()) result.chapters = std::move(probed->chapters);
  }
  if (auto looked = lookAtFilm(options, backends, result); !looked) result.failure = looked.error();
  else takeSizes(result);
  return result;
}

std::string probeToText(const ProbeResult& r) {
  std::string text = trackLines(r);
  if (r.failure) return text;
  const FilmInfo& f = r.film;
  text += print("color   %s %d x %d, ", f.color_codec.c_str(), f.color_width, f.color_height) + rateText(r.rate);
  if (!r.rate.still) text += f.duration > Duration(0) ? print(", %.2f s", toSeconds(f.duration)) : ", length unknown";
  text += "\n";
  if (f.has_depth) {
    text += print("depth   %s %d x %d, packing %s\n", f.depth_codec.c_str(), f.depth_width, f.depth_height,
                  name(f.packing));
    text += "reading " + plainLine(f.reading, f.calibration.calibration) + "\n";
    for (const std::string& line : f.reading.why) text += "because " + line + "\n";
    for (const std::string& line : partLines(f.reading)) text += "        " + line + "\n";
    for (const std::string& line : f.reading.offers) text += "or      " + line + "\n";
    text +=
        print("relief  codes %u to %u, %.1f to %.1f mm, %.1f %% holes in the first %d pictures\n", r.depth.lowest_code,
              r.depth.highest_code, r.depth.lowest_mm, r.depth.highest_mm, 100 * r.depth.holes, r.depth.pairs);
    if (r.touch) text += "touch   " + r.touch->reason + "\n";
  } else {
    text += "depth   none\n";
  }
  if (hasTwoViews(f.packing)) {
    text += print("views   left and right, packing %s\n", name(f.packing));
  }
  text += print("volume  %.0f x %.0f x %.0f mm\n", r.volume.width_mm, r.volume.height_mm, r.volume.depth_mm);
  for (const auto& notes : {f.notes, changesOf(f)}) {
    for (const std::string& note : notes) text += "note    " + note + "\n";
  }
  for (const std::string& doubt : f.reading.doubts) text += "doubt   " + doubt + "\n";
  for (const std::string& need : r.needs) text += "needs   " + need + "\n";
  return text;
}

namespace {

Json readingToJson(const FilmInfo& f) {
  Json parts = Json::array();
  for (const CalibrationPart& part : f.reading.parts) {
    parts.push_back({{"part", part.key},
                     {"value", part.value},
                     {"by", name(part.origin)},
                     {"certainty", name(certaintyOf(part.origin))}});
  }
  const std::string line = f.has_depth ? plainLine(f.reading, f.calibration.calibration) : "no depth";
  return {{"line", line}, {"why", f.reading.why}, {"offers", f.reading.offers}, {"parts", parts}};
}

}  // namespace

std::string probeToJson(const ProbeResult& r) {
  const FilmInfo& f = r.film;
  Json json;
  json["tracks"] = Json::array();
  for (const ProbedTrack& t : r.tracks) json["tracks"].push_back(trackJson(t));
  json["chapters"] = Json::array();
  for (const Chapter& c : r.chapters) {
    json["chapters"].push_back({{"begin_s", toSeconds(c.begin)}, {"end_s", toSeconds(c.end)}, {"title", c.title}});
  }
  if (r.failure) {
    json["failure"] = r.failure->thing + ": " + r.failure->error.message;
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }
  json["color"] = {{"codec", f.color_codec}, {"width", f.color_width}, {"height", f.color_height}};
  json["depth"] = nullptr;
  if (f.has_depth) {
    json["depth"] = {{"codec", f.depth_codec},
                     {"width", f.depth_width},
                     {"height", f.depth_height},
                     {"calibration", f.calibration.explanation},
                     {"calibration_origin", name(f.calibration.origin)},
                     {"codes", {r.depth.lowest_code, r.depth.highest_code}},
                     {"relief_mm", {r.depth.lowest_mm, r.depth.highest_mm}},
                     {"holes", r.depth.holes}};
  }
  json["touch"] = nullptr;
  if (r.touch) {
    const ClipMeasure& m = r.touch->measure;
    json["touch"] = {{"quantum_mm", m.quantum_mm},
                     {"noise_mm", m.noise_mm},
                     {"speed_mm_per_s", m.speed_mm_per_s},
                     {"edges", m.edges},
                     {"still", m.still},
                     {"narrow_mm", r.touch->scale.narrow_mm},
                     {"wide_mm", r.touch->scale.wide_mm},
                     {"clamp_mm", r.touch->scale.clamp_mm},
                     {"time", {name(r.touch->scale.narrow_time), name(r.touch->scale.wide_time)}},
                     {"error", r.touch->error},
                     {"reason", r.touch->reason}};
  }
  json["packing"] = name(f.packing);
  json["frames_per_s"] = r.rate.average;
  json["rate"] = rateJson(r.rate);
  json["duration_s"] = toSeconds(f.duration);
  json["volume_mm"] = {r.volume.width_mm, r.volume.height_mm, r.volume.depth_mm};
  json["decoder"] = r.decoder;
  json["reading"] = readingToJson(f);
  json["notes"] = f.notes;
  json["changes"] = changesOf(f);
  json["doubts"] = f.reading.doubts;
  json["needs"] = r.needs;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace relievo
