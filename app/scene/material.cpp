// SPDX-License-Identifier: Apache-2.0
// Parses and prints materials, and bounds them by a device.
#include "app/scene/material.h"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "platform/text/number_in.h"

namespace relievo {
namespace {

constexpr double kLeastStiffness = 0.01, kMostStiffness = 100, kMostFriction = 2;
constexpr double kMostAmplitudeMm = 2, kLeastWavelengthMm = 0.1, kMostWavelengthMm = 100;

constexpr const char* kForm =
    "no part of a material; it is written stiffness=N/MM,friction=STATIC/DYNAMIC,texture=MM@MM";
constexpr const char* kBadStiffness = "stiffness is a number from .01 to 100, in N/mm, such as stiffness=.3";
constexpr const char* kBadFriction =
    "friction is one or two shares from 0 to 2, static/dynamic, the second at most the first, such as friction=.2/.15";
constexpr const char* kBadTexture =
    "texture is AMPLITUDE@WAVELENGTH in mm, amplitude up to 2, wavelength from .1 to 100, such as texture=.1@.8; or 0";

// The number that is the whole text, if it lies in the range.
std::optional<double> number(std::string_view text, double low, double high) {
  const auto value = numberIn<double>(text);
  return value && *value >= low && *value <= high ? value : std::nullopt;
}

std::optional<Friction> parseFriction(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto still = number(text.substr(0, slash), 0, kMostFriction);
  if (!still) return std::nullopt;
  const auto moving = slash == std::string_view::npos ? still : number(text.substr(slash + 1), 0, *still);
  return moving ? std::optional(Friction{*still, *moving}) : std::nullopt;
}

std::optional<Texture> parseTexture(std::string_view text) {
  const std::size_t at = text.find('@');
  const auto amplitude = number(text.substr(0, at), 0, kMostAmplitudeMm);
  if (!amplitude) return std::nullopt;
  if (at == std::string_view::npos) return *amplitude == 0 ? std::optional(Texture{}) : std::nullopt;
  const auto wavelength = number(text.substr(at + 1), kLeastWavelengthMm, kMostWavelengthMm);
  if (!wavelength) return std::nullopt;
  return *amplitude == 0 ? Texture{} : Texture{*amplitude, *wavelength};
}

// Sets the value of "key=value"; returns what is wrong with it, or null.
const char* take(std::string_view item, Material& material) {
  const std::size_t equals = item.find('=');
  if (equals == std::string_view::npos) return kForm;
  const std::string_view key = item.substr(0, equals), value = item.substr(equals + 1);
  if (key == "stiffness") {
    material.stiffness_n_per_mm = number(value, kLeastStiffness, kMostStiffness);
    return material.stiffness_n_per_mm ? nullptr : kBadStiffness;
  }
  if (key == "friction") {
    material.friction = parseFriction(value);
    return material.friction ? nullptr : kBadFriction;
  }
  if (key != "texture") return kForm;
  material.texture = parseTexture(value);
  return material.texture ? nullptr : kBadTexture;
}

// The shortest that reads back as the same number.
std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string rounded(double value) {
  char text[32];
  return {text, static_cast<std::size_t>(std::snprintf(text, sizeof text, "%.3g", value))};
}

void add(std::string& list, const std::string& item) {
  list += (list.empty() ? "" : ",") + item;
}

// Stiffness x amplitude.
double mostRippleN(const Texture& texture, double most_n_per_mm, double most_n) {
  return std::min(most_n_per_mm * texture.wavelength_mm / (2 * std::numbers::pi), 0.25 * most_n);
}

}  // namespace

Result<Material> parseMaterial(std::string_view text) {
  Material material;
  while (!text.empty()) {
    const std::size_t end = text.find(',');
    const std::string_view item = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (const char* wrong = take(item, material); wrong != nullptr) return fail(ErrorCode::InvalidArgument, wrong);
  }
  if (material.empty()) return fail(ErrorCode::InvalidArgument, kForm);
  return material;
}

Result<Material> materialFromTags(const std::map<std::string, std::string>& tags) {
  const auto found = tags.find(kMaterialTag);
  return found == tags.end() ? Material{} : parseMaterial(found->second);
}

std::string materialText(const Material& material) {
  std::string text;
  if (material.stiffness_n_per_mm) add(text, "stiffness=" + shortest(*material.stiffness_n_per_mm));
  if (const auto& friction = material.friction) {
    add(text, "friction=" + shortest(friction->static_coefficient) + "/" + shortest(friction->dynamic_coefficient));
  }
  if (const auto& texture = material.texture) {
    const bool none = texture->amplitude_mm == 0;
    add(text,
        none ? "texture=0" : "texture=" + shortest(texture->amplitude_mm) + "@" + shortest(texture->wavelength_mm));
  }
  return text;
}

Material layered(const Material& above, const Material& below) noexcept {
  return {.stiffness_n_per_mm = above.stiffness_n_per_mm ? above.stiffness_n_per_mm : below.stiffness_n_per_mm,
          .friction = above.friction ? above.friction : below.friction,
          .texture = above.texture ? above.texture : below.texture};
}

HeldMaterial heldBy(const Material& material, double usual_n_per_mm, double most_n_per_mm, double most_n) {
  HeldMaterial held{.friction = material.friction.value_or(Friction{}),
                    .texture = material.texture.value_or(Texture{}),
                    .reduced = {}};
  const double stiffness = material.stiffness_n_per_mm.value_or(usual_n_per_mm);
  held.stiffness_n_per_mm = std::min(stiffness, most_n_per_mm);
  if (material.stiffness_n_per_mm && held.stiffness_n_per_mm < stiffness) {
    held.reduced = "stiffness " + rounded(stiffness) + " N/mm is felt as " + rounded(held.stiffness_n_per_mm);
  }
  double& amplitude = held.texture.amplitude_mm;
  const double most = mostRippleN(held.texture, most_n_per_mm, most_n) / held.stiffness_n_per_mm;
  if (amplitude > most) {
    held.reduced +=
        (held.reduced.empty() ? "" : "; ") + ("texture of " + rounded(amplitude) + " mm is felt as ") + rounded(most);
    amplitude = most;
  }
  return held;
}

HeldScale scaleHeldBy(const Material& full, const Material& whole, double most_n_per_mm, double most_n) {
  const Texture texture = layered(full, whole).texture.value_or(Texture{});
  return {.stiffness_n_per_mm = full.stiffness_n_per_mm,
          .friction = full.friction,
          .texture = full.texture,
          .most_n_per_mm = most_n_per_mm,
          .most_ripple_n = mostRippleN(texture, most_n_per_mm, most_n)};
}

std::string reducedScale(const Material& full, double most_n_per_mm) {
  if (full.stiffness_n_per_mm.value_or(0) <= most_n_per_mm) return {};
  return "places stiffer than " + rounded(most_n_per_mm) + " N/mm are felt at that stiffness";
}

Material withoutThoseOf(const Material& above, const Material& full) noexcept {
  return {.stiffness_n_per_mm = above.stiffness_n_per_mm ? std::nullopt : full.stiffness_n_per_mm,
          .friction = above.friction ? std::nullopt : full.friction,
          .texture = above.texture ? std::nullopt : full.texture};
}

}  // namespace relievo
