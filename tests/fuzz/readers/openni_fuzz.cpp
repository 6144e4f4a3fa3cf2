// SPDX-License-Identifier: Apache-2.0
// A valid recording of OpenNI with bytes changed: the first byte of the input chooses the recording, then each three
// bytes are a position and a value, and 0xffff cuts it off at the position before.
#include <array>

#include "drivers/openni/openni.h"
#include "tests/fuzz/film_fuzz.h"
#include "tests/support/film/recording/oni_writer.h"

namespace relievo {
namespace {

std::string soundRecording(const std::string& codec, bool wide, bool tables) {
  constexpr std::uint32_t kCols = 8, kRows = 6;
  test::OniWriter oni(wide);
  const auto color =
      oni.add({.kind = test::kOniColor, .codec = "NONE", .cols = kCols, .rows = kRows, .format = test::kOniRgb});
  const auto depth = oni.add({.codec = codec, .cols = kCols, .rows = kRows});
  std::array<std::uint16_t, kCols * kRows> samples{};
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = static_cast<std::uint16_t>(900 + i * (i % 5));
  for (std::uint64_t i = 0; i < 4; ++i) {
    oni.write(color, i * 33'000, std::string(samples.size() * 3, '\5'));
    oni.write(depth, i * 33'000, codec == "16zT" ? test::oni16zTable(samples) : test::oni16z(samples));
  }
  return oni.finish(tables);
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  static const std::array<std::string, 4> kRecordings{
      soundRecording("16zT", true, true), soundRecording("16zP", true, true), soundRecording("16zT", true, false),
      soundRecording("16zP", false, false)};
  if (size == 0) return 0;
  std::string oni = kRecordings[bytes[0] % kRecordings.size()];
  std::size_t place = oni.size();
  for (std::size_t i = 1; i + 2 < size; i += 3) {
    const std::size_t given = bytes[i] | std::size_t{bytes[i + 1]} << 8;
    if (given == 0xffff) oni.resize(std::min(oni.size(), place));
    if (oni.empty()) break;
    place = given % oni.size();
    oni[place] = static_cast<char>(bytes[i + 2]);
  }
  test::playBytes(std::span(reinterpret_cast<const std::uint8_t*>(oni.data()), oni.size()), makeOpenniSource);
  return 0;
}
