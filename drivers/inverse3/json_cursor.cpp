// SPDX-License-Identifier: Apache-2.0
// The grammar of RFC 8259; depth is limited, so that no text can exhaust the stack.
#include "drivers/inverse3/json_cursor.h"

#include <charconv>
#include <system_error>

namespace relievo::inverse3 {
namespace {

bool isDigit(char c) RELIEVO_RT {
  return c >= '0' && c <= '9';
}

bool isHex(char c) RELIEVO_RT {
  return isDigit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

}  // namespace

bool JsonCursor::atEnd() RELIEVO_RT {
  return good_ && peek() == 0 && at_ == end_;
}

char JsonCursor::peek() RELIEVO_RT {
  while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  return at_ != end_ ? *at_ : '\0';
}

bool JsonCursor::take(char wanted) RELIEVO_RT {
  if (!good_ || peek() != wanted || at_ == end_) return false;
  ++at_;
  return true;
}

void JsonCursor::expect(char wanted) RELIEVO_RT {
  if (!take(wanted)) spoil();
}

bool JsonCursor::enter(char opening) RELIEVO_RT {
  if (!take(opening)) return false;
  if (++depth_ > kDeepest) spoil();
  return true;
}

bool JsonCursor::leave(char closing, bool first) RELIEVO_RT {
  if (!good_) return true;
  if (take(closing)) {
    --depth_;
    return true;
  }
  if (!first) expect(',');
  return !good_;
}

std::optional<std::string_view> JsonCursor::string() RELIEVO_RT {
  if (peek() != '"') {
    skip();
    return std::nullopt;
  }
  const std::string_view text = quoted();
  return good_ ? std::optional(text) : std::nullopt;
}

std::optional<double> JsonCursor::number() RELIEVO_RT {
  if (peek() != '-' && !isDigit(peek())) {
    skip();
    return std::nullopt;
  }
  const std::string_view text = numeral();
  double value = 0;
  // from_chars neither allocates nor uses the locale. A number out of its type's range counts as absent.
  if (!good_ || std::from_chars(text.data(), text.data() + text.size(), value).ec != std::errc()) return std::nullopt;
  return value;
}

std::optional<bool> JsonCursor::boolean() RELIEVO_RT {
  if (peek() == 't' && word("true")) return true;
  if (peek() == 'f' && word("false")) return false;
  skip();
  return std::nullopt;
}

void JsonCursor::skip() RELIEVO_RT {
  if (!good_) return;
  switch (peek()) {
    case '{':
      return object([this](std::string_view) RELIEVO_RT { skip(); });
    case '[':
      return array([this]() RELIEVO_RT { skip(); });
    case '"':
      return static_cast<void>(quoted());
    case 't':
      return static_cast<void>(word("true"));
    case 'f':
      return static_cast<void>(word("false"));
    case 'n':
      return static_cast<void>(word("null"));
    default:
      return static_cast<void>(numeral());
  }
}

std::string_view JsonCursor::quoted() RELIEVO_RT {
  expect('"');
  const char* const begin = at_;
  while (good_) {
    if (at_ == end_ || static_cast<unsigned char>(*at_) < 0x20) {
      spoil();
    } else if (*at_ == '"') {
      return {begin, static_cast<std::size_t>(at_++ - begin)};
    } else if (*at_++ == '\\') {
      escape();
    }
  }
  return {};
}

void JsonCursor::escape() RELIEVO_RT {
  if (at_ == end_) return spoil();
  const char kind = *at_++;
  if (kind != 'u') {
    if (std::string_view("\"\\/bfnrt").find(kind) == std::string_view::npos) spoil();
    return;
  }
  for (int i = 0; i < 4; ++i) {
    if (at_ == end_ || !isHex(*at_)) return spoil();
    ++at_;
  }
}

std::string_view JsonCursor::numeral() RELIEVO_RT {
  const char* const begin = at_;
  if (at_ != end_ && *at_ == '-') ++at_;
  const bool zero = at_ != end_ && *at_ == '0';  // no other digit follows it
  if (zero) ++at_;
  else if (!digits()) spoil();
  if (at_ != end_ && *at_ == '.') {
    ++at_;
    if (!digits()) spoil();
  }
  if (at_ != end_ && (*at_ == 'e' || *at_ == 'E')) {
    ++at_;
    if (at_ != end_ && (*at_ == '+' || *at_ == '-')) ++at_;
    if (!digits()) spoil();
  }
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

bool JsonCursor::digits() RELIEVO_RT {
  const char* const begin = at_;
  while (at_ != end_ && isDigit(*at_)) ++at_;
  return at_ != begin;
}

bool JsonCursor::word(std::string_view wanted) RELIEVO_RT {
  if (!std::string_view(at_, static_cast<std::size_t>(end_ - at_)).starts_with(wanted)) {
    spoil();
    return false;
  }
  at_ += wanted.size();
  return true;
}

}  // namespace relievo::inverse3
