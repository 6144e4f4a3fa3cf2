// SPDX-License-Identifier: Apache-2.0
// Numbers and texts as bytes, for tests that write a format themselves.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace relievo::test {

// Little-endian values one after another.
class ByteWriter {
 public:
  template <class T>
  ByteWriter& add(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  ByteWriter& raw(std::string_view bytes) { return bytes_.append(bytes), *this; }
  // With its length in front.
  ByteWriter& text(std::string_view text) { return add(static_cast<std::uint32_t>(text.size())).raw(text); }
  ByteWriter& time(std::int64_t ns) {
    return add(static_cast<std::uint32_t>(ns / 1'000'000'000)).add(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// The bytes of one value.
template <class T>
std::string number(T value) {
  return ByteWriter().add(value).bytes();
}

}  // namespace relievo::test
