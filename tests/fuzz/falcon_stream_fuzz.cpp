// SPDX-License-Identifier: Apache-2.0
// The Falcon's protocol: any bytes, split anywhere. Packets that are found are valid, the first valid one after garbage
// is found, and the decoded position is within reach and motor commands within the limit.
#include <cmath>
#include <glm/geometric.hpp>

#include "drivers/falcon/motors.h"
#include "drivers/falcon/packet.h"
#include "tests/fuzz/fuzz_port.h"

namespace relievo::falcon {
namespace {

using test::require;

void checkWords(FuzzedDataProvider& data, const Counts& counts, const glm::dvec3& near, Motors& motors) {
  const auto place = forward(anglesOf(counts), near);
  if (!place) return;
  require(glm::length(*place) < 1000, "the grip is on the table");
  const auto pose = inverse(*place);
  require(pose.has_value(), "a place has angles");
  require(glm::distance(pose->theta_rad, anglesOf(counts)) < 1e-6, "and they are those of the encoders");
  const glm::dvec3 force(data.ConsumeFloatingPointInRange(-20.0, 20.0), data.ConsumeFloatingPointInRange(-20.0, 20.0),
                         data.ConsumeFloatingPointInRange(-20.0, 20.0));
  for (const int word : motors.wordsFor(torquesOf(force, *pose), data.ConsumeFloatingPointInRange(0.0, 30.0))) {
    require(std::abs(word) <= kMostWord, "no word is beyond the limit");
  }
}

void fuzz(FuzzedDataProvider& data) {
  PacketStream stream;
  EncoderGate gate(kMmPerCount, 1000);
  gate.reset({});
  Motors motors(kDefaultCountsPerNm);
  glm::dvec3 near = kCentreMm;
  while (data.remaining_bytes() > 0) {
    const auto chunk = data.ConsumeBytes<std::uint8_t>(data.ConsumeIntegralInRange<std::size_t>(0, 200));
    stream.add(chunk);
    while (const auto packet = stream.next()) {
      if (const auto command = decodeCommand(*packet)) require(encode(*command) == *packet, "a command is its bytes");
      const auto reply = decodeReply(*packet);
      if (!reply) continue;
      require(encode(*reply) == *packet, "a reply is its bytes");
      if (!gate.accept(reply->encoders)) continue;
      checkWords(data, reply->encoders, near, motors);
      near = forward(anglesOf(reply->encoders), near).value_or(near);
    }
  }
  const Packet good = encode(Reply{.encoders = {123, -456, 789}, .buttons = 4, .homed = 7});
  stream.add(good);
  std::optional<Packet> last;
  while (const auto packet = stream.next()) last = packet;
  require(last == good, "a good packet is found after any garbage");
  gate.accept({123, -456, 789});
  require(gate.accept({123, -456, 789}), "what stays where it is is believed the second time");
}

}  // namespace
}  // namespace relievo::falcon

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  relievo::falcon::fuzz(data);
  return 0;
}
