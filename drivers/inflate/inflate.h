// SPDX-License-Identifier: Apache-2.0
// Unpacks a stream of DEFLATE (RFC 1951) in a file piece by piece, by zlib.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "platform/files/answered_file.h"

namespace relievo {

// A copy goes on from the same place by itself, so that it can serve as a mark to return to.
class Inflater {
 public:
  // The stream lies in `file` from `begin` to `end`, without zlib's head.
  Inflater(AnsweredFile file, std::uint64_t begin, std::uint64_t end);
  Inflater(const Inflater& from);
  Inflater(Inflater&&) = default;
  Inflater& operator=(const Inflater&) = delete;
  Inflater& operator=(Inflater&&) = default;
  ~Inflater() = default;

  // Fills `out`; returns how many bytes were unpacked: fewer where the stream ends or is damaged.
  [[nodiscard]] std::size_t read(std::span<std::uint8_t> out);
  [[nodiscard]] bool damaged() const noexcept { return damaged_; }

 private:
  struct End {
    void operator()(z_stream* stream) const noexcept {
      inflateEnd(stream);
      delete stream;
    }
  };
  void fill();

  AnsweredFile file_;
  std::uint64_t at_, end_;
  std::vector<std::uint8_t> input_;
  std::unique_ptr<z_stream, End> stream_;  // zlib keeps its address
  bool damaged_ = false;
};

}  // namespace relievo
