// SPDX-License-Identifier: Apache-2.0
// ROS 1 bags (format 2.0), byte by byte, for tests.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/byte_writer.h"

namespace relievo::test {

class BagWriter {
 public:
  explicit BagWriter(std::string compression = "none");
  std::uint32_t connect(const std::string& topic, const std::string& type);
  void write(std::uint32_t connection, std::int64_t time_ns, const std::string& message);
  void endChunk();
  // Ends the chunk with a message of so many zeros, which take no room on the disk (`save`). Only in plain chunks.
  void writeHole(std::uint32_t connection, std::int64_t time_ns, std::uint32_t bytes);
  // The whole bag; without an index as a recorder leaves it that was killed.
  [[nodiscard]] std::string finish(bool indexed = true);
  // The same, of a bag with holes, as a file.
  void save(const std::string& path, bool indexed = true);

 private:
  struct Info {
    std::uint64_t begin = 0;
    std::map<std::uint32_t, std::uint32_t> counts;
  };
  [[nodiscard]] std::uint64_t position() const { return file_.size() + skipped_; }
  [[nodiscard]] std::string pack(const std::string& plain) const;

  std::string compression_;
  std::string file_, chunk_;
  std::vector<std::string> connections_;           // their records
  std::map<std::uint32_t, ByteWriter> index_;      // of the chunk
  std::map<std::uint32_t, std::uint32_t> counts_;  // likewise
  std::vector<bool> introduced_;                   // for each connection: a chunk has its record
  std::vector<Info> infos_;
  std::uint32_t hole_ = 0;                                    // bytes behind the chunk
  std::vector<std::pair<std::size_t, std::uint32_t>> holes_;  // where in `file_`, and how long
  std::uint64_t skipped_ = 0;                                 // bytes of all holes
};

}  // namespace relievo::test
