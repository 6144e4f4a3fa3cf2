// SPDX-License-Identifier: Apache-2.0
// Recordings of OpenNI (.oni), byte by byte, for tests. OpenNI 2.2's own library reads them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/byte_writer.h"

namespace relievo::test {

inline constexpr std::uint32_t kOniDepth = 2, kOniColor = 3, kOniInfrared = 5;  // kinds of nodes
inline constexpr std::uint64_t kOniMm = 100, kOniTenthsOfMm = 101, kOniShifts = 102, kOniRgb = 200;

struct OniNode {
  std::uint32_t kind = kOniDepth;
  std::string codec = "16zT";
  std::uint32_t cols = 0, rows = 0;
  std::uint64_t format = kOniMm;  // OpenNI 2's; 0: not written
  std::uint64_t old_format = 0;   // OpenNI 1's; 0: not written
  bool cropped = false;
};

// Depth in OpenNI's packings "16zP" and "16zT".
[[nodiscard]] std::string oni16z(std::span<const std::uint16_t> samples);
[[nodiscard]] std::string oni16zTable(std::span<const std::uint16_t> samples);

class OniWriter {
 public:
  // `wide`: version 1.0.1.0, with positions of 64 bits; else 1.0.0.5.
  explicit OniWriter(bool wide = true);
  std::uint32_t add(const OniNode& node);
  void write(std::uint32_t node, std::uint64_t time_us, std::string_view picture);
  // The whole recording; without tables of pictures as a recorder leaves it that was killed.
  [[nodiscard]] std::string finish(bool tables = true);
  // Where the record of a node's n-th picture begins.
  [[nodiscard]] std::uint64_t place(std::uint32_t node, std::size_t n) const { return nodes_[node - 1].places[n]; }

 private:
  struct Added {
    std::uint64_t counts = 0;  // where the number of its pictures is
    std::vector<std::uint64_t> times, places;
  };
  void record(std::uint32_t op, std::uint32_t node, std::string_view fields, std::string_view data = {});
  void property(std::uint32_t op, std::uint32_t node, std::string_view name, std::string_view value);

  bool wide_;
  std::string file_;
  std::vector<Added> nodes_;
  bool started_ = false;
};

}  // namespace relievo::test
