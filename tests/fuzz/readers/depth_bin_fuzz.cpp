// SPDX-License-Identifier: Apache-2.0
// A valid depth.bin with bytes changed: the first byte of the input chooses one of its three codings, then each three
// bytes are a position and a value, and 0xffff cuts the file off at the position before.
#include <lz4.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <string>
#include <vector>

#include "drivers/scan/depth_bin.h"
#include "platform/unique_fd.h"
#include "tests/fuzz/deflated.h"

namespace relievo {
namespace {

using test::deflated;

constexpr std::size_t kSamples = 256 * 192;

std::string withLength(const std::string& packed) {
  std::array<char, 4> length{};
  for (std::size_t i = 0; i < length.size(); ++i) length[i] = static_cast<char>(packed.size() >> (8 * i));
  return std::string(length.data(), length.size()) + packed;
}

// A slope, so that repetitions are at several distances; small enough for a position of two bytes.
std::string samples(std::size_t bytes_each) {
  std::string bytes(bytes_each * kSamples, '\0');
  for (std::size_t i = 0; i < kSamples; ++i) bytes[bytes_each * i + bytes_each - 2] = static_cast<char>(i / 256);
  return bytes;
}

std::string lz4(const std::string& bytes) {
  std::string packed(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))), '\0');
  packed.resize(static_cast<std::size_t>(LZ4_compress_default(
      bytes.data(), packed.data(), static_cast<int>(bytes.size()), static_cast<int>(packed.size()))));
  return packed;
}

// Opened, read from its second picture, then whole; not as a film, of whose pictures of this size few a second are read
// under sanitizers.
void read(const std::string& bin) {
  const UniqueFd memory(::memfd_create("depth.bin", MFD_CLOEXEC));
  if (::write(memory.get(), bin.data(), bin.size()) != static_cast<ssize_t>(bin.size())) return;
  auto file = AnsweredFile::open("/proc/self/fd/" + std::to_string(memory.get()));
  const std::atomic<bool> cancelled{false};
  auto opened =
      file ? scan::DepthBin::open(std::move(*file), cancelled) : Result<scan::DepthBin>(std::unexpected(file.error()));
  if (!opened) return;
  std::vector<std::uint8_t> mm;
  for (const std::size_t from : {1u, 0u}) {
    static_cast<void>(opened->goTo(from, cancelled));
    while (opened->next(mm) == scan::DepthBin::Read::Picture) {
    }
  }
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace relievo;
  static const std::string kByLz4 = withLength(lz4(samples(2))), kByDeflate = withLength(deflated(samples(4)));
  static const std::array<std::string, 3> kBins{kByLz4 + kByLz4 + kByLz4, kByDeflate + kByDeflate + kByDeflate,
                                                deflated(samples(4) + samples(4) + samples(4))};
  if (size == 0) return 0;
  std::string bin = kBins[bytes[0] % kBins.size()];
  std::size_t place = bin.size();
  for (std::size_t i = 1; i + 2 < size; i += 3) {
    const std::size_t given = bytes[i] | std::size_t{bytes[i + 1]} << 8;
    if (given == 0xffff) bin.resize(std::min(bin.size(), place));
    if (bin.empty()) break;
    place = given % bin.size();
    bin[place] = static_cast<char>(bytes[i + 2]);
  }
  read(bin);
  return 0;
}
