// SPDX-License-Identifier: Apache-2.0
// Passes requests to the player's commands, and its answers back.
#include "app/player/control/player_control.h"

#include <utility>

#include "app/player/player.h"

namespace relievo {
namespace {

constexpr int kLinesARound = 64;  // so that a program that sends without end does not stop the film
constexpr Duration kMetricsPeriod = std::chrono::seconds(1);

}  // namespace

void PlayerControl::attend(Player& player, MonotonicTime now) {
  service_.wentRound(now);
  if (std::exchange(status_changed_, false)) tellStatus(player);
  if (socket_ == nullptr) return;
  static const std::string kRefusal =
      errorLine("", "8 other programs are connected; connect again, and disconnect when done");
  socket_->attend(kRefusal);
  for (int i = 0; i < kLinesARound; ++i) {
    const auto line = socket_->next();
    if (!line) break;
    answer(player, *line, now);
  }
  if (!metered_.empty() && now >= next_metrics_) sendMetrics(player, now);
}

void PlayerControl::answer(Player& player, const ControlSocket::Line& line, MonotonicTime now) {
  const std::string said = line.too_long ? errorLine("", "the line is too long; the limit is 4096 bytes")
                                         : carryOut(player, parseControlLine(line.text), line.client, now);
  socket_->send(line.client, said);
}

std::string PlayerControl::carryOut(Player& player, const ControlLine& line, ControlSocket::ClientId client,
                                    MonotonicTime now) {
  if (!line.asked) return errorLine(line.id, line.asked.error());
  const ControlRequest& asked = *line.asked;
  if (std::holds_alternative<StatusRequest>(asked))
    return statusLine(line.id, player.facts(), player.source(), player.list());
  if (const auto* metrics = std::get_if<MetricsRequest>(&asked)) {
    if (metrics->on) metered_.insert(client);
    else metered_.erase(client);
  } else if (const auto* fault = std::get_if<FaultRequest>(&asked)) {
    const auto switched = switchFault_(fault->device, fault->fault);
    if (!switched) return errorLine(line.id, switched.error().message);
  } else {
    const auto& command = std::get<PlayerCommand>(asked);
    if (const auto why = player.refusal(command)) return errorLine(line.id, *why);
    player.obey(command, now);
  }
  return okLine(line.id);
}

void PlayerControl::sendMetrics(const Player& player, MonotonicTime now) {
  next_metrics_ = now + kMetricsPeriod;
  const std::string line = metricsLine(player.report());
  std::erase_if(metered_, [&](ControlSocket::ClientId client) { return !socket_->send(client, line); });
}

void PlayerControl::tellStatus(const Player& player) {
  const ScreenFacts facts = player.facts();
  service_.status(player.source().empty() ? name(facts.state) : name(facts.state) + (" " + facts.title));
}

void PlayerControl::stateChanged(PlayerState state, double time_s) {
  status_changed_ = true;
  last_fault_.clear();
  if (socket_ != nullptr) socket_->sendToAll(stateLine(state, time_s));
}

void PlayerControl::happened(const FaultEntry& fault) {
  if (socket_ == nullptr || std::exchange(last_fault_, fault.what) == fault.what) return;
  socket_->sendToAll(faultLine(fault));
}

}  // namespace relievo
