// SPDX-License-Identifier: Apache-2.0
// The charts of a quick run of relievo-lab, and the tables that they draw.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo::test {

using CsvRow = std::map<std::string, std::string>;

inline std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

// A figure that is not a number is an empty cell.
inline double numberIn(const CsvRow& row, const std::string& column) {
  const std::string& cell = row.at(column);
  EXPECT_FALSE(cell.empty()) << column;
  return cell.empty() ? std::nan("") : std::strtod(cell.c_str(), nullptr);
}

class Csv {
 public:
  explicit Csv(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    const auto header = cellsOf(line);
    while (std::getline(file, line)) {
      const auto cells = cellsOf(line);
      EXPECT_LE(cells.size(), header.size()) << line;
      CsvRow row;
      for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = i < cells.size() ? cells[i] : "";
      rows_.push_back(row);
    }
  }
  // The number in `column` of the one row that has all the wanted cells.
  [[nodiscard]] double value(const CsvRow& wanted, const std::string& column) const {
    const CsvRow* found = nullptr;
    int count = 0;
    for (const CsvRow& row : rows_) {
      bool same = true;
      for (const auto& [name, text] : wanted) same = same && row.count(name) == 1 && row.at(name) == text;
      if (!same) continue;
      found = &row;
      ++count;
    }
    EXPECT_EQ(count, 1) << column;
    return found == nullptr ? std::nan("") : numberIn(*found, column);
  }
  [[nodiscard]] const std::vector<CsvRow>& rows() const { return rows_; }

 private:
  std::vector<CsvRow> rows_;
};

// A machine without EGL draws no relief; every other chart is there.
inline bool withoutEgl(const ProgramResult& result) {
  const std::size_t drawing = result.err.find("relievo-lab: drawing: ");
  return drawing != std::string::npos && (result.err.find("EGL", drawing) != std::string::npos ||
                                          result.err.find("GLES", drawing) != std::string::npos);
}

// One run serves all tests, also those of classes derived from this one.
class LabCharts : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (folder_) return;
    folder_ = std::make_unique<TemporaryFolder>();
    result_ = runProgram("relievo-lab report --quick --out " + out(), *folder_ / ".");
  }
  void SetUp() override {
    if (result_.err.find("gnuplot-nox") != std::string::npos) GTEST_SKIP() << result_.err;
    ASSERT_EQ(result_.exit_code, withoutEgl(result_) ? 1 : 0) << result_.err;
  }
  static std::string out() { return *folder_ / "charts"; }
  static std::string out(const std::string& file) { return out() + "/" + file; }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  static inline ProgramResult result_;
};

}  // namespace relievo::test
