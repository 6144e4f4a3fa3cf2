// SPDX-License-Identifier: Apache-2.0
// A valid archive of two arrays, one stored and one deflated, with bytes changed: each three bytes of the input are a
// position and a value, and 0xffff cuts it off at the position before.
#include <string>

#include "drivers/floats/floats.h"
#include "drivers/npz/npz.h"
#include "tests/fuzz/deflated.h"
#include "tests/fuzz/film_fuzz.h"
#include "tests/support/byte_writer.h"

namespace relievo {
namespace {

using test::ByteWriter;
using test::deflated;
using test::number;

std::string soundArchive() {
  std::string bytes, directory;
  for (const bool packed : {false, true}) {
    const std::string name = packed ? "depth.npy" : "other.npy";
    const std::string head = "{'descr': '<f4', 'fortran_order': False, 'shape': (4, 18, 16), }\n";
    const std::string plain = "\x93NUMPY\1" + std::string(1, '\0') + number(static_cast<std::uint16_t>(head.size())) +
                              head + std::string(std::size_t{4} * 18 * 16 * 4, '?');
    const std::string content = packed ? deflated(plain) : plain;
    ByteWriter common;  // of both headers
    common.add(std::uint16_t{20}).add(std::uint16_t{0}).add(static_cast<std::uint16_t>(packed ? 8 : 0));
    common.add(std::uint64_t{0}).add(static_cast<std::uint32_t>(content.size()));
    common.add(static_cast<std::uint32_t>(plain.size())).add(static_cast<std::uint16_t>(name.size()));
    common.add(std::uint16_t{0});
    const auto begin = static_cast<std::uint32_t>(bytes.size());
    bytes += "PK\3\4" + common.bytes() + name + content;
    directory += "PK\1\2" + number(std::uint16_t{20}) + common.bytes() + std::string(10, '\0') + number(begin) + name;
  }
  const std::string end = "PK\5\6" + std::string(8, '\0') + number(static_cast<std::uint32_t>(directory.size())) +
                          number(static_cast<std::uint32_t>(bytes.size())) + std::string(2, '\0');
  return bytes + directory + end;
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  std::string archive = soundArchive();
  std::size_t place = archive.size();
  for (std::size_t i = 0; i + 2 < size; i += 3) {
    const std::size_t given = bytes[i] | std::size_t{bytes[i + 1]} << 8;
    if (given == 0xffff) archive.resize(std::min(archive.size(), place));
    if (archive.empty()) break;
    place = given % archive.size();
    archive[place] = static_cast<char>(bytes[i + 2]);
  }
  test::playBytes(std::span(reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size()), makeNpzSource,
                  [](const StreamInfo&) { return makePictureFileDecoder(kNpy); });
  return 0;
}
