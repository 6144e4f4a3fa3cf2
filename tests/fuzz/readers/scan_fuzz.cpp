// SPDX-License-Identifier: Apache-2.0
// A valid scan with bytes changed: the first byte of the input chooses .sens or .klg, then each three bytes are a
// position and a value, and 0xffff cuts it off at the position before.

#include "drivers/scan/scan.h"
#include "tests/fuzz/film_fuzz.h"
#include "tests/support/byte_writer.h"

namespace relievo {
namespace {

using test::number;

constexpr int kCols = 8, kRows = 6, kFrames = 3;

std::string soundSens() {
  std::string bytes = number(std::uint32_t{4}) + number(std::uint64_t{3}) + "cam" + std::string(256, '\0');
  bytes += number(std::int32_t{0}) + number(std::int32_t{0});  // both raw
  for (const int size : {kCols, kRows, kCols, kRows}) bytes += number(static_cast<std::uint32_t>(size));
  bytes += number(1000.0F) + number(std::uint64_t{kFrames});
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    const std::string color(kCols * kRows * 3, '\5'), depth(kCols * kRows * 2, '\7');
    bytes += std::string(64, '\0') + number(i * 33'000) + number(i * 33'000) + number(std::uint64_t{color.size()}) +
             number(std::uint64_t{depth.size()}) + color + depth;
  }
  return bytes;
}

std::string soundKlg() {
  std::string bytes = number(std::int32_t{kFrames});
  for (std::int64_t i = 0; i < kFrames; ++i) {
    const std::string depth("\x78\x01\x63\x60\x00\x00\x00\x02\x00\x01", 10);  // two zeros, deflated
    bytes += number(i * 33'000) + number(static_cast<std::uint32_t>(depth.size())) + number(std::uint32_t{0}) + depth;
  }
  return bytes;
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  if (size == 0) return 0;
  const bool klg = bytes[0] % 2 == 1;
  std::string scan = klg ? soundKlg() : soundSens();
  std::size_t place = scan.size();
  for (std::size_t i = 1; i + 2 < size; i += 3) {
    const std::size_t given = bytes[i] | std::size_t{bytes[i + 1]} << 8;
    if (given == 0xffff) scan.resize(std::min(scan.size(), place));
    if (scan.empty()) break;
    place = given % scan.size();
    scan[place] = static_cast<char>(bytes[i + 2]);
  }
  test::playBytes(std::span(reinterpret_cast<const std::uint8_t*>(scan.data()), scan.size()), makeScanSource);
  return 0;
}
