// SPDX-License-Identifier: Apache-2.0
// Walks through JSON text (RFC 8259) once, without memory of its own: the caller takes the values that it wants and
// skips the others.
#pragma once

#include <optional>
#include <string_view>

#include "platform/realtime.h"

namespace relievo::inverse3 {

// Every call consumes one value, of any kind; one that is not of the kind asked for is skipped. After bad text,
// `good` is false and calls do nothing. Text in strings is not decoded: one with escapes is its raw text.
class JsonCursor {
 public:
  explicit JsonCursor(std::string_view text) RELIEVO_RT : at_(text.data()), end_(text.data() + text.size()) {}

  [[nodiscard]] bool good() const RELIEVO_RT { return good_; }
  [[nodiscard]] bool isObject() RELIEVO_RT { return peek() == '{'; }
  // True if nothing but blanks follows.
  [[nodiscard]] bool atEnd() RELIEVO_RT;

  // Calls each(key) for each member; it must consume the value.
  template <class Each>
  void object(const Each& each) RELIEVO_RT {
    if (!enter('{')) return skip();
    for (bool first = true; !leave('}', first); first = false) {
      const std::string_view key = quoted();
      expect(':');
      if (good_) each(key);
    }
  }
  // Calls each() for each element; it must consume the value.
  template <class Each>
  void array(const Each& each) RELIEVO_RT {
    if (!enter('[')) return skip();
    for (bool first = true; !leave(']', first); first = false) {
      if (good_) each();
    }
  }
  [[nodiscard]] std::optional<std::string_view> string() RELIEVO_RT;
  [[nodiscard]] std::optional<double> number() RELIEVO_RT;
  [[nodiscard]] std::optional<bool> boolean() RELIEVO_RT;
  void skip() RELIEVO_RT;

 private:
  static constexpr int kDeepest = 32;

  // The next character that is no blank, not consumed; 0 at the end.
  [[nodiscard]] char peek() RELIEVO_RT;
  [[nodiscard]] bool take(char wanted) RELIEVO_RT;
  [[nodiscard]] bool enter(char opening) RELIEVO_RT;
  // True at the end of an object or array, and after bad text; else it is at the next element.
  [[nodiscard]] bool leave(char closing, bool first) RELIEVO_RT;
  void expect(char wanted) RELIEVO_RT;
  [[nodiscard]] std::string_view quoted() RELIEVO_RT;
  void escape() RELIEVO_RT;
  [[nodiscard]] std::string_view numeral() RELIEVO_RT;
  [[nodiscard]] bool digits() RELIEVO_RT;
  [[nodiscard]] bool word(std::string_view wanted) RELIEVO_RT;
  void spoil() RELIEVO_RT { good_ = false; }

  const char* at_;
  const char* end_;
  int depth_ = 0;
  bool good_ = true;
};

}  // namespace relievo::inverse3
