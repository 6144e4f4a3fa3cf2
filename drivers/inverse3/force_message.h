// SPDX-License-Identifier: Apache-2.0
// The messages to the Haply Inverse service.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

#include "drivers/force/force_port.h"
#include "platform/realtime.h"

namespace relievo::inverse3 {

// The first message to a service of version 3.5 on: names the program, and places the origin in the middle of the
// workspace.
[[nodiscard]] std::string helloMessage(std::string_view device);

// The message that carries a force, once a tick. It owns its memory.
class ForceMessage {
 public:
  // From 3.5 on the force is a "vector", before it was "values".
  void setDevice(std::string_view device, bool from_3_5);
  // `force_n`: the service's frame; each coordinate is limited to 99 N. Valid until the next call.
  [[nodiscard]] PortBytes with(const glm::dvec3& force_n) RELIEVO_RT;

 private:
  void add(std::string_view text) RELIEVO_RT;
  void add(double newtons) RELIEVO_RT;

  std::array<char, 256> text_{};
  std::size_t head_ = 0;  // length of the part that is the same in every message
  std::size_t size_ = 0;
};

}  // namespace relievo::inverse3
