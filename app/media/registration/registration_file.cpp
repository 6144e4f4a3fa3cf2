// SPDX-License-Identifier: Apache-2.0
// Reads a registration from TOML.
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/media/registration/registration.h"
#include "platform/text/dotted_names.h"

namespace relievo {
namespace {

constexpr const char* kNoToml = "the registration is not valid TOML";
constexpr const char* kBadCamera =
    "[depth] and [color] each need size = [columns, rows], focal = [x, y] and center = [x, y], in pixels, and may have "
    "distortion = [k1, k2, p1, p2, k3] or [k1, k2, p1, p2, k3, k4, k5, k6]";
constexpr const char* kBadMotion =
    "[depth_to_color] needs rotation = nine numbers of a rotation matrix, row by row, and translation_mm = three "
    "numbers";
constexpr const char* kBadUnit = "depth.unit_mm must be over 0: the distance of one depth code in mm";
constexpr double kSquareToWithin = 1e-3;  // deviation from an orthonormal matrix

// Reads exactly as many finite numbers as `values` holds.
template <std::size_t N>
bool read(const toml::node_view<const toml::node>& node, std::array<double, N>& values) {
  const toml::array* const list = node.as_array();
  if (list == nullptr || list->size() != N) return false;
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = (*list)[i].value<double>();
    if (!value || !std::isfinite(*value)) return false;
    values[i] = *value;
  }
  return true;
}

// Five coefficients, or eight.
bool readLens(const toml::node_view<const toml::node>& node, Lens::Coefficients& lens) {
  if (!node || read(node, lens)) return true;
  std::array<double, 5> five{};
  if (!read(node, five)) return false;
  std::ranges::copy(five, lens.begin());
  return true;
}

std::optional<RigCamera> readCamera(const toml::node_view<const toml::node>& node) {
  constexpr double kLongestSide = 1 << 16;
  std::array<double, 2> size{}, focal{}, center{};
  RigCamera camera;
  if (!read(node["size"], size) || !read(node["focal"], focal) || !read(node["center"], center)) return std::nullopt;
  if (!readLens(node["distortion"], camera.distortion)) return std::nullopt;
  if (!(size[0] >= 1 && size[1] >= 1 && focal[0] > 0 && focal[1] > 0)) return std::nullopt;
  if (std::max(size[0], size[1]) > kLongestSide) return std::nullopt;
  return RigCamera{size[0], size[1], focal[0], focal[1], center[0], center[1], camera.distortion};
}

}  // namespace

bool isRotation(const std::array<double, 9>& m) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      const double dot = m[3 * i] * m[3 * j] + m[3 * i + 1] * m[3 * j + 1] + m[3 * i + 2] * m[3 * j + 2];
      if (std::abs(dot - (i == j ? 1 : 0)) > kSquareToWithin) return false;
    }
  }
  const double determinant =
      m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
  return determinant > 0;
}

Result<Registration> parseRegistration(std::string_view text) {
  const auto refuse = [](const char* rule) { return fail(ErrorCode::InvalidArgument, rule); };
  if (lineWithTooManyDots(text) > 0) return refuse(kNoToml);
  toml::table table;
  try {
    table = toml::parse(text);
  } catch (const toml::parse_error&) {
    return refuse(kNoToml);
  }
  const toml::table& root = table;
  const auto depth = readCamera(root["depth"]), color = readCamera(root["color"]);
  if (!depth || !color) return refuse(kBadCamera);
  Registration registration{.depth = *depth, .color = *color};
  const auto motion = root["depth_to_color"];
  if (motion["rotation"] && !read(motion["rotation"], registration.rotation)) return refuse(kBadMotion);
  if (motion["translation_mm"] && !read(motion["translation_mm"], registration.translation_mm)) {
    return refuse(kBadMotion);
  }
  if (!isRotation(registration.rotation)) return refuse(kBadMotion);
  if (const auto unit = root["depth"]["unit_mm"]) {
    registration.unit_mm = unit.value<double>().value_or(0);
    if (!(registration.unit_mm > 0) || !std::isfinite(registration.unit_mm)) return refuse(kBadUnit);
  }
  return registration;
}

}  // namespace relievo
