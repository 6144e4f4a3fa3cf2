// SPDX-License-Identifier: Apache-2.0
// The udev rules give access to every device that a driver looks for, and to nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "drivers/falcon/link.h"
#include "drivers/polhem/report.h"

namespace relievo {
namespace {

std::vector<std::string> rules() {
  std::ifstream file(RELIEVO_SOURCE_DIR "/toolchain/udev/70-relievo.rules");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.front() != '#') lines.push_back(line);
  }
  return lines;
}

std::string matchOf(const UsbDeviceId& id) {
  char text[80];
  std::snprintf(text, sizeof text, "ATTR{idVendor}==\"%04x\", ATTR{idProduct}==\"%04x\"", unsigned{id.vendor},
                unsigned{id.product});
  return text;
}

TEST(UdevRules, ThereIsOneForEveryDevice) {
  using testing::HasSubstr;
  EXPECT_THAT(rules(),
              testing::UnorderedElementsAre(HasSubstr(matchOf(falcon::kUsbId)), HasSubstr(matchOf(polhem::kMbedId)),
                                            HasSubstr(matchOf(polhem::kTeensyId))));
}

TEST(UdevRules, EachGivesTheSeatAndTheGroupTheRight) {
  for (const std::string& rule : rules()) {
    EXPECT_THAT(rule, testing::HasSubstr("TAG+=\"uaccess\""));
    EXPECT_THAT(rule, testing::HasSubstr("GROUP=\"plugdev\""));
    EXPECT_THAT(rule, testing::HasSubstr("MODE=\"0660\""));
    EXPECT_THAT(rule, testing::StartsWith("SUBSYSTEM==\"usb\", ENV{DEVTYPE}==\"usb_device\", "));
  }
}

}  // namespace
}  // namespace relievo
