// SPDX-License-Identifier: Apache-2.0
// Any bytes as a line of the control socket: a valid request, or an error answer on one line of JSON.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

#include "app/player/control/control_protocol.h"
#include "tests/fuzz/fuzz_port.h"
#include "tests/support/command_words.h"

namespace relievo {
namespace {

using test::require;

void isOneObject(const std::string& line) {
  require(line.find('\n') == std::string::npos, "an answer is one line");
  require(nlohmann::json::parse(line, nullptr, false).is_object(), "and one object");
}

void fuzz(std::string_view line) {
  const ControlLine read = parseControlLine(line);
  isOneObject(okLine(read.id));
  if (!read.asked) {
    require(!read.asked.error().empty(), "a refusal says why");
    isOneObject(errorLine(read.id, read.asked.error()));
  } else if (const auto* command = std::get_if<PlayerCommand>(&*read.asked)) {
    const auto again = parseCommand(test::wordsOf(*command));
    require(again && again->verb == command->verb && again->word == command->word, "its words mean the same");
    isOneObject(statusLine(read.id, {}, command->word));
  }
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzz({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
