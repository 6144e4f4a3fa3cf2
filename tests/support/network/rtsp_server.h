// SPDX-License-Identifier: Apache-2.0
// A simulated network camera: serves a clip over RTSP in real time, interleaved over TCP, until it is cut off.
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
  // Ends the session without notice and refuses connections for that long. Any thread.
  void cut(Duration away);
  [[nodiscard]] int sessions() const { return sessions_; }  // sessions that played
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
