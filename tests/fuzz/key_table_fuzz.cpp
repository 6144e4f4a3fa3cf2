// SPDX-License-Identifier: Apache-2.0
// Any text as a key table: rejected with its line number, or every command in it reads back.
#include <cstdlib>
#include <string_view>

#include "app/player/control/key_table.h"
#include "tests/support/command_words.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto table = KeyTable::parse(text, "keys.toml");
  if (!table) return 0;
  static_cast<void>(table->help());
  for (int code = 0; code < 0x300; ++code) {
    const auto* binding = table->find(PlayerState::Playing, static_cast<std::uint16_t>(code));
    if (binding == nullptr || !binding->press) continue;
    const auto again = parseCommand(test::wordsOf(*binding->press));
    if (!again || again->verb != binding->press->verb) std::abort();
  }
  return 0;
}
