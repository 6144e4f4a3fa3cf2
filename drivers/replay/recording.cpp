// SPDX-License-Identifier: Apache-2.0
// Reads the columns that it needs; errors name the line.
#include "drivers/replay/recording.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "platform/text/number_in.h"
#include "platform/whole_file.h"

namespace relievo {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();
constexpr const char* kNoColumns =
    "is no recording: it needs the columns device_x_mm,device_y_mm,device_z_mm and the device's workspace, or "
    "hip_x_mm,hip_y_mm,hip_z_mm, or x_mm,y_mm,z_mm";

using Cells = std::vector<std::string_view>;

std::string_view takeUntil(std::string_view& text, char end) {
  const auto length = std::min(text.find(end), text.size());
  const std::string_view part = text.substr(0, length);
  text.remove_prefix(std::min(length + 1, text.size()));
  return part;
}
std::string_view takeLine(std::string_view& text) {
  std::string_view line = takeUntil(text, '\n');
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}
Cells cellsOf(std::string_view line) {
  Cells cells;
  for (bool more = true; more;) {
    more = line.find(',') != line.npos;
    cells.push_back(takeUntil(line, ','));
  }
  return cells;
}

std::size_t columnOf(const Cells& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? kAbsent : static_cast<std::size_t>(found - names.begin());
}

// kNone without such a column or without a number in it.
double numberIn(const Cells& cells, std::size_t column) {
  if (column == kAbsent) return kNone;
  return relievo::numberIn<double>(cells[column]).value_or(kNone);
}

// The columns x, y and z of one position.
struct Columns {
  std::size_t x = kAbsent, y = kAbsent, z = kAbsent;
  Columns(const Cells& names, const std::string& thing)
      : x(columnOf(names, thing + "x_mm")), y(columnOf(names, thing + "y_mm")), z(columnOf(names, thing + "z_mm")) {}
  [[nodiscard]] bool all() const { return x != kAbsent && y != kAbsent && z != kAbsent; }
  [[nodiscard]] glm::dvec3 in(const Cells& cells) const {
    return {numberIn(cells, x), numberIn(cells, y), numberIn(cells, z)};
  }
};

bool isFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isRate(double hz) {
  return hz >= 1 && hz <= 1e5;
}

// Its workspace is practically unlimited.
void putInScene(HapticCapabilities& device) {
  constexpr double kFarMm = 1000;
  const glm::dvec3 middle(0, 0, 20);
  device.workspace_min_mm = middle - glm::dvec3(kFarMm);
  device.workspace_max_mm = middle + glm::dvec3(kFarMm);
  device.in_scene = true;
}

// The device's properties from the first row; nullopt if one is missing or impossible. One that points at the picture
// has no workspace of its own.
std::optional<HapticCapabilities> deviceIn(const Cells& names, const Cells& cells) {
  const auto number = [&](std::string_view name) { return numberIn(cells, columnOf(names, name)); };
  HapticCapabilities device{.name = "replay",
                            .workspace_min_mm = Columns(names, "workspace_min_").in(cells),
                            .workspace_max_mm = Columns(names, "workspace_max_").in(cells),
                            .peak_force_n = number("peak_force_n"),
                            .continuous_force_n = number("continuous_force_n"),
                            .max_stiffness_n_per_mm = number("max_stiffness_n_per_mm"),
                            .rate_hz = number("rate_hz")};
  const auto is_absent = [](const glm::dvec3& v) { return std::isnan(v.x) && std::isnan(v.y) && std::isnan(v.z); };
  if (is_absent(device.workspace_min_mm) && is_absent(device.workspace_max_mm)) putInScene(device);
  const glm::dvec3 room = device.workspace_max_mm - device.workspace_min_mm;
  const auto is_sound = [](double value) { return std::isfinite(value) && value > 0; };
  const bool whole = isFinite(room) && room.x > 0 && room.y > 0 && room.z > 0 && is_sound(device.peak_force_n) &&
                     is_sound(device.continuous_force_n) && is_sound(device.max_stiffness_n_per_mm) &&
                     isRate(device.rate_hz);
  return whole ? std::optional(device) : std::nullopt;
}

// For a path of the finger.
HapticCapabilities sceneDevice() {
  HapticCapabilities device{
      .name = "replay", .peak_force_n = 8.5, .continuous_force_n = 8.5, .max_stiffness_n_per_mm = 1};
  putInScene(device);
  return device;
}

class Reader {
 public:
  Reader(const Cells& names, std::string_view first_row) : names_(names), position_(names, "device_") {
    const Cells cells = cellsOf(first_row);
    const auto device = position_.all() && cells.size() == names_.size() ? deviceIn(names_, cells) : std::nullopt;
    recording_.capabilities = device.value_or(sceneDevice());
    if (device) {
      buttons_ = columnOf(names_, "buttons");
      answered_ = columnOf(names_, "device_present");
    } else {
      position_ = Columns(names_, "hip_");
      if (!position_.all()) position_ = Columns(names_, "");
      time_ = columnOf(names_, "t_s");
    }
  }
  [[nodiscard]] bool finds() const { return position_.all(); }

  // Returns what is wrong with the line, or null.
  const char* addRow(std::string_view line) {
    const Cells cells = cellsOf(line);
    if (cells.size() != names_.size())
      return "its number of cells differs from the header's; give one cell for each column";
    RecordedTick tick{.position_mm = position_.in(cells)};
    if (!isFinite(tick.position_mm)) return "its position is not a number; give x, y and z in mm";
    if (buttons_ != kAbsent) {
      const double buttons = numberIn(cells, buttons_);
      if (!(buttons >= 0 && buttons <= 0xFFFFFFFFU && buttons == std::floor(buttons)))
        return "its buttons are not a whole number; give 0 for none";
      tick.buttons = static_cast<std::uint32_t>(buttons);
    }
    if (answered_ != kAbsent) tick.answered = numberIn(cells, answered_) != 0;
    const double t_s = numberIn(cells, time_);
    if (recording_.ticks.empty()) first_s_ = t_s;
    last_s_ = t_s;
    recording_.ticks.push_back(tick);
    return nullptr;
  }

  // If the file does not state the rate, it is the number of ticks over the recording's length, rounded.
  [[nodiscard]] Recording finish() && {
    const double rate = std::round(static_cast<double>(recording_.ticks.size() - 1) / (last_s_ - first_s_));
    if (isRate(rate)) recording_.capabilities.rate_hz = rate;
    return std::move(recording_);
  }

 private:
  const Cells& names_;
  Recording recording_;
  Columns position_;
  std::size_t buttons_ = kAbsent, answered_ = kAbsent, time_ = kAbsent;
  double first_s_ = kNone, last_s_ = kNone;
};

std::unexpected<Failure> wrongLine(const std::string& name, int number, const char* what) {
  return failOn(name + ":" + std::to_string(number), {ErrorCode::InvalidArgument, 0, what});
}

}  // namespace

Outcome<Recording> Recording::parse(std::string_view csv, const std::string& name) {
  const Cells names = cellsOf(takeLine(csv));
  std::string_view rest = csv;
  Reader reader(names, takeLine(rest));
  if (!reader.finds()) return wrongLine(name, 1, kNoColumns);
  int number = 1;
  while (!csv.empty()) {
    ++number;
    if (const char* wrong = reader.addRow(takeLine(csv)); wrong != nullptr) return wrongLine(name, number, wrong);
  }
  if (number == 1) return wrongLine(name, 2, "the recording has no rows; it needs one for each tick");
  return std::move(reader).finish();
}

Outcome<Recording> Recording::load(const std::string& path) {
  const auto text = readWholeFile(path, FileSize::Recording, "the recording cannot be read; check its path");
  if (!text) return failOn(path, text.error());
  return parse(*text, path);
}

}  // namespace relievo
