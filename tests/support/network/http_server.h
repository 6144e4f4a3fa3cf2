// SPDX-License-Identifier: Apache-2.0
// A web server for a folder that stalls, breaks off and loses files on request.
#pragma once

#include <atomic>
#include <list>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "platform/clock.h"
#include "platform/unique_fd.h"

namespace relievo::test {

// Answers GET, with or without a range, each on a connection of its own.
class HttpServer {
 public:
  struct Fault {
    std::size_t after_bytes = 0;  // of the file
    Duration stall{0};            // once
    Duration away{0};             // once: breaks off, and refuses the next connection and all within this time of it
  };
  explicit HttpServer(std::string folder);
  ~HttpServer();

  // Set these before the first request.
  std::map<std::string, Fault> faults;       // by file
  std::map<std::string, int> busy;           // by file: how often the answer is 503
  std::map<std::string, std::string> moved;  // by file: to which other one a request is sent on
  std::string cookie;                        // "name=value": lists give it, and other files need it
  bool ranges = true;                        // false: whole files only
  double bytes_per_s = 0;                    // 0: as fast as it goes

  [[nodiscard]] std::string url(const std::string& file) const;
  // "GET /film.ts 200"; without those that were broken off or refused.
  [[nodiscard]] std::vector<std::string> requests() const;
  // When the last fault ended; 0 if there was none.
  [[nodiscard]] MonotonicTime faultOver() const { return fault_over_; }

 private:
  void serve();
  void answer(UniqueFd to);
  [[nodiscard]] bool sendBody(const UniqueFd& to, const std::string& file, const std::string& body, std::size_t from);

  const std::string folder_;
  UniqueFd listener_;
  std::uint16_t port_ = 0;
  MonotonicClock clock_;
  std::atomic<bool> ending_{false};
  std::atomic<Duration> away_{Duration(0)};  // from the next connection on
  MonotonicTime away_until_{};
  std::atomic<MonotonicTime> fault_over_{MonotonicTime{}};
  mutable std::mutex mutex_;  // guards the two below, `faults` and `busy`
  std::vector<std::string> requests_;
  std::list<std::thread> answers_;
  std::thread thread_;
};

}  // namespace relievo::test
