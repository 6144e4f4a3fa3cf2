// SPDX-License-Identifier: Apache-2.0
// Connects the player to programs on the control socket, and to the service manager.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "app/player/control/control_protocol.h"
#include "app/player/control/control_socket.h"
#include "app/player/setup/service_manager.h"
#include "platform/clock.h"
#include "platform/error.h"

namespace relievo {

class Player;

// Use on the player's thread; no call waits. The messages are described in control_protocol.h.
class PlayerControl {
 public:
  // Switches a fault of a mock device: "haptic", "unplug".
  using FaultSwitch = std::function<Result<void>(std::string_view device, std::string_view fault)>;

  // Null: no control socket.
  PlayerControl(std::unique_ptr<ControlSocket> socket, FaultSwitch switchFault)
      : socket_(std::move(socket)), switchFault_(std::move(switchFault)) {}

  // Call at least once a round of the player's loop: carries out the programs' requests.
  void attend(Player& player, MonotonicTime now);

  void ready() noexcept { service_.ready(); }
  void stopping() noexcept { service_.stopping(); }
  // `time_s` since the player started.
  void stateChanged(PlayerState state, double time_s);
  // Sends a fault to the clients. A fault that repeats the last one is sent once.
  void happened(const FaultEntry& fault);

 private:
  void answer(Player& player, const ControlSocket::Line& line, MonotonicTime now);
  [[nodiscard]] std::string carryOut(Player& player, const ControlLine& line, ControlSocket::ClientId client,
                                     MonotonicTime now);
  void sendMetrics(const Player& player, MonotonicTime now);
  void tellStatus(const Player& player);

  std::unique_ptr<ControlSocket> socket_;
  FaultSwitch switchFault_;
  ServiceManager service_;
  std::set<ControlSocket::ClientId> metered_;
  MonotonicTime next_metrics_;
  bool status_changed_ = true;
  std::string last_fault_;
};

}  // namespace relievo
