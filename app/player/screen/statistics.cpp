// SPDX-License-Identifier: Apache-2.0
// One row for each part of the player.
#include "app/player/screen/statistics.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/sdr_color.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Duration kPeriod = std::chrono::seconds(1);

unsigned long long count(std::uint64_t value) noexcept {
  return value;
}

std::string depthOf(const FilmInfo& film) {
  if (!film.has_depth) return "no depth";
  return print("depth %dx%d %s", film.depth_width, film.depth_height, film.depth_codec.c_str());
}

std::string colorOf(const FilmInfo& film) {
  const char* const hdr = hdrName(film.color_transfer);
  return hdr == nullptr ? "SDR" : print("HDR (%s), mapped to SDR by ITU-R BT.2390", hdr);
}

// "eng [deu] 3": tracks by language, or by number if they have none; the chosen track is in brackets.
std::string listOf(const std::vector<FilmTrack>& tracks, std::optional<std::size_t> chosen) {
  std::string list;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::string& language = tracks[i].language;
    const std::string name = language.empty() || language == "und" ? std::to_string(i + 1) : language;
    list += (i == 0 ? "" : " ") + (chosen == i ? "[" + name + "]" : name);
  }
  return list.empty() ? "none" : list;
}

void addTouch(ScreenRows& rows, const HapticSummary& haptic, const std::string& which, double force_n, bool has_depth) {
  if (haptic.ticks == 0) return;
  rows.emplace_back("tick" + which, print("%.0f Hz, %.1f us, 99.9 %% under %.1f us, %llu missed", haptic.rate_hz,
                                          static_cast<double>(haptic.update.p50) * 1e-3,
                                          static_cast<double>(haptic.update.p999) * 1e-3, count(haptic.overruns)));
  rows.emplace_back("force" + which, print("%.2f N, at most %.2f N", force_n, haptic.max_force_n));
  if (which.empty() && has_depth) rows.emplace_back("felt", haptic.plan);
}

}  // namespace

ScreenRows Statistics::rows(const PlayReport& report, const FingerForces& forces_n, MonotonicTime now) {
  const double seconds = last_ == MonotonicTime{} ? 0 : toSeconds(now - last_);
  const double rate = seconds > 0 ? static_cast<double>(report.frames_shown - shown_) / seconds : 0;
  shown_ = report.frames_shown;
  last_ = now;
  next_ = now + kPeriod;
  const FilmInfo& film = report.film;
  const double nominal = film.frame_period > Duration(0) ? 1 / toSeconds(film.frame_period) : 0;
  ScreenRows rows{{"rate", print("%.1f of %.2f frames/s, %llu dropped", rate, nominal, count(report.frames_dropped))}};
  if (film.color_width > 0) {  // it is open
    rows.emplace_back(
        "picture", print("%dx%d %s, ", film.color_width, film.color_height, film.color_codec.c_str()) + depthOf(film));
    rows.emplace_back("colour", colorOf(film));
    rows.emplace_back("tracks",
                      "sound " + listOf(film.sounds, film.sound) + ", subtitles " + listOf(film.subtitles, film.words));
    rows.emplace_back("decoder", film.color_decoder);
  }
  rows.emplace_back("drawing", print("%.1f ms, %zu triangles, error %.2f px", report.draw_ms, report.triangles,
                                     report.picture_error_px));
  addTouch(rows, report.haptic, "", forces_n[0], film.has_depth);
  if (report.second_finger) addTouch(rows, report.second_finger->haptic, " 2", forces_n[1], film.has_depth);
  if (!report.sound.device.empty()) {
    rows.emplace_back("sound", print("%s, %.1f ms off at most, %llu gaps", report.sound.device.c_str(),
                                     report.sound.max_offset_ms, count(report.sound.underruns)));
  }
  return rows;
}

}  // namespace relievo
