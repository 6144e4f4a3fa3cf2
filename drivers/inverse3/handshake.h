// SPDX-License-Identifier: Apache-2.0
// The HTTP request that makes a connection a WebSocket, and the check of its answer (RFC 6455, section 4).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace relievo::inverse3 {

using Nonce = std::array<std::uint8_t, 16>;

[[nodiscard]] std::string upgradeRequest(const std::string& host, const Nonce& nonce);

// `head`: the answer up to the empty line. True if it accepts this request.
[[nodiscard]] bool acceptsUpgrade(std::string_view head, const Nonce& nonce);

}  // namespace relievo::inverse3
