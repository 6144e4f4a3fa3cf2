// SPDX-License-Identifier: Apache-2.0
// A back end as the command line and the configuration name it: a word, and what it is told.
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace relievo {

// "sim:hand.csv" is the word sim and the argument hand.csv. The first colon alone parts them, so that a path may hold
// more. What an argument means is the back end's.
struct BackEndName {
  std::string word;                     // empty: none was named
  std::optional<std::string> argument;  // empty behind a colon that nothing follows

  BackEndName() = default;
  // Not explicit: a text is a name wherever one is asked for.
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
