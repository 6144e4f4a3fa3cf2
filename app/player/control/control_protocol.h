// SPDX-License-Identifier: Apache-2.0
// What programs and the player say to one another: one JSON object a line, both ways. Pure.
//
// A program asks:   {"do": "seek +10"}      any words of app/player/control/command.h, and:
//                   {"do": "status"}        what is going on; "second_finger" is null without a second device
//                   {"do": "metrics on"}    counters and histograms, once a second until "metrics off"
//                   {"do": "fault haptic unplug"}  of a mock device; which there are, the answer to a wrong one says
// with an "id" of its own, if it likes: a whole number, or a text of at most 64 bytes, which comes back in the answer.
//
// The player answers each line in turn: {"id": .., "ok": true}, or {"id": .., "ok": false, "error": ".."}, also for a
// command that can do nothing now, as "pause" without a film. True means that it was heard; what comes of it, the
// events tell. To all, whoever asked:
//                   {"event": "state", "state": "playing", "time_s": 12.3}   seconds since the player started
//                   {"event": "fault", "what": "..", "done": "..", "time_s": 12.3}   likewise good news, as "display
//                   back"
// and to those who wished them:
//                   {"event": "metrics", ..}   in the words of the report
#pragma once

#include <expected>
#include <string>
#include <string_view>
#include <variant>

#include "app/player/browse/film_shelf.h"
#include "app/player/control/command.h"
#include "app/player/report.h"
#include "app/player/screen/screen_text.h"
#include "app/player/state_table.h"

namespace relievo {

struct StatusRequest {};
struct MetricsRequest {
  bool on = false;
};
struct FaultRequest {
  std::string device, fault;
};
using ControlRequest = std::variant<PlayerCommand, StatusRequest, MetricsRequest, FaultRequest>;

struct ControlLine {
  std::string id;                                    // as JSON; empty: none
  std::expected<ControlRequest, std::string> asked;  // else what is wrong
};

// Any bytes.
[[nodiscard]] ControlLine parseControlLine(std::string_view line);

// Each one line, without its end.
[[nodiscard]] std::string okLine(const std::string& id);
[[nodiscard]] std::string errorLine(const std::string& id, const std::string& error);
// `list`: the films to choose from, if they are shown; it tells at most kMostListed of them.
inline constexpr std::size_t kMostListed = 200;
[[nodiscard]] std::string statusLine(const std::string& id, const ScreenFacts& facts, const std::string& source,
                                     const FilmShelf* list = nullptr);
[[nodiscard]] std::string stateLine(PlayerState state, double time_s);
[[nodiscard]] std::string faultLine(const FaultEntry& fault);
[[nodiscard]] std::string metricsLine(const PlayReport& report);

}  // namespace relievo
