// SPDX-License-Identifier: Apache-2.0
// A media source of one array of numbers in NumPy's format, wherever it lies.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/floats/counted_source.h"
#include "drivers/floats/npy_header.h"

namespace relievo {

// Reads one picture at a time; its packets are npy files of one picture each. A derived class says where the array is;
// its destructor calls close().
class ArraySource : public CountedSource {
 protected:
  // Finds the array in `file_`. `tags`: to be filled with what its surroundings say of the stream.
  [[nodiscard]] virtual Result<void> findArray(const std::string& url, std::map<std::string, std::string>& tags) = 0;
  // Fills `out` from the array's byte `at` on, the header's first one being 0; returns how many bytes there were.
  [[nodiscard]] virtual std::size_t readArray(std::uint64_t at, std::span<std::uint8_t> out) = 0;

  [[nodiscard]] std::vector<std::uint8_t> beginning();
  void closeSource() noexcept override;

 private:
  Result<Description> describe(const std::string& url) override;
  Result<std::optional<Packet>> readPacket() override;
  [[nodiscard]] Duration missingTime() const noexcept override { return static_cast<std::int64_t>(cut_off_) * kPeriod; }

  npy::Header header_;
  std::uint64_t cut_off_ = 0;  // pictures that the file's end has cut off
};

}  // namespace relievo
