// SPDX-License-Identifier: Apache-2.0
// Kinds of recordings: what each stores, in words for the user and as settings.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "app/media/reading/packing.h"
#include "app/scene/depth_calibration.h"

namespace relievo {

// Codes of 12 bits for the distances from `nearest_mm`, code 0, to `farthest_mm`, code 4095: in equal steps of the
// logarithm of the distance plus `shift_mm`, or of the distance itself. Code 0 is a hole.
struct EvenSteps {
  static constexpr int kBits = 12;
  float nearest_mm = 10, farthest_mm = 10000, shift_mm = 3500;  // LeRobot's default
  bool logarithmic = true;

  // What a code is worth after `inOrder`.
  [[nodiscard]] double unitMm() const noexcept;
};

// How a recording stores the bits of its 16-bit codes.
class SampleOrder {
 public:
  enum Way : std::uint8_t {
    AsStored,
    RotatedLeft3,  // SUN RGB-D: the upper three bits are the lowest
    Swapped,       // big and little endian are confused
    RedGreen,      // of RGB in 8 bits: red is the upper byte, green the lower one
    GreenRed,      // likewise, the other way round
    GreenBlue,     // likewise, green is the upper byte and blue the lower one
    BlueGreen,     // of 24-bit codes in red, green and blue, the lowest first: the upper two bytes
    Below20,       // likewise, of codes of 20 bits: the upper 16
    EqualColors,   // of RGB of more than 8 bits: each component is the code
    Terrarium,     // of RGB in 8 bits: a height of R 256 + G + B / 256 - 32768 m
    Mapbox,        // likewise, of (R 65536 + G 256 + B) / 10 - 10000 m
    FloatBytes,    // of RGBA in 8 bits: a float in metres, its bytes in blue, green, red and alpha; 250 codes a metre
    HalfFloat,     // a half float in metres in 16 bits; 250 codes a metre
    AlongRay,      // a distance from the camera's centre in 16 bits, not from its plane: of InteriorNet's camera
    AlongWideRay,  // likewise, of SceneNet RGB-D's
    Low13,         // Android's DEPTH16: three bits of confidence above
    Upper13,       // Kinect SDK 1: three bits of a player's number below
    Steps          // EvenSteps
  };
  constexpr SampleOrder(Way way) noexcept : way_(way) {}  // NOLINT(*-explicit-*): all but one say nothing else
  constexpr explicit SampleOrder(const EvenSteps& steps) noexcept : way_(Steps), steps_(steps) {}

  constexpr friend bool operator==(const SampleOrder& order, Way way) noexcept { return order.way_ == way; }
  [[nodiscard]] constexpr const EvenSteps& steps() const noexcept { return steps_; }

 private:
  Way way_;
  EvenSteps steps_;
};

// Codes that are inversely proportional to the distance: mm / (offset - code) for a positive offset, else mm / code.
struct InverseCodes {
  double mm = 0;  // 0: the codes are not inverse
  double offset = 0;
};

// Heights of terrain, in codes of .3125 m from 11000 m below the sea on; 0 is a hole.
constexpr bool isTerrain(const SampleOrder& order) noexcept {
  return order == SampleOrder::Terrarium || order == SampleOrder::Mapbox;
}

struct KnownKind {
  const char* name;  // of --as
  const char* what;  // for a user: "distances in mm"
  const char* help;  // where such recordings come from
  const char* calibration;
  Packing packing = Packing::Auto;
  std::optional<DepthCode> code = std::nullopt;
  SampleOrder order = SampleOrder::AsStored;
  InverseCodes inverse = {};
};

// Null for an unknown name.
[[nodiscard]] const KnownKind* findKind(std::string_view name) noexcept;
[[nodiscard]] CalibrationSettings settingsOf(const KnownKind& kind);

// One line for each kind: its name, what its codes are, where it comes from.
[[nodiscard]] std::string kindsText();

}  // namespace relievo
