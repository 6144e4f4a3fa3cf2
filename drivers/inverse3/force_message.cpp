// SPDX-License-Identifier: Apache-2.0
// Numbers are written here: the C library's printf may allocate and follows the locale.
#include "drivers/inverse3/force_message.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace relievo::inverse3 {

std::string helloMessage(std::string_view device) {
  return R"({"session":{"configure":{"profile":{"name":"relievo"}}},"inverse3":[{"device_id":")" + std::string(device) +
         R"(","configure":{"preset":{"preset":"arm_front_centered"}}}]})";
}

void ForceMessage::setDevice(std::string_view device, bool from_3_5) {
  size_ = 0;
  add(R"({"inverse3":[{"device_id":")");
  add(device);
  add(R"(","commands":{"set_cursor_force":{")");
  add(from_3_5 ? "vector" : "values");
  add(R"(":{"x":)");
  head_ = size_;
}

PortBytes ForceMessage::with(const glm::dvec3& force_n) RELIEVO_RT {
  size_ = head_;
  add(force_n.x);
  add(R"(,"y":)");
  add(force_n.y);
  add(R"(,"z":)");
  add(force_n.z);
  add("}}}}]}");
  return {reinterpret_cast<const std::uint8_t*>(text_.data()), size_};
}

// The longest message has 63 characters of name and three numbers of 8: 169 characters.
void ForceMessage::add(std::string_view text) RELIEVO_RT {
  const std::size_t bytes = std::min(text.size(), text_.size() - size_);
  std::copy_n(text.begin(), bytes, text_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += bytes;
}

// In tenths of a millinewton: "-1.2345".
void ForceMessage::add(double newtons) RELIEVO_RT {
  constexpr double kMostN = 99;
  const bool none = !std::isfinite(newtons);
  auto rest = none ? 0 : static_cast<std::int32_t>(std::lround(std::clamp(newtons, -kMostN, kMostN) * 1e4));
  std::array<char, 8> digits{};
  std::size_t at = digits.size();
  const bool negative = rest < 0;
  rest = std::abs(rest);
  for (int place = 0; place < 6 && (place < 5 || rest > 0); ++place) {
    if (place == 4) digits[--at] = '.';
    digits[--at] = static_cast<char>('0' + rest % 10);
    rest /= 10;
  }
  if (negative) digits[--at] = '-';
  add(std::string_view(&digits[at], digits.size() - at));
}

}  // namespace relievo::inverse3
