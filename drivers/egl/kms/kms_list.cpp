// SPDX-License-Identifier: Apache-2.0
// Describes the screens that are connected to this machine's display cards.
#include <cstdio>

#include "drivers/egl/egl.h"
#include "drivers/egl/kms/kms_mode.h"
#include "drivers/egl/kms/kms_screen.h"

namespace relievo {
namespace {

std::string wordsOf(const kms::Connector& connector) {
  const drmModeModeInfo* mode = kms::chooseMode(connector.modes, {.width = 0, .height = 0});
  if (mode == nullptr) return connector.name + ": only interlaced modes, which are not supported";
  char text[80];
  std::snprintf(text, sizeof text, "%dx%d at %.2f Hz, %zu modes; ", mode->hdisplay, mode->vdisplay,
                1 / toSeconds(kms::refreshPeriod(*mode)), connector.modes.size());
  return connector.name + ": " + text + kms::wordsOf(kms::stereoSignals(connector.modes));
}

}  // namespace

std::vector<KmsScreen> lookAtKmsScreens() {
  std::vector<KmsScreen> screens;
  for (const std::string& path : kms::cardPaths()) {
    const auto card = kms::openCard(path);
    if (!card) {
      screens.push_back({path, false, card.error().message});
      continue;
    }
    for (const kms::Connector& connector : kms::readConnectors(card->get(), true)) {
      if (!connector.connected) {
        screens.push_back({path, false, connector.name + ": no screen is connected, or it is off"});
      } else if (const auto taken = kms::Screen::take(card->get(), connector.id); !taken) {
        screens.push_back({path, false, connector.name + ": " + taken.error().message});
      } else {
        screens.push_back({path, true, wordsOf(connector)});
      }
    }
  }
  if (screens.empty())
    screens.push_back({"", false, "this machine has no display card (/dev/dri/card*); use another --display"});
  return screens;
}

}  // namespace relievo
