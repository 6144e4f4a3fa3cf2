// SPDX-License-Identifier: Apache-2.0
// A command that reads raw pictures and writes their depth.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "app/estimate/child_process.h"
#include "app/estimate/depth_estimator.h"

namespace relievo {

// It reads RGB24 on its standard input and writes 16-bit little-endian codes, larger is nearer, on its standard output:
// one depth picture for each picture, in order, rows without gaps. Its environment tells the sizes: RELIEVO_WIDTH,
// RELIEVO_HEIGHT, RELIEVO_DEPTH_WIDTH, RELIEVO_DEPTH_HEIGHT. It may answer late, by up to kMostLate pictures.
//
// A thread serves the pipes, so that neither side waits for the other. An error is one line that names the command, how
// it ended, and the last line of its standard error. Waiting ends with Cancelled when `stop` is set, and with Timeout
// when nothing was read or written for `patience`.
class DepthCommand final : public DepthEstimator {
 public:
  static constexpr std::size_t kMostLate = 64;
  struct Setup {
    std::string command;
    int cols = 0, rows = 0, depth_cols = 0, depth_rows = 0;
    std::chrono::nanoseconds patience = std::chrono::minutes(5);
  };
  [[nodiscard]] static Outcome<std::unique_ptr<DepthCommand>> start(Setup setup, const std::atomic<bool>& stop);
  ~DepthCommand() override;
  DepthCommand(const DepthCommand&) = delete;
  DepthCommand& operator=(const DepthCommand&) = delete;

  [[nodiscard]] Outcome<void> give(RawPicture picture) override;
  void end() override;
  [[nodiscard]] Outcome<std::optional<DepthEstimate>> take() override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  DepthCommand(Setup setup, ChildProcess child, UniqueFd wake, const std::atomic<bool>& stop);

  // On the pipes' thread.
  void serve(const std::stop_token& done);
  [[nodiscard]] const RawPicture* nextToWrite();
  void writeSome(const RawPicture& picture);
  void readSome();
  void listenSome();
  // On the owner's.
  void wakeServer() const;
  template <class Ready>
  [[nodiscard]] Outcome<void> waitFor(Lock& lock, Ready ready);
  [[nodiscard]] Outcome<void> checkEnd(Lock& lock);
  [[nodiscard]] bool isSilent();
  [[nodiscard]] std::unexpected<Failure> failed(const std::string& what, const Error& error) const;
  [[nodiscard]] std::unexpected<Failure> endedEarly(Lock& lock);
  [[nodiscard]] std::size_t depthBytes() const noexcept;

  const Setup setup_;
  const std::atomic<bool>& stop_;
  ChildProcess child_;
  UniqueFd wake_;
  mutable std::mutex mutex_;
  std::condition_variable moved_;
  // Only the pipes' thread uses these.
  std::size_t written_ = 0;         // bytes of the first waiting picture
  std::vector<std::uint8_t> part_;  // the next answer
  // Guarded by the mutex.
  std::deque<RawPicture> waiting_;  // to be written
  std::deque<DepthEstimate> answers_;
  std::size_t part_bytes_ = 0;  // of the next answer
  std::string said_;            // the end of its standard error
  std::size_t given_ = 0, answered_ = 0;
  bool no_more_ = false, output_ended_ = false;
  bool told_ = false;  // that it is waited for
  std::atomic<bool> too_much_ = false;
  std::chrono::steady_clock::time_point last_moved_;
  std::jthread thread_;  // the last member: it ends before what it uses
};

}  // namespace relievo
