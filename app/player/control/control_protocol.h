// SPDX-License-Identifier: Apache-2.0
// The protocol between programs and the player: one JSON object per line, in both directions. Pure.
//
// A program asks:   {"do": "seek +10"}      any words of app/player/control/command.h, and:
//                   {"do": "status"}        the player's state; "second_finger" is null without a second device
//                   {"do": "metrics on"}    counters and histograms, once a second until "metrics off"
//                   {"do": "fault haptic unplug"}  of a mock device; the answer to a wrong one lists all
// and optionally an "id": a whole number, or a text of at most 64 bytes, which the answer repeats.
//
// The player answers each line in turn: {"id": .., "ok": true}, or {"id": .., "ok": false, "error": ".."}, also for a
// command that has no effect now, such as "pause" without a film. True means that the command was accepted; events
// report its effect. Events go to all clients:
//   {"event": "state", "state": "playing", "time_s": 12.3}   seconds since the player started
//   {"event": "fault", "what": "..", "done": "..", "time_s": 12.3}   also for recoveries: "display back"
// and to those that asked for them:
//   {"event": "metrics", ..}   with the names of the report
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

// Accepts any bytes.
[[nodiscard]] ControlLine parseControlLine(std::string_view line);

// Each returns one line, without its end.
[[nodiscard]] std::string okLine(const std::string& id);
[[nodiscard]] std::string errorLine(const std::string& id, const std::string& error);
// `list`: the films to choose from, if they are shown; at most kMostListed of them are sent.
inline constexpr std::size_t kMostListed = 200;
[[nodiscard]] std::string statusLine(const std::string& id, const ScreenFacts& facts, const std::string& source,
                                     const FilmShelf* list = nullptr);
[[nodiscard]] std::string stateLine(PlayerState state, double time_s);
[[nodiscard]] std::string faultLine(const FaultEntry& fault);
[[nodiscard]] std::string metricsLine(const PlayReport& report);

}  // namespace relievo
