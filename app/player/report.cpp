// SPDX-License-Identifier: Apache-2.0
// The report's forms.
#include "app/player/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/player/touch/finger_name.h"
#include "platform/print.h"

namespace relievo {
namespace {

using Json = nlohmann::ordered_json;

// A figure for people; JSON cannot express values that are not finite.
double rounded(double value, double per_unit = 1e6) {
  return std::isfinite(value) ? std::round(value * per_unit) / per_unit : 0.0;
}

Json orNull(const std::optional<double>& value) {
  return value ? Json(rounded(*value)) : Json(nullptr);
}

Json toJson(const HapticSummary::Times& t) {
  return {{"p50", t.p50}, {"p99", t.p99}, {"p999", t.p999}, {"max", t.max}};
}

Json toJson(const LiveLatency::Times& t) {
  return {{"p50", rounded(t.p50_ms, 1e3)}, {"p99", rounded(t.p99_ms, 1e3)}, {"max", rounded(t.max_ms, 1e3)}};
}

Json livePart(const std::optional<LiveLatency>& live) {
  if (!live) return nullptr;
  return {{"picture_latency_ms", toJson(live->picture)},
          {"touch_latency_ms", live->touch ? toJson(*live->touch) : Json()},
          {"touch_before_picture_ms", toJson(live->before)},
          {"touch_behind_picture_ms", toJson(live->behind)}};
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Json reliefPart(const ReliefSummary& reliefs) {
  if (reliefs.made == 0) return nullptr;
  return {{"made", reliefs.made},
          {"dropped", reliefs.dropped},
          {"matched_cols", reliefs.cols},
          {"mean_ms", rounded(reliefs.mean_ms, 1e2)}};
}

Json videoPart(const PlayReport& r) {
  return {{"frames_shown", r.frames_shown},
          {"frames_dropped", r.frames_dropped},
          {"pairs_mismatched", r.pairs.mismatched},
          {"pairs_without_depth", r.pairs.without_depth},
          {"pairs_damaged", r.pairs.damaged},
          {"pictures_lost", r.pairs.missed_pictures},
          {"pictures_left_out", r.pairs.left_out},
          {"reconnects", r.pairs.reconnects},
          {"depth_reconnects", r.pairs.depth_reconnects},
          {"time_jumps", r.pairs.jumps},
          {"first_frame_ms", orNull(r.first_frame_ms)},
          {"display", r.display},
          {"mode", r.display_mode},
          {"stereo", r.stereo},
          {"surface", {r.surface_width, r.surface_height}},
          {"color_planes", r.imported ? "dma-buf" : "uploaded"},
          {"triangles", r.triangles},
          {"picture_error_px", rounded(r.picture_error_px, 1e2)},
          {"mesh_ms", rounded(r.mesh_ms, 1e3)},
          {"draw_ms", rounded(r.draw_ms, 1e3)},
          {"drawn_size", rounded(r.drawn_size, 1e2)},
          {"reliefs", reliefPart(r.reliefs)}};
}

Json filmPart(const PlayReport& r) {
  const FilmInfo& f = r.film;
  return {
      {"color",
       {{"codec", f.color_codec}, {"decoder", f.color_decoder}, {"width", f.color_width}, {"height", f.color_height}}},
      {"depth", f.has_depth ? Json{{"codec", f.depth_codec},
                                   {"decoder", f.depth_decoder},
                                   {"width", f.depth_width},
                                   {"height", f.depth_height}}
                            : Json(nullptr)},
      {"packing", name(f.packing)},
      {"reading", f.has_depth ? Json(plainLine(f.reading, f.calibration.calibration)) : Json(nullptr)},
      {"notes", f.notes},
      {"doubts", f.reading.doubts},
      {"calibration", f.has_depth ? Json(f.calibration.explanation) : Json(nullptr)},
      {"frame_period_s", rounded(toSeconds(f.frame_period))},
      {"duration_s", rounded(toSeconds(f.duration))},
      {"volume_mm", {rounded(r.volume.width_mm, 1e3), rounded(r.volume.height_mm, 1e3), r.volume.depth_mm}}};
}

Json audioPart(const PlayReport& r) {
  const SoundSummary& s = r.sound;
  return {{"device", s.device},
          {"codec", r.film.sound_codec},
          {"rate_hz", s.rate_hz},
          {"underruns", s.underruns},
          {"realigned", s.realigned},
          {"pictures", s.pictures},
          {"max_offset_ms", rounded(s.max_offset_ms, 1e3)},
          {"mean_offset_ms", rounded(s.mean_offset_ms, 1e3)},
          {"drift_ppm", rounded(s.drift_ppm, 1e1)}};
}

Json hapticPart(const HapticSummary& h, const std::optional<double>& first_touch_ms) {
  Json histogram = Json::array();
  for (const auto& [ns, ticks] : h.wakeup_histogram) histogram.push_back({ns, ticks});
  return {{"device", h.device},
          {"plan", h.plan},
          {"scheduler", h.scheduler},
          {"memory_locked", h.memory_locked},
          {"memory_bytes",
           {{"task", h.memory.task},
            {"method", h.memory.method},
            {"stack", h.memory.stack},
            {"counters", h.memory.counters},
            {"stack_used", h.memory.stack_used}}},
          {"rate_hz", rounded(h.rate_hz, 1e3)},
          {"ticks", h.ticks},
          {"first_touch_ms", orNull(first_touch_ms)},
          {"contact_share", rounded(share(h.contact_ticks, h.ticks))},
          {"overruns", h.overruns},
          {"allocations", h.allocations},
          {"page_faults", h.page_faults},
          {"update_ns", toJson(h.update)},
          {"wakeup_ns", toJson(h.wakeup)},
          {"contact_told_ns", h.contact_told ? toJson(*h.contact_told) : Json()},
          {"wakeup_histogram", histogram}};
}

Json forcePart(const HapticSummary& h) {
  return {{"max_n", rounded(h.max_force_n)}, {"max_scene_slew_n_per_s", rounded(h.max_scene_slew_n_per_s)}};
}

Json energyPart(const HapticSummary& h) {
  return {{"scene_mj", rounded(h.scene_mj)}, {"artefact_mj", rounded(h.artefact_mj)}};
}

Json touchPart(const HapticSummary& h, const std::optional<double>& first_touch_ms) {
  return {{"haptic", hapticPart(h, first_touch_ms)}, {"force", forcePart(h)}, {"energy", energyPart(h)}};
}

void addTouch(Json& json, const PlayReport& r) {
  json.update(touchPart(r.haptic, r.first_touch_ms));
  if (!r.second_finger) return;
  json["second_finger"] = touchPart(r.second_finger->haptic, r.second_finger->first_touch_ms);
}

}  // namespace

bool PlayReport::addFault(double time_s, std::string what, std::string done) {
  // A device that fails a thousand times a second is one entry.
  if (!faults.empty() && faults.back().what == what && faults.back().done == done) {
    ++faults.back().count;
    return false;
  }
  const bool known = std::any_of(faults.begin(), faults.end(), [&](const FaultEntry& f) { return f.what == what; });
  constexpr std::size_t kMost = 1000;  // of a film that loops for months; a fault of another name is kept even then
  const std::size_t most = known ? kMost : 2 * kMost;
  if (faults.size() < most) faults.push_back({time_s, std::move(what), std::move(done)});
  return !known;
}

std::string toJson(const PlayReport& r) {
  Json json;
  json["source"] = r.source;
  if (!r.depth_source.empty()) json["depth_source"] = r.depth_source;
  if (r.films.size() > 1) json["films"] = r.films;
  json["film"] = filmPart(r);
  json["wall_s"] = rounded(r.wall_s);
  json["media_s"] = rounded(r.media_s);
  json["video"] = videoPart(r);
  json["live"] = livePart(r.live);
  json["audio"] = audioPart(r);
  addTouch(json, r);
  json["states"] = Json::array();
  for (const PlayerState state : r.states) json["states"].push_back(name(state));
  json["seeks"] = Json::array();
  for (const SeekEntry& s : r.seeks) {
    json["seeks"].push_back({{"target_s", rounded(s.target_s)},
                             {"picture_s", orNull(s.picture_s)},
                             {"surface_s", orNull(s.surface_s)},
                             {"picture_ms", orNull(s.picture_ms)},
                             {"surface_ms", orNull(s.surface_ms)}});
  }
  json["faults"] = Json::array();
  for (const FaultEntry& f : r.faults) {
    json["faults"].push_back({{"time_s", rounded(f.time_s)}, {"what", f.what}, {"done", f.done}, {"count", f.count}});
  }
  // A path need not be UTF-8, JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string metricsOf(const PlayReport& r) {
  Json json{{"wall_s", rounded(r.wall_s)},
            {"media_s", rounded(r.media_s)},
            {"video", videoPart(r)},
            {"live", livePart(r.live)},
            {"audio", audioPart(r)}};
  addTouch(json, r);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

namespace {

std::string filmText(const PlayReport& r) {
  if (r.frames_shown == 0) return print("film    no picture was shown in %.2f s\n", r.wall_s);
  const double first_ms = r.first_frame_ms.value_or(0);
  constexpr double kNoTime = 0.005;  // a still picture, or one that was paused all the time
  if (r.media_s < kNoTime)
    return print("film    one picture was shown for %.2f s, after %.0f ms\n", r.wall_s, first_ms);
  const bool chosen =
      std::ranges::find(r.states, PlayerState::Browsing) != r.states.end();  // after a while in the list
  if (chosen) return print("film    %.2f s shown in %.2f s\n", r.media_s, r.wall_s);
  return print("film    %.2f s shown in %.2f s, first picture after %.0f ms\n", r.media_s, r.wall_s, first_ms);
}

std::string liveText(const PlayReport& r) {
  const LiveLatency& live = *r.live;
  std::string text =
      print("live    seen %.0f ms after it was taken (p99 %.0f)", live.picture.p50_ms, live.picture.p99_ms);
  if (live.touch) {
    text += print(", felt after %.0f ms (p99 %.0f); touch at most %.0f ms before the picture, %.0f behind (p99)",
                  live.touch->p50_ms, live.touch->p99_ms, live.before.p99_ms, live.behind.p99_ms);
  }
  return text + print("; %llu pictures lost on the way\n", static_cast<unsigned long long>(r.pairs.missed_pictures));
}

std::string pictureFigures(const PlayReport& r) {
  return print("picture %s, %s, %d x %d, %zu triangles, %.1f ms a frame; %llu pairs mismatched\n", r.display.c_str(),
               r.stereo.c_str(), r.surface_width, r.surface_height, r.triangles, r.draw_ms,
               static_cast<unsigned long long>(r.pairs.mismatched));
}

// `who`: which finger's, if there are two.
std::string touchText(const PlayReport& r, const HapticSummary& h, const std::string& who) {
  if (h.ticks == 0) return "touch   " + who + "none\n";
  if (!r.film.has_depth) return "touch   " + who + "nothing to feel: the film has no depth\n";
  const unsigned long long missed = h.overruns, all = h.ticks + h.overruns;
  return print("touch   %s%s, %.0f %% of the time in contact, at most %.2f N, %llu of %llu ticks missed\n", who.c_str(),
               h.device.c_str(), 100 * share(h.contact_ticks, h.ticks), h.max_force_n, missed, all);
}

std::string touchFigures(const PlayReport& r, const HapticSummary& h) {
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  std::string text = r.film.has_depth ? "felt    " + h.plan + "\n" : "";
  text += print("tick    %.0f Hz (%s), median %.1f us, p99 %.1f us, longest %.1f us; woken late by %.1f us (p99)\n",
                h.rate_hz, h.scheduler.c_str(), us(h.update.p50), us(h.update.p99), us(h.update.max), us(h.wakeup.p99));
  return text + print("force   the scene changed it by at most %.0f N/s; energy %.2f mJ scene, %.2f mJ artefacts\n",
                      h.max_scene_slew_n_per_s, h.scene_mj, h.artefact_mj);
}

}  // namespace

std::string toText(const PlayReport& r, bool verbose) {
  std::string text = filmText(r);
  text += print("video   %llu frames shown, %llu dropped\n", static_cast<unsigned long long>(r.frames_shown),
                static_cast<unsigned long long>(r.frames_dropped));
  if (verbose) text += pictureFigures(r);
  if (r.live) text += liveText(r);
  const auto addFinger = [&](const HapticSummary& h, const char* name) {
    text += touchText(r, h, r.second_finger ? std::string(name) + ": " : "");
    if (verbose && h.ticks > 0) text += touchFigures(r, h);
  };
  addFinger(r.haptic, kFirstFinger);
  if (r.second_finger) addFinger(r.second_finger->haptic, kSecondFinger);
  return text;
}

}  // namespace relievo
