// SPDX-License-Identifier: Apache-2.0
// The shape of the messages is that of docs.haply.co, "Simulation channel", versions 3.1 to 3.5.
#include "drivers/inverse3/snapshot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/inverse3/json_cursor.h"

namespace relievo::inverse3 {
namespace {

constexpr double kFarthestM = 1;  // the arms reach 0.3 m

bool isPlain(char c) RELIEVO_RT {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_' ||
         c == '.' || c == ':';
}

// All three coordinates, each within reach.
std::optional<glm::dvec3> readPosition(JsonCursor& json) RELIEVO_RT {
  std::optional<double> x, y, z;
  json.object([&](std::string_view key) RELIEVO_RT {
    if (key == "x") x = json.number();
    else if (key == "y") y = json.number();
    else if (key == "z") z = json.number();
    else json.skip();
  });
  for (const auto& each : {x, y, z}) {
    if (!each || !(std::abs(*each) <= kFarthestM)) return std::nullopt;
  }
  return glm::dvec3(*x, *y, *z);
}

struct Arm {
  DeviceId id;
  std::optional<glm::dvec3> position_m;
  bool powered = true, ready = true, from_3_5 = false, small = false;
};

Arm readArm(JsonCursor& json) RELIEVO_RT {
  Arm arm;
  json.object([&](std::string_view key) RELIEVO_RT {
    if (key == "device_id") arm.id = DeviceId(json.string().value_or(""));
    else if (key == "config") {
      json.object([&](std::string_view field) RELIEVO_RT {
        if (field == "type") arm.small = json.string() == "minverse";
        else json.skip();
      });
    } else if (key == "state") {
      json.object([&](std::string_view field) RELIEVO_RT {
        arm.from_3_5 = arm.from_3_5 || field == "control_mode";
        if (field == "cursor_position") arm.position_m = readPosition(json);
        else json.skip();
      });
    } else if (key == "status") {
      json.object([&](std::string_view field) RELIEVO_RT {
        if (field == "power_supply") arm.powered = json.boolean().value_or(true);
        else if (field == "ready") arm.ready = json.boolean().value_or(true);
        else json.skip();
      });
    } else json.skip();
  });
  return arm;
}

std::uint32_t bit(std::optional<bool> down, unsigned place) RELIEVO_RT {
  return down.value_or(false) ? 1U << place : 0U;
}

// A wired grip has one `button`, a wireless one has `buttons`, whose last state stays when it is out of reach or its
// battery is empty: these then count as released.
std::uint32_t readGrip(JsonCursor& json) RELIEVO_RT {
  std::uint32_t down = 0;
  bool connected = true;
  const auto buttons = [&](std::string_view key) RELIEVO_RT {
    if (key == "a") down |= bit(json.boolean(), 0);
    else if (key == "b") down |= bit(json.boolean(), 1);
    else if (key == "c") down |= bit(json.boolean(), 2);
    else json.skip();
  };
  const auto state = [&](std::string_view key) RELIEVO_RT {
    if (key == "button") down |= bit(json.boolean(), 0);
    else if (key == "buttons") json.object(buttons);
    else json.skip();
  };
  const auto status = [&](std::string_view key) RELIEVO_RT {
    if (key == "connected") connected = json.boolean().value_or(true);
    else json.skip();
  };
  json.object([&](std::string_view key) RELIEVO_RT {
    if (key == "state") json.object(state);
    else if (key == "status") json.object(status);
    else json.skip();
  });
  return connected ? down : 0;
}

// What is listed, in its order: nothing in a message says which grip is at which arm.
struct Lists {
  std::size_t arms = 0, chosen = 0;  // `chosen` counts from 1
  std::array<std::uint32_t, 8> grips{};
  std::size_t grip_count = 0;
  void add(std::uint32_t buttons) RELIEVO_RT {
    if (grip_count < grips.size()) grips[grip_count] = buttons;
    ++grip_count;
  }
  [[nodiscard]] std::uint32_t ownButtons(std::uint32_t otherwise) const RELIEVO_RT {
    const bool paired = chosen > 0 && arms == grip_count && arms <= grips.size();
    return paired ? grips[chosen - 1] : otherwise;
  }
};

// `place` counts down to the device that is asked for, if its name is not given.
void take(const Arm& arm, std::string_view wanted, int& place, Snapshot& to, Lists& lists) RELIEVO_RT {
  ++lists.arms;
  to.from_3_5 = to.from_3_5 || arm.from_3_5;
  const bool good = !arm.id.text().empty() && to.id.text().empty();
  if (!good || (wanted.empty() ? place-- > 0 : arm.id.text() != wanted)) return;
  lists.chosen = lists.arms;
  to.id = arm.id;
  to.position_m = arm.position_m;
  to.small = arm.small;
  to.powered = arm.powered;
  to.ready = arm.ready;
}

}  // namespace

DeviceId::DeviceId(std::string_view text) RELIEVO_RT {
  if (text.size() > text_.size() || !std::all_of(text.begin(), text.end(), isPlain)) return;
  std::copy(text.begin(), text.end(), text_.begin());
  size_ = static_cast<std::uint8_t>(text.size());
}

std::optional<Snapshot> readSnapshot(std::string_view text, std::string_view wanted, int place) RELIEVO_RT {
  JsonCursor json(text);
  Snapshot snapshot;
  Lists lists;
  if (!json.isObject()) return std::nullopt;
  bool strange = false, known = false;
  json.object([&](std::string_view key) RELIEVO_RT {
    const bool grip = key == "verse_grip" || key == "wireless_verse_grip";
    (grip || key == "inverse3" || key == "session_id" ? known : strange) = true;
    if (key == "inverse3") {
      snapshot.of_3_0 = snapshot.of_3_0 || json.isObject();
      json.array([&]() RELIEVO_RT { take(readArm(json), wanted, place, snapshot, lists); });
    } else if (grip) {
      json.array([&]() RELIEVO_RT {
        const std::uint32_t buttons = readGrip(json);
        snapshot.buttons |= buttons;
        lists.add(buttons);
      });
    } else {
      snapshot.from_3_5 = snapshot.from_3_5 || key == "session_id";
      json.skip();
    }
  });
  if (!json.atEnd()) return std::nullopt;
  snapshot.known = known || !strange;
  snapshot.own_buttons = lists.ownButtons(snapshot.buttons);
  return snapshot;
}

}  // namespace relievo::inverse3
