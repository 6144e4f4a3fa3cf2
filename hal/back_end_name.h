// SPDX-License-Identifier: Apache-2.0
// A back end's name on the command line and in the configuration: a word and an argument.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace relievo {

// "sim:hand.csv" has the word sim and the argument hand.csv. The first colon separates them; the argument, a path for
// example, may hold more. Each back end defines what its argument means.
struct BackEndName {
  std::string word;                     // empty: no back end named
  std::optional<std::string> argument;  // an empty string if nothing follows the colon

  BackEndName() = default;
  // Not explicit, so that a string can be passed where a name is expected.
  template <std::convertible_to<std::string_view> Text>
  BackEndName(const Text& text) {
    const std::string_view all(text);
    word = all.substr(0, all.find(':'));
    if (word.size() < all.size()) argument = all.substr(word.size() + 1);
  }

  [[nodiscard]] bool plain(std::string_view wanted) const { return word == wanted && !argument; }
  [[nodiscard]] bool withArgument(std::string_view wanted) const {
    return word == wanted && argument && !argument->empty();
  }
  [[nodiscard]] bool with(std::string_view wanted, std::string_view wanted_argument) const {
    return word == wanted && argument == wanted_argument;
  }
  [[nodiscard]] std::string text() const { return argument ? word + ":" + *argument : word; }

  friend bool operator==(const BackEndName&, const BackEndName&) = default;
};

}  // namespace relievo
