// SPDX-License-Identifier: Apache-2.0
// Parses the needed parts of a message from the Haply Inverse service: handle position, buttons, device state.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>

#include "platform/realtime.h"

namespace relievo::inverse3 {

// A device's name. Only letters, digits, '-', '_', '.' and ':', so that it is the same in JSON.
class DeviceId {
 public:
  DeviceId() = default;
  // Empty unless `text` is such a name of at most 63 characters.
  explicit DeviceId(std::string_view text) RELIEVO_RT;
  [[nodiscard]] std::string_view text() const RELIEVO_RT { return {text_.data(), size_}; }

 private:
  std::array<char, 63> text_{};
  std::uint8_t size_ = 0;
};

struct Snapshot {
  bool from_3_5 = false;                 // has what only versions from 3.5 on send
  bool known = false;                    // lists devices, or nothing at all
  bool of_3_0 = false;                   // lists them in the older form, by name, as the service does on port 10000
  DeviceId id;                           // of the Inverse3 that was asked for; empty if it is not listed
  std::optional<glm::dvec3> position_m;  // the service's frame: x right, y forward, z up
  bool small = false;                    // a Minverse; known from messages with the configuration, such as the first
  bool powered = true, ready = true;     // unless the service says otherwise
  std::uint32_t buttons = 0;             // of any grip: a, b, c are the bits 0, 1, 2
  std::uint32_t own_buttons = 0;  // of the grip at this arm's place, if as many grips as arms are listed; else any
};

// Empty unless `text` is one whole JSON object. `wanted`: the device asked for; empty: the one at `place`, from 0.
// Fields of other kinds than expected and numbers beyond a metre are as if absent.
[[nodiscard]] std::optional<Snapshot> readSnapshot(std::string_view text, std::string_view wanted,
                                                   int place = 0) RELIEVO_RT;

}  // namespace relievo::inverse3
