// SPDX-License-Identifier: Apache-2.0
// Measures the length first, so that nothing is cut off.
#include "platform/print.h"

#include <cstdarg>
#include <cstdio>

namespace relievo {

std::string print(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text;
  if (length > 0) {
    text.resize(static_cast<std::size_t>(length));
    std::vsnprintf(text.data(), text.size() + 1, format, again);
  }
  va_end(again);
  return text;
}

}  // namespace relievo
