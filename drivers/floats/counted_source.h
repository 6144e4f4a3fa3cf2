// SPDX-License-Identifier: Apache-2.0
// A media source of one file with pictures that have no times: they are counted from the beginning.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/media/media_source.h"
#include "platform/files/answered_file.h"

namespace relievo {

// A derived class describes the open file and reads the picture of number `next_`; its destructor calls close().
class CountedSource : public MediaSource {
 protected:
  static constexpr Duration kPeriod = std::chrono::milliseconds(40);  // as FFmpeg's of numbered pictures

  [[nodiscard]] virtual Result<Description> describe(const std::string& url) = 0;
  [[nodiscard]] bool isInterrupted() const noexcept { return interrupted_; }
  [[nodiscard]] static Packet packetOf(std::shared_ptr<const std::vector<std::uint8_t>> bytes) {
    return {.data = bytes->data(), .bytes = bytes->size(), .keyframe = true, .owner = std::move(bytes)};
  }

  void closeSource() noexcept override { file_.close(); }

  AnsweredFile file_;
  std::uint64_t next_ = 0;

 private:
  Result<Description> openSource(const std::string& url) override {
    interrupted_ = false;
    auto file = AnsweredFile::open(url);
    if (!file) return std::unexpected(file.error());
    file_ = std::move(*file);
    next_ = 0;
    return describe(url);
  }
  Result<void> seekTo(MediaTime) override {
    next_ = 0;
    return {};
  }
  void interrupted() noexcept override { interrupted_ = true; }

  std::atomic<bool> interrupted_ = false;
};

}  // namespace relievo
