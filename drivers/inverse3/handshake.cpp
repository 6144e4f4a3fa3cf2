// SPDX-License-Identifier: Apache-2.0
// Base64 and SHA-1 are FFmpeg's, which every player links already.
#include "drivers/inverse3/handshake.h"

extern "C" {
#include <libavutil/base64.h>
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}

#include <algorithm>
#include <cctype>
#include <memory>
#include <span>

namespace relievo::inverse3 {
namespace {

constexpr std::string_view kGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // the standard's
using Sha1 = std::array<std::uint8_t, 20>;

std::string base64(std::span<const std::uint8_t> bytes) {
  std::string text(AV_BASE64_SIZE(bytes.size()), '\0');
  av_base64_encode(text.data(), static_cast<int>(text.size()), bytes.data(), static_cast<int>(bytes.size()));
  text.pop_back();  // the terminating zero
  return text;
}

Sha1 sha1(const std::string& text) {
  struct Free {
    void operator()(AVSHA* sha) const noexcept { av_free(sha); }
  };
  const std::unique_ptr<AVSHA, Free> sha(av_sha_alloc());
  Sha1 sum{};
  av_sha_init(sha.get(), 160);
  av_sha_update(sha.get(), reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  av_sha_final(sha.get(), sum.data());
  return sum;
}

bool sameWord(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, {}, [](unsigned char c) { return std::tolower(c); }, [](unsigned char c) { return std::tolower(c); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// The value of a field of `head`; empty without it.
std::string_view field(std::string_view head, std::string_view name) {
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos && sameWord(line.substr(0, colon), name))
      return trimmed(line.substr(colon + 1));
  }
  return {};
}

}  // namespace

std::string upgradeRequest(const std::string& host, const Nonce& nonce) {
  return "GET / HTTP/1.1\r\nHost: " + host +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: " + base64(nonce) +
         "\r\nSec-WebSocket-Version: 13\r\n\r\n";
}

bool acceptsUpgrade(std::string_view head, const Nonce& nonce) {
  return head.starts_with("HTTP/1.1 101") && sameWord(field(head, "Upgrade"), "websocket") &&
         sameWord(field(head, "Connection"), "upgrade") && field(head, "Sec-WebSocket-Extensions").empty() &&
         field(head, "Sec-WebSocket-Accept") == base64(sha1(base64(nonce) + std::string(kGuid)));
}

}  // namespace relievo::inverse3
