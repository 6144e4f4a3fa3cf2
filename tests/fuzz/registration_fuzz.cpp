// SPDX-License-Identifier: Apache-2.0
// Any text as a registration (TOML) and as Azure Kinect's calibration; what is read of it registers a picture.
#include <memory>
#include <string_view>
#include <vector>

#include "app/media/registration/own_registration.h"

namespace {

using namespace relievo;

void registerPicture(const Registration& registration) {
  auto codes = std::make_shared<std::vector<std::uint16_t>>();
  for (int i = 0; i < 12 * 9; ++i) codes->push_back(static_cast<std::uint16_t>(500 * i));
  static_cast<void>(Registrar(registration).registered(grayFrame(std::move(codes), 12, 9)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  if (const auto registration = parseRegistration(text)) registerPicture(*registration);
  if (const auto registration = parseKinectCalibration(text, {320, 288}, {1280, 720})) registerPicture(*registration);
  return 0;
}
