// SPDX-License-Identifier: Apache-2.0
// Pictures as raw bytes and their MD5 sums, as FFmpeg's program and the conformance streams write them: plane by plane,
// row by row, samples of over 8 bits as two bytes, the lower one first.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include <libavutil/md5.h>
#include <libavutil/mem.h>
}

#include "tests/support/film/clip_maker.h"

namespace relievo::test {

inline void appendRaw(const Frame& frame, std::vector<std::uint8_t>& bytes) {
  const bool wide = frame.components[0].bits > 8;
  for (int i = 0; i < (frame.model == ColorModel::Gray ? 1 : 3); ++i) {
    const int across = i > 0 ? frame.chroma_shift_x : 0, down = i > 0 ? frame.chroma_shift_y : 0;
    for (int r = 0; r < (frame.height + (1 << down) - 1) >> down; ++r) {
      for (int c = 0; c < (frame.width + (1 << across) - 1) >> across; ++c) {
        const std::uint32_t sample = sampleAt(frame, i, c, r);
        bytes.push_back(static_cast<std::uint8_t>(sample));
        if (wide) bytes.push_back(static_cast<std::uint8_t>(sample >> 8));
      }
    }
  }
}

class Md5 {
 public:
  Md5() : state_(av_md5_alloc()) { av_md5_init(state_.get()); }
  void add(const std::vector<std::uint8_t>& bytes) { av_md5_update(state_.get(), bytes.data(), bytes.size()); }
  [[nodiscard]] std::string sum() {
    std::array<std::uint8_t, 16> sum{};
    av_md5_final(state_.get(), sum.data());
    std::string words;
    for (const std::uint8_t byte : sum) {
      char text[3];
      std::snprintf(text, sizeof text, "%02x", byte);
      words += text;
    }
    return words;
  }

 private:
  struct Free {
    void operator()(AVMD5* state) const noexcept { av_free(state); }
  };
  std::unique_ptr<AVMD5, Free> state_;
};

// Runs FFmpeg's program. Throws with what it says when it fails.
inline void runFfmpeg(const std::string& arguments, const std::string& words) {
  const std::string line = "ffmpeg -v error -nostdin -y " + arguments + " 2>" + words;
  if (std::system(line.c_str()) == 0) return;  // NOLINT(bugprone-command-processor): the test's command
  std::ifstream said(words);
  throw std::runtime_error(line + ": " + std::string(std::istreambuf_iterator<char>(said), {}));
}

// The sums of all pictures of a film, as FFmpeg's program decodes them.
inline std::vector<std::string> sumsByFfmpeg(const std::string& film, const TemporaryFolder& folder,
                                             const std::string& filter = "null") {
  runFfmpeg("-threads 1 -i " + film + " -map 0:v:0 -fps_mode passthrough -noautoscale -vf " + filter + " -f framemd5 " +
                (folder / "sums.txt"),
            folder / "said.txt");
  std::ifstream file(folder / "sums.txt");
  std::vector<std::string> sums;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line[0] != '#') sums.push_back(line.substr(line.rfind(' ') + 1));
  }
  return sums;
}

}  // namespace relievo::test
