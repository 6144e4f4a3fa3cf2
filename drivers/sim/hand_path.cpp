// SPDX-License-Identifier: Apache-2.0
// Reads hand scripts and interpolates their rows.
#include "drivers/sim/hand_path.h"

#include <algorithm>
#include <array>
#include <span>

#include "platform/text/number_in.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr std::string_view kHeader = "t_s,x_mm,y_mm,z_mm";

// Returns what is wrong with the line, or null.
const char* addRow(std::string_view line, std::vector<HandPath::Row>& rows) {
  std::array<double, 4> n{};
  if (!readNumbers(line, ',', std::span(n)))
    return "is not a row of a hand script; a row is four numbers: t_s,x_mm,y_mm,z_mm";
  if (!rows.empty() && n[0] <= rows.back().t_s)
    return "its time is not after that of the row above; sort the rows by time";
  rows.push_back({n[0], {n[1], n[2], n[3]}});
  return nullptr;
}

std::string_view takeLine(std::string_view& text) {
  const auto length = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, length);
  text.remove_prefix(std::min(length + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::unexpected<Failure> wrongLine(const std::string& script_name, int number, const char* what) {
  return failOn(script_name + ":" + std::to_string(number), {ErrorCode::InvalidArgument, 0, what});
}

}  // namespace

Outcome<HandPath> HandPath::parse(std::string_view csv, const std::string& script_name) {
  if (takeLine(csv) != kHeader)
    return wrongLine(script_name, 1, "a hand script begins with the line t_s,x_mm,y_mm,z_mm");
  std::vector<Row> rows;
  int number = 1;
  while (!csv.empty()) {
    ++number;
    if (const char* wrong = addRow(takeLine(csv), rows); wrong != nullptr) return wrongLine(script_name, number, wrong);
  }
  if (rows.empty())
    return wrongLine(script_name, number, "the script has no rows; a row is four numbers: t_s,x_mm,y_mm,z_mm");
  return HandPath(std::move(rows));
}

Outcome<HandPath> HandPath::load(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Recording, "the hand script cannot be read; check its path");
  if (!text) return failOn(path, text.error());
  return parse(*text, path);
}

HandPoint HandPath::at(double t_s) const RELIEVO_RT {
  if (rows_.empty()) return moveHand(motion_, t_s, reach_);
  const auto after =
      std::upper_bound(rows_.begin(), rows_.end(), t_s, [](double t, const Row& row) { return t < row.t_s; });
  if (after == rows_.begin()) return {.position_mm = rows_.front().position_mm};
  if (after == rows_.end()) return {.position_mm = rows_.back().position_mm};
  const Row& before = *(after - 1);
  const double share = (t_s - before.t_s) / (after->t_s - before.t_s);
  return {.position_mm = before.position_mm + share * (after->position_mm - before.position_mm)};
}

}  // namespace relievo
