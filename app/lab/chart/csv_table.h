// SPDX-License-Identifier: Apache-2.0
// A table of figures to be written as CSV.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// Text is written as it is (it must not contain commas), a number with six digits, NaN as an empty cell.
class Cell {
 public:
  Cell(const char* text) : text_(text) {}                      // NOLINT(google-explicit-constructor): rows are lists
  Cell(std::string text) : text_(std::move(text)) {}           // NOLINT(google-explicit-constructor)
  Cell(double number);                                         // NOLINT(google-explicit-constructor)
  Cell(int number) : text_(std::to_string(number)) {}          // NOLINT(google-explicit-constructor)
  Cell(std::size_t number) : text_(std::to_string(number)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class CsvTable {
 public:
  explicit CsvTable(const std::vector<Cell>& header) { row(header); }
  void row(const std::vector<Cell>& cells);
  // The file appears whole or not at all.
  [[nodiscard]] Outcome<void> write(const std::string& path) const;

 private:
  std::string text_;
};

}  // namespace relievo
