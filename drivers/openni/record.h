// SPDX-License-Identifier: Apache-2.0
// Records of the NI10 format: a header, fields, and data behind them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"
#include "platform/files/answered_file.h"

namespace relievo::openni {

enum class Op : std::uint32_t {
  NodeAddedOldest = 2,  // version 1.0.0.4
  Picture = 10,
  End = 11,
  NodeAddedOld = 12,  // version 1.0.0.5
  NodeAdded = 13,
  PictureTable = 14,
};

struct Record {
  Op op = Op::End;
  std::uint32_t node = 0;
  std::uint64_t fields_begin = 0, data_begin = 0, end = 0;  // in the file
};

class RecordFile {
 public:
  // Corrupt if it does not begin like a recording, Unsupported if it is of another version.
  [[nodiscard]] Result<void> open(const std::string& path);
  void close() noexcept { file_.close(); }

  [[nodiscard]] std::uint64_t firstRecord() const noexcept;
  // The record that begins at `at`; nullopt if it is damaged or not whole.
  [[nodiscard]] std::optional<Record> recordAt(std::uint64_t at) const;
  // Nullopt unless all of it is there, and it is at most `most_bytes` long.
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> read(std::uint64_t begin, std::uint64_t end,
                                                              std::uint64_t most_bytes) const;
  [[nodiscard]] std::optional<std::vector<std::uint8_t>> fieldsOf(const Record& record) const;
  [[nodiscard]] std::optional<Error> failure() const { return file_.failure(); }
  // Positions have 64 bits, and records may say where a table of pictures is.
  [[nodiscard]] bool wide() const noexcept { return wide_; }

 private:
  AnsweredFile file_;
  std::uint64_t bytes_ = 0;
  bool wide_ = true;
};

}  // namespace relievo::openni
