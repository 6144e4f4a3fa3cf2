// SPDX-License-Identifier: Apache-2.0
// nlohmann's parser keeps its own stack, so that deep nesting costs memory of the line's size and no more.
#include "app/player/control/control_protocol.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/player/screen/stereo_word.h"

namespace relievo {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostId = 64;

// What came from outside need not be UTF-8, JSON must be.
std::string lineOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double rounded(double value) {
  return std::isfinite(value) ? std::round(value * 1e3) / 1e3 : 0.0;
}

// The selected film's number as `select` takes it.
Json listOf(const FilmShelf& shelf) {
  Json films = Json::array();
  for (const ShelfSection& section : shelf.sections()) {
    for (const ShelfFilm& film : section.films) {
      if (films.size() == kMostListed) break;
      films.push_back({{"section", section.name},
                       {"title", film.title},
                       {"source", film.url},
                       {"left_s", film.left_s ? Json(rounded(*film.left_s)) : Json(nullptr)}});
    }
  }
  return {{"selected", shelf.empty() ? Json(nullptr) : Json(shelf.selected() + 1)},
          {"count", shelf.size()},
          {"films", std::move(films)}};
}

Json fingerOf(const FingerFacts& finger) {
  return {{"haptic", finger.haptic.empty() ? Json(nullptr) : Json(finger.haptic)}, {"contact", finger.contact}};
}

Json answer(const std::string& id, bool ok) {
  Json json;
  if (!id.empty()) json["id"] = Json::parse(id, nullptr, false);
  json["ok"] = ok;
  return json;
}

std::optional<std::string> idOf(const Json& id) {
  const bool taken = id.is_number_integer() || (id.is_string() && id.get_ref<const std::string&>().size() <= kMostId);
  return taken ? std::optional(lineOf(id)) : std::nullopt;
}

std::expected<ControlRequest, std::string> requestOf(const std::string& words) {
  if (words == "status") return StatusRequest{};
  if (words == "metrics on" || words == "metrics off") return MetricsRequest{words.ends_with("on")};
  constexpr std::string_view kFault = "fault ";
  if (words.starts_with(kFault)) {
    const std::size_t space = words.find(' ', kFault.size());
    if (space == std::string::npos) return std::unexpected("write: fault DEVICE WHAT");
    return FaultRequest{words.substr(kFault.size(), space - kFault.size()), words.substr(space + 1)};
  }
  if (auto command = parseCommand(words)) return std::move(*command);
  const std::string why = whyNoCommand(words);
  return std::unexpected(why.starts_with("unknown") ? why + ", status, metrics on|off, fault DEVICE WHAT" : why);
}

}  // namespace

ControlLine parseControlLine(std::string_view line) {
  ControlLine read{"", std::unexpected("a line is one JSON object, such as {\"do\": \"pause\"}")};
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return read;
  if (const auto id = json.find("id"); id != json.end()) {
    auto kept = idOf(*id);
    if (!kept) {
      read.asked = std::unexpected("\"id\" is a whole number, or a text of at most 64 bytes");
      return read;
    }
    read.id = std::move(*kept);
  }
  const auto words = json.find("do");
  if (words == json.end() || !words->is_string()) {
    read.asked = std::unexpected("\"do\" is missing or not text; for example {\"do\": \"pause\"}");
  } else if (json.size() > 1 + (read.id.empty() ? 0U : 1U)) {
    read.asked = std::unexpected("an object has \"do\" and \"id\", and nothing else");
  } else if (words->get_ref<const std::string&>().find('\0') != std::string::npos) {
    read.asked = std::unexpected("\"do\" holds a zero byte, which no file and no address has");
  } else {
    read.asked = requestOf(words->get<std::string>());
  }
  return read;
}

std::string okLine(const std::string& id) {
  return lineOf(answer(id, true));
}

std::string errorLine(const std::string& id, const std::string& error) {
  Json json = answer(id, false);
  json["error"] = error;
  return lineOf(json);
}

std::string statusLine(const std::string& id, const ScreenFacts& facts, const std::string& source,
                       const FilmShelf* list) {
  Json json = answer(id, true);
  json["state"] = name(facts.state);
  const bool film = !source.empty();
  json["source"] = film ? Json(source) : Json(nullptr);
  json["position_s"] = film ? Json(rounded(facts.position_s)) : Json(nullptr);
  json["title"] = film ? Json(facts.title) : Json(nullptr);
  json["duration_s"] = film && facts.duration_s > 0 ? Json(rounded(facts.duration_s)) : Json(nullptr);
  json["rate"] = facts.rate;
  json["loop"] = facts.loop;
  json["film"] = film ? Json(facts.film) : Json(nullptr);
  json["films"] = film ? Json(facts.films) : Json(nullptr);
  json["chapter"] = film && !facts.chapter.empty() ? Json(facts.chapter) : Json(nullptr);
  json["stereo"] = stereoWord(facts.stereo);
  json["swap_eyes"] = facts.stereo.swap_eyes;
  json["depth_strength"] = rounded(facts.stereo.strength);
  json["zoom"] = rounded(facts.stereo.zoom);
  json["aspect"] = facts.aspect;
  json["rotation"] = facts.turned_degrees;
  json["full_screen"] = facts.full_screen;
  json["volume"] = rounded(facts.volume_percent);
  json["muted"] = facts.muted;
  json["audio"] = film ? Json(facts.sound_track) : Json(nullptr);
  json["audio_delay_s"] = rounded(facts.sound_delay_s);
  json["subtitles"] = film ? Json(facts.subtitle_track) : Json(nullptr);
  json["subtitle_delay_s"] = rounded(facts.subtitle_delay_s);
  json["subtitle_size"] = rounded(facts.subtitle_size);
  json["loop_from_s"] = facts.loop_from_s ? Json(rounded(*facts.loop_from_s)) : Json(nullptr);
  json["loop_to_s"] = facts.loop_to_s ? Json(rounded(*facts.loop_to_s)) : Json(nullptr);
  json["has_depth"] = film && facts.has_depth;
  json.update(fingerOf(facts.fingers[0]));
  json["second_finger"] = facts.fingers[1].haptic.empty() ? Json(nullptr) : fingerOf(facts.fingers[1]);
  json["list"] = list != nullptr ? listOf(*list) : Json(nullptr);
  return lineOf(json);
}

std::string stateLine(PlayerState state, double time_s) {
  return lineOf({{"event", "state"}, {"state", name(state)}, {"time_s", rounded(time_s)}});
}

std::string faultLine(const FaultEntry& fault) {
  return lineOf({{"event", "fault"}, {"what", fault.what}, {"done", fault.done}, {"time_s", rounded(fault.time_s)}});
}

std::string metricsLine(const PlayReport& report) {
  return "{\"event\":\"metrics\"," + metricsOf(report).substr(1);
}

}  // namespace relievo
