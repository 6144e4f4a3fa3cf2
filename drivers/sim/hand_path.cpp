// SPDX-License-Identifier: Apache-2.0
// The stroking hand and the reader of scripts.
#include "drivers/sim/hand_path.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace relievo {
namespace {

constexpr std::string_view kHeader = "t_s,x_mm,y_mm,z_mm";

// From 0 at t = 0 to 1 at t = length, without a corner.
double easeIn(double t, double length) RELIEVO_RT {
  const double u = std::clamp(t / length, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

double wave(double t_s, double period_s) RELIEVO_RT {
  return std::sin(2.0 * std::numbers::pi * t_s / period_s);
}

HandPoint stroke(double t_s, const glm::dvec2& begin_mm) RELIEVO_RT {
  constexpr double kRestS = 0.5, kDownS = 1.2, kUpS = 1.1;  // at most 82 mm/s: contact without a blow
  constexpr double kRoundS = 4.0;                           // down, stroke, up: it is soon out of what let it through
  constexpr double kAboveMm = 48.0, kAimMm = -12.0;         // 40 mm is the nearest that a surface comes
  const double t = std::max(t_s - kRestS, 0.0);
  const double in_round = std::fmod(t, kRoundS);
  const double down = easeIn(in_round, kDownS) - easeIn(in_round - (kRoundS - kUpS), kUpS);
  const double reach = easeIn(t - kDownS, 3.0);  // the first contact is where it begins

  HandPoint point;
  // At most 31 and 28 mm/s; the periods have no common multiple before 803 s, so that no line is drawn twice.
  point.position_mm.x = (1 - reach) * begin_mm.x + reach * 55.0 * wave(t - kDownS, 11.0);
  point.position_mm.y = (1 - reach) * begin_mm.y + reach * 32.0 * wave(t - kDownS, 7.3);
  point.position_mm.z = kAboveMm + down * (kAimMm - kAboveMm);
  point.force_limit_n = 1.5 + 0.5 * wave(t, 3.1);
  return point;
}

// One row of `count` numbers with commas between; false when it is anything else.
bool parseNumbers(std::string_view line, double* numbers, int count) {
  const char* at = line.data();
  const char* const end = line.data() + line.size();
  for (int i = 0; i < count; ++i) {
    const auto [next, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc{} || !std::isfinite(numbers[i])) return false;
    at = next;
    if (i + 1 == count) break;
    if (at == end || *at != ',') return false;
    ++at;
  }
  return at == end;
}

// Nothing wrong: null.
const char* addRow(std::string_view line, std::vector<HandPath::Row>& rows) {
  double n[4] = {};
  if (!parseNumbers(line, n, 4)) return "is no row of the hand script; a row is four numbers: t_s,x_mm,y_mm,z_mm";
  if (!rows.empty() && n[0] <= rows.back().t_s)
    return "its time is not after that of the row above; put the rows in order";
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
  if (rows.empty()) return wrongLine(script_name, number, "no row follows; a row is four numbers: t_s,x_mm,y_mm,z_mm");
  return HandPath(std::move(rows));
}

Outcome<HandPath> HandPath::load(const std::string& path) {
  std::ifstream file(path);
  if (!file) return failOn(path, {ErrorCode::NotFound, errno, "the hand script cannot be read; check its path"});
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) return failOn(path, {ErrorCode::Io, errno, "reading the hand script failed"});
  return parse(text.str(), path);
}

HandPoint HandPath::at(double t_s) const RELIEVO_RT {
  if (rows_.empty()) return stroke(t_s, begin_mm_);
  const auto after =
      std::upper_bound(rows_.begin(), rows_.end(), t_s, [](double t, const Row& row) { return t < row.t_s; });
  if (after == rows_.begin()) return {.position_mm = rows_.front().position_mm};
  if (after == rows_.end()) return {.position_mm = rows_.back().position_mm};
  const Row& before = *(after - 1);
  const double share = (t_s - before.t_s) / (after->t_s - before.t_s);
  return {.position_mm = before.position_mm + share * (after->position_mm - before.position_mm)};
}

}  // namespace relievo
