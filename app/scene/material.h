// SPDX-License-Identifier: Apache-2.0
// A film's material: stiffness, friction and texture of its surface.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace relievo {

// Coulomb friction between the proxy and the surface, as coefficients of friction; 0: none.
struct Friction {
  double static_coefficient = 0, dynamic_coefficient = 0;  // dynamic <= static
  bool operator==(const Friction&) const = default;
};

// Ripples of the surface, along x and along y; amplitude 0: none.
struct Texture {
  double amplitude_mm = 0, wavelength_mm = 1;
  bool operator==(const Texture&) const = default;
};

// The material of a whole film. Parts that are not stated are the player's choice: its usual stiffness, and neither
// friction nor texture.
struct Material {
  std::optional<double> stiffness_n_per_mm;
  std::optional<Friction> friction;
  std::optional<Texture> texture;

  [[nodiscard]] bool empty() const noexcept { return !stiffness_n_per_mm && !friction && !texture; }
  bool operator==(const Material&) const = default;
};

// The tag of a film's depth track that holds a material, in the words of `parseMaterial`.
inline constexpr const char* kMaterialTag = "DEPTH_MATERIAL";

// The tag of a material track that holds the values of its full codes, in the same words. The track does not contain a
// part that the tag leaves out.
inline constexpr const char* kMaterialScaleTag = "MATERIAL_SCALE";
// The player's stiffness, on a device that can hold it; also that of unpainted places of an author's map.
inline constexpr double kUsualStiffnessNPerMm = 0.5;

// Parses "stiffness=.3,friction=.2/.15,texture=.1@.8": N/mm from .01 to 100; static/dynamic coefficients up to 2, the
// second at most the first, which also stands for both; amplitude up to 2 mm, at a wavelength from .1 to 100 mm, or 0.
// InvalidArgument with a message that says what is wrong.
[[nodiscard]] Result<Material> parseMaterial(std::string_view text);
// Reads a film's tags; returns an empty material without kMaterialTag, and InvalidArgument if its value is none.
[[nodiscard]] Result<Material> materialFromTags(const std::map<std::string, std::string>& tags);
// In the form that `parseMaterial` reads; "" for an empty one.
[[nodiscard]] std::string materialText(const Material& material);
// `above`, with the parts that it leaves out taken from `below`.
[[nodiscard]] Material layered(const Material& above, const Material& below) noexcept;

// What a device can hold: its own stable stiffness and largest force, N/mm and N, at the handle.
struct HeldMaterial {
  double stiffness_n_per_mm = 0;
  Friction friction;
  Texture texture;
  std::string reduced;  // the parts that exceed the device, in one line; "" if nothing was reduced
};
// `usual_n_per_mm` is used for a film without a stiffness of its own. A texture also acts as a stiffness: over a ripple
// its force changes by stiffness x slope. That is kept below the device's stiffness, and its amplitude below a quarter
// of the force.
[[nodiscard]] HeldMaterial heldBy(const Material& material, double usual_n_per_mm, double most_n_per_mm, double most_n);

// What a device can hold of a material track: the values that full codes stand for, and the bounds at each place.
struct HeldScale {
  std::optional<double> stiffness_n_per_mm;
  std::optional<Friction> friction;
  std::optional<Texture> texture;
  double most_n_per_mm = 0;  // of the stiffness
  double most_ripple_n = 0;  // of stiffness x amplitude

  [[nodiscard]] bool exists() const noexcept { return stiffness_n_per_mm || friction || texture; }
};
// `whole`: the whole film's material, for the parts that the track leaves out.
[[nodiscard]] HeldScale scaleHeldBy(const Material& full, const Material& whole, double most_n_per_mm, double most_n);
// The parts of a track that exceed such a device, in one line; "" if there are none.
[[nodiscard]] std::string reducedScale(const Material& full, double most_n_per_mm);
// `full`, without the parts that `above` states: these no longer come from the track.
[[nodiscard]] Material withoutThoseOf(const Material& above, const Material& full) noexcept;

}  // namespace relievo
