// SPDX-License-Identifier: Apache-2.0
// Loading the Falcon's firmware with a boot loader that answers anything: it terminates, and if it reports success
// every byte of the image was sent in order.
#include <algorithm>

#include "drivers/falcon/link.h"
#include "tests/fuzz/fuzz_port.h"

namespace relievo::falcon {
namespace {

using test::FuzzPort;
using test::require;

// The bridge's two bytes, then a correct loader's answer: a welcome to the greeting, else an echo.
std::optional<UsbPacket> loader(UsbBytes sent) {
  constexpr std::array<std::uint8_t, 3> kHello{0x0A, 0x43, 0x0D};
  constexpr std::array<std::uint8_t, 4> kWelcome{0x0A, 0x44, 0x2C, 0x0D};
  const UsbBytes answer = std::ranges::equal(sent, kHello) ? UsbBytes(kWelcome) : sent;
  UsbPacket packet;
  packet.data = {0x01, 0x60};
  packet.bytes = kStatusBytes + std::min(answer.size(), kMostPayload);
  std::copy_n(answer.begin(), packet.bytes - kStatusBytes, packet.data.begin() + kStatusBytes);
  return packet;
}

void fuzz(FuzzedDataProvider& data) {
  ManualClock clock;
  const auto image = data.ConsumeBytes<std::uint8_t>(data.ConsumeIntegralInRange<std::size_t>(0, 200));
  std::atomic<bool> cancelled{false};
  std::vector<std::uint8_t> sent;
  FuzzPort port(data, clock, loader);
  port.on_sent = [&sent](UsbBytes bytes) { sent.insert(sent.end(), bytes.begin(), bytes.end()); };
  port.on_many_verbs = [&cancelled] { cancelled = true; };
  const Patience patience{clock, cancelled};
  const auto answers = firmwareAnswers(port, patience);
  sent.clear();
  const auto loaded = loadFirmware(port, image, patience);
  require(!answers || !*answers || loaded || loaded.error().message != nullptr, "a failure says what it is");
  if (!loaded) return;
  require(sent.size() >= image.size() && std::ranges::equal(UsbBytes(sent).last(image.size()), image),
          "an image that is loaded went out whole");
}

}  // namespace
}  // namespace relievo::falcon

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  relievo::falcon::fuzz(data);
  return 0;
}
