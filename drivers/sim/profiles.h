// SPDX-License-Identifier: Apache-2.0
// Named profiles of simulated devices and hands, and the words of the command line that choose them.
#pragma once

#include <span>
#include <string>

#include "drivers/sim/sim.h"

namespace relievo {

// The workspaces are centred on the default display volume, so that device millimetres are scene millimetres if the
// workspace is not smaller than the picture.
//
// phantom, like the PHANToM Premium 1.5, as its maker published it: apparent mass under 75 g, back-drive friction
//   0.04 N, 860 dpi, 8.5 N peak, 1.4 N continuous, 3.5 N/mm. Viscous damping and one tick of delay are assumed.
// falcon, like the Novint Falcon: step from its geometry (24 to 58 um per count across, 15 to 27 along), 0.8 N/mm from
//   HAPI; peak force, continuous force and workspace as in its driver. Mass, both frictions and two ticks of delay
//   (a USB packet each way) are assumed.
// polhem, like Haptikfabriken's Polhem v2, from the parameters in its library's header: 4096 counts through 28.8:175 at
//   some 165 mm (0.042 mm; 7.7:100 at 165 mm and 10:100 at 131 mm are 0.02 mm), 5 N, 2 N/mm, a workspace of 150 mm
//   around its centre. Mass, both frictions, the continuous force and two ticks of delay are assumed.
struct SimDeviceName {
  const char* word;
  DeviceProfile profile;
};
[[nodiscard]] std::span<const SimDeviceName> simDevices();

// A tense hand has 1.5 N/mm, a third of its critical damping and presses with 4 N, all assumed; a relaxed arm was
// measured at 0.14 N/mm. The other hands have HandProfile's defaults and differ only in their motion.
struct SimHandName {
  const char* word;
  HandProfile hand;
  HandMotion motion;
};
[[nodiscard]] std::span<const SimHandName> simHands();

extern const char* const kSimWords;  // "phantom falcon polhem, stroking resting .."

struct SimSetup {
  DeviceProfile profile;
  HandPath path;
};
// `words`: comma-separated, at most one device, one hand and one hand script, in any order: "", "falcon",
// "polhem,tense", "falcon,hand.csv". With a script, a hand's word sets only its HandProfile. InvalidArgument for a word
// that is neither known nor a file; NotFound for a path that does not exist.
[[nodiscard]] Outcome<SimSetup> parseSim(const std::string& words);
// The path of the hand script in `words`; empty if there is none or a word is wrong.
[[nodiscard]] std::string scriptNamedBy(const std::string& words);

}  // namespace relievo
