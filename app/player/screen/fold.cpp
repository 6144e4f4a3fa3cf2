// SPDX-License-Identifier: Apache-2.0
// Counts letters of UTF-8 by their first bytes.
#include "app/player/screen/fold.h"

namespace relievo {
namespace {

struct Letter {
  std::string_view bytes;
  int cells = 1;
};

// An invalid byte is a letter of its own.
Letter firstOf(std::string_view text) noexcept {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t said = byte(0) < 0xc0 ? 1 : byte(0) < 0xe0 ? 2 : byte(0) < 0xf0 ? 3 : 4;
  std::size_t length = 1;
  while (length < said && length < text.size() && byte(length) >> 6 == 2) ++length;
  // From U+1100 on (Hangul, kana, ideographs); the signs of Latin scripts up to U+2E7F are narrow.
  const bool wide = length == 4 || (length == 3 && (byte(0) > 0xe2 || (byte(0) == 0xe2 && byte(1) >= 0xba)));
  return {text.substr(0, length), wide ? 2 : 1};
}

std::vector<Letter> lettersOf(std::string_view text) {
  std::vector<Letter> letters;
  while (!text.empty()) {
    letters.push_back(firstOf(text));
    text.remove_prefix(letters.back().bytes.size());
  }
  return letters;
}

// A dot before a figure may stand in a number, one behind a space begins a word (".npy").
bool mayBreakAfter(const std::vector<Letter>& letters, std::size_t at) noexcept {
  const Letter& letter = letters[at];
  const char next = letters[at + 1].bytes[0];
  const bool in_word = at > 0 && letters[at - 1].bytes != " " && !(next >= '0' && next <= '9');
  return letter.cells == 2 || letter.bytes == " " || letter.bytes == "-" || letter.bytes == "_" ||
         (letter.bytes == "." && in_word);
}

// How many letters from `first` on fill a line.
std::size_t lineFrom(const std::vector<Letter>& letters, std::size_t first, int cells) {
  std::size_t end = first, good = first;
  int used = 0;
  while (end < letters.size() && used + letters[end].cells <= cells) {
    used += letters[end].cells;
    if (end + 1 < letters.size() && mayBreakAfter(letters, end) && 3 * used > cells) good = end + 1;
    ++end;
  }
  return end < letters.size() && good > first ? good - first : end - first;
}

std::string join(const std::vector<Letter>& letters, std::size_t first, std::size_t count) {
  std::string text;
  for (std::size_t i = first; i < first + count; ++i) text += letters[i].bytes;
  return text;
}

// The beginning and the end of the remaining letters, with dots between, since both parts of a file's name matter.
std::string shortened(const std::vector<Letter>& letters, std::size_t first, int cells) {
  const std::size_t head = lineFrom(letters, first, cells * 2 / 3);
  int room = cells / 3 - 1;
  std::size_t tail = letters.size();
  while (tail > first + head && room >= letters[tail - 1].cells) room -= letters[--tail].cells;
  return join(letters, first, head) + "…" + join(letters, tail, letters.size() - tail);
}

}  // namespace

std::vector<std::string> folded(std::string_view text, int cells, std::size_t most_lines) {
  const std::vector<Letter> letters = lettersOf(text);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < letters.size();) {
    const std::size_t count = lineFrom(letters, at, cells);
    if (lines.size() + 1 == most_lines && at + count < letters.size()) {
      lines.push_back(shortened(letters, at, cells));
      break;
    }
    if (count == 0) break;
    lines.push_back(join(letters, at, count));
    at += count;
  }
  return lines;
}

}  // namespace relievo
