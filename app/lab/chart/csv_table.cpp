// SPDX-License-Identifier: Apache-2.0
// Rows of text until they are all there.
#include "app/lab/chart/csv_table.h"

#include <cmath>

#include "platform/atomic_file.h"
#include "platform/print.h"

namespace relievo {

Cell::Cell(double number) : text_(std::isfinite(number) ? print("%.6g", number) : std::string()) {}

void CsvTable::row(const std::vector<Cell>& cells) {
  for (const Cell& cell : cells) text_ += (&cell == cells.data() ? "" : ",") + cell.text();
  text_ += '\n';
}

Outcome<void> CsvTable::write(const std::string& path) const {
  auto file = AtomicFile::create(path);
  if (!file) return failOn(path, file.error());
  file->write(text_);
  if (const auto done = file->commit(); !done) return failOn(path, done.error());
  return {};
}

}  // namespace relievo
