// SPDX-License-Identifier: Apache-2.0
// A camera on the network: serves a clip over RTSP at its own pace, interleaved over TCP, until its cable is pulled.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "platform/clock.h"
#include "platform/unique_fd.h"

namespace relievo::test {

// One viewer at a time. Each session begins with the clip's first picture, and its times with zero.
class RtspServer {
 public:
  explicit RtspServer(std::string clip);
  ~RtspServer();
  [[nodiscard]] std::string url() const;
  // The session ends without a word, and nobody is let in for so long. Any thread.
  void cut(Duration away);
  [[nodiscard]] int sessions() const { return sessions_; }  // that played
  [[nodiscard]] MonotonicTime cutOver() const { return away_until_; }

 private:
  void serve();
  void answer(const UniqueFd& viewer);
  void play(const UniqueFd& viewer);
  [[nodiscard]] bool away() const { return ending_ || clock_.now() < away_until_.load(); }

  const std::string clip_;
  UniqueFd listener_;
  std::uint16_t port_ = 0;
  MonotonicClock clock_;
  std::atomic<bool> ending_{false};
  std::atomic<int> sessions_{0};
  std::atomic<MonotonicTime> away_until_{MonotonicTime{}};
  std::thread thread_;
};

}  // namespace relievo::test
