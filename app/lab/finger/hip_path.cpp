// SPDX-License-Identifier: Apache-2.0
// Strict reading of numbers: a typing error in a measurement must not become a number.
#include "app/lab/finger/hip_path.h"

#include <array>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "platform/text/number_in.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr std::string_view kHeader = "t_s,x_mm,y_mm,z_mm";

std::optional<HipTick> parseRow(std::string_view row) {
  std::array<double, 4> values{};
  if (!readNumbers(row, ',', std::span(values))) return std::nullopt;
  return HipTick{values[0], {values[1], values[2], values[3]}};
}

}  // namespace

Outcome<std::vector<HipTick>> readHipPath(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Recording, "cannot be read; check the path");
  if (!text) return failOn(path, text.error());
  std::istringstream file(*text);
  std::vector<HipTick> ticks;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const auto here = [&] { return path + ": line " + std::to_string(number); };
    if (number == 1) {
      if (line != kHeader) return failOn(here(), {ErrorCode::Corrupt, 0, "the header must be t_s,x_mm,y_mm,z_mm"});
      continue;
    }
    const auto tick = parseRow(line);
    if (!tick) return failOn(here(), {ErrorCode::Corrupt, 0, "a row is four finite numbers with commas between them"});
    if (!ticks.empty() && tick->t_s < ticks.back().t_s)
      return failOn(here(), {ErrorCode::Corrupt, 0, "times must not go back"});
    ticks.push_back(*tick);
  }
  if (ticks.empty())
    return failOn(path, {ErrorCode::Corrupt, 0, "no row of numbers; the file needs a header and at least one row"});
  return ticks;
}

}  // namespace relievo
