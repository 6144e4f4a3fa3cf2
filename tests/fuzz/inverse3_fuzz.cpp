// SPDX-License-Identifier: Apache-2.0
// The Inverse3's service: any bytes instead of its frames, in pieces of any size, and any text instead of its JSON.
// Messages lie within their frames, a position is within reach, and the force that is sent is JSON of its own.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "drivers/inverse3/force_message.h"
#include "drivers/inverse3/frames.h"
#include "drivers/inverse3/handshake.h"
#include "drivers/inverse3/motion_gate.h"
#include "drivers/inverse3/snapshot.h"

namespace relievo::inverse3 {
namespace {

void require(bool good) {
  if (!good) std::abort();
}

void read(std::string_view text, MotionGate& gate, MonotonicTime now) {
  const auto snapshot = readSnapshot(text, {});
  if (!snapshot) return;
  require(snapshot->buttons < 8);
  if (!snapshot->position_m) return;
  for (int axis = 0; axis < 3; ++axis) require(std::abs((*snapshot->position_m)[axis]) <= 1);
  static_cast<void>(gate.accept(1e3 * *snapshot->position_m, now, Duration(0)));
  const auto again = readSnapshot(text, snapshot->id.text());
  require(again && (snapshot->id.text().empty() || again->position_m == snapshot->position_m));
  ForceMessage message;
  message.setDevice(snapshot->id.text(), snapshot->from_3_5);
  const PortBytes bytes = message.with(1e3 * *snapshot->position_m);
  require(readSnapshot({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}).has_value());
}

void fuzz(FuzzedDataProvider& data) {
  MotionGate gate;
  gate.forget();
  MonotonicTime now{};
  if (data.ConsumeBool()) return read(data.ConsumeRemainingBytesAsString(), gate, now);
  if (data.ConsumeBool()) return static_cast<void>(acceptsUpgrade(data.ConsumeRemainingBytesAsString(), Nonce{}));
  const auto reader = std::make_unique<FrameReader>();
  while (data.remaining_bytes() > 0) {
    const std::string piece = data.ConsumeRandomLengthString(300);
    const auto room = reader->room();
    require(room.size() >= piece.size());
    std::ranges::copy(piece, room.begin());
    reader->received(piece.size());
    now += std::chrono::milliseconds(1);
    while (const auto message = reader->next()) {
      require(message->payload.size() <= FrameReader::kMostMessage && message->kind != Opcode::Continuation);
      read(message->payload, gate, now);
    }
  }
}

}  // namespace
}  // namespace relievo::inverse3

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  relievo::inverse3::fuzz(data);
  return 0;
}
