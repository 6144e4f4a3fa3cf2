// SPDX-License-Identifier: Apache-2.0
// The parameters of devices and hands, and the parser of the words that choose them.
#include "drivers/sim/profiles.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "platform/files/answered_place.h"

namespace relievo {

#define RELIEVO_SIM_WORDS "phantom falcon polhem, stroking resting tapping tense shaking"
const char* const kSimWords = RELIEVO_SIM_WORDS;

namespace {

constexpr const char* kUnknown =
    "is neither a file nor a simulated device or hand; use " RELIEVO_SIM_WORDS " or a hand script";

const std::array kHands = {
    SimHandName{"stroking", {}, HandMotion::Stroking},
    SimHandName{"resting", {}, HandMotion::Resting},
    SimHandName{"tapping", {}, HandMotion::Tapping},
    SimHandName{"tense", {.stiffness_n_per_mm = 1.5, .damping_n_s_per_mm = 0.011}, HandMotion::Pressing},
    SimHandName{"shaking", {}, HandMotion::Shaking},
};

template <class Named>
const Named* find(std::span<const Named> all, const std::string& word) {
  const auto found = std::ranges::find_if(all, [&](const Named& named) { return word == named.word; });
  return found == all.end() ? nullptr : &*found;
}

// A word with a dot or a slash is a path, not a mistyped name.
bool looksLikePath(const std::string& word) {
  return word.find_first_of("./") != std::string::npos;
}

// A full stroke goes 55 mm to either side; scale it so that it stays within the workspace.
double reachOf(const DeviceProfile& profile) {
  const double half_width_mm = (profile.workspace_max_mm.x - profile.workspace_min_mm.x) / 2;
  return std::min(1.0, 0.84 * half_width_mm / 55.0);
}

std::vector<std::string> partsOf(const std::string& words) {
  if (isRegularFile(words)) return {words};  // its name may have a comma
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t comma = std::min(words.find(',', at), words.size());
    parts.push_back(words.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

std::unexpected<Failure> wrongWord(const std::string& word, const char* what) {
  return failOn("--haptic sim, \"" + word + "\"", {ErrorCode::InvalidArgument, 0, what});
}

struct SimWords {
  const SimDeviceName* device = nullptr;
  const SimHandName* hand = nullptr;
  std::string script;  // its path
};

Outcome<SimWords> readWords(const std::string& words) {
  SimWords read;
  for (const std::string& word : words.empty() ? std::vector<std::string>{} : partsOf(words)) {
    if (const auto* named = find(simDevices(), word)) {
      if (read.device != nullptr) return wrongWord(word, "is a second device; name one");
      read.device = named;
    } else if (const auto* held = find(simHands(), word)) {
      if (read.hand != nullptr) return wrongWord(word, "is a second hand; name one");
      read.hand = held;
    } else if (isRegularFile(word) || looksLikePath(word)) {
      if (!read.script.empty()) return wrongWord(word, "is a second hand script; name one");
      read.script = word;
    } else {
      return wrongWord(word, kUnknown);
    }
  }
  return read;
}

}  // namespace

std::span<const SimDeviceName> simDevices() {
  static const std::array devices = {
      SimDeviceName{"phantom", {}},
      SimDeviceName{"falcon",
                    {.name = "sim falcon",
                     .moving_mass_kg = 0.15,
                     .damping_n_s_per_mm = 0.002,
                     .coulomb_friction_n = 0.2,
                     .encoder_step_mm = 0.04,
                     .peak_force_n = 8.0,
                     .continuous_force_n = 2.7,
                     .most_stiffness_n_per_mm = 0.8,
                     .workspace_min_mm = {-50, -50, -30},
                     .workspace_max_mm = {50, 50, 70},
                     .most_rate_hz = 1000,
                     .delay_ticks = 2}},
      SimDeviceName{"polhem",
                    {.name = "sim polhem",
                     .moving_mass_kg = 0.1,
                     .damping_n_s_per_mm = 0.002,
                     .coulomb_friction_n = 0.1,
                     .encoder_step_mm = 0.04,
                     .peak_force_n = 5.0,
                     .continuous_force_n = 2.0,
                     .most_stiffness_n_per_mm = 2.0,
                     .most_rate_hz = 1000,
                     .delay_ticks = 2}},
  };
  return devices;
}

std::span<const SimHandName> simHands() {
  return kHands;
}

Outcome<SimSetup> parseSim(const std::string& words) {
  const auto read = readWords(words);
  if (!read) return std::unexpected(read.error());
  SimSetup setup;
  if (read->device != nullptr) setup.profile = read->device->profile;
  if (read->hand != nullptr) setup.profile.hand = read->hand->hand;
  if (read->script.empty()) {
    const HandMotion motion = read->hand != nullptr ? read->hand->motion : HandMotion::Stroking;
    setup.path = HandPath(motion, reachOf(setup.profile));
    return setup;
  }
  auto loaded = HandPath::load(read->script);
  if (!loaded) return std::unexpected(loaded.error());
  setup.path = std::move(*loaded);
  return setup;
}

std::string scriptNamedBy(const std::string& words) {
  const auto read = readWords(words);
  return read ? read->script : std::string();
}

}  // namespace relievo
