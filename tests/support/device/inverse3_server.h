// SPDX-License-Identifier: Apache-2.0
// The emulator of the Haply Inverse service behind a port of the loopback interface, in its own thread and real time.
#pragma once

#include <array>
#include <atomic>
#include <mutex>
#include <thread>

#include "tests/support/device/inverse3_service.h"
#include "tests/support/network/loopback.h"

namespace relievo::test {

class Inverse3Server {
 public:
  explicit Inverse3Server(Inverse3Service::Version version, std::uint16_t port = 0)
      : service_(version),
        listener_(bindLoopback(SOCK_STREAM, port)),
        port_(portOf(listener_)),
        thread_([this] { serve(); }) {}
  ~Inverse3Server() {
    ending_ = true;
    thread_.join();
  }
  Inverse3Server(const Inverse3Server&) = delete;
  Inverse3Server& operator=(const Inverse3Server&) = delete;

  [[nodiscard]] inverse3::Address address() const { return {.host = "127.0.0.1", .port = port_}; }
  // Calls `use` while the service is stopped.
  template <class Use>
  auto with(const Use& use) {
    const std::lock_guard guard(lock_);
    return use(service_);
  }

 private:
  void serve() {
    while (!ending_) {
      if (!readable(listener_, std::chrono::milliseconds(10))) continue;
      const UniqueFd client(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (!with([this](Inverse3Service& service) { return service.connect(clock_.now()); })) continue;
      while (!ending_ && exchange(client)) {
      }
      with([](Inverse3Service& service) { service.disconnect(); });
    }
  }
  bool exchange(const UniqueFd& client) {
    if (readable(client, std::chrono::milliseconds(1))) {
      std::array<char, 4096> bytes{};
      const ssize_t got = ::recv(client.get(), bytes.data(), bytes.size(), 0);
      if (got <= 0) return false;
      with([&](Inverse3Service& service) {
        service.receive({bytes.data(), static_cast<std::size_t>(got)}, clock_.now());
      });
    }
    const std::string answer = with([this](Inverse3Service& service) { return service.take(clock_.now()); });
    return sendAll(client, answer) && with([](Inverse3Service& service) { return service.connected(); });
  }

  MonotonicClock clock_;
  std::mutex lock_;
  Inverse3Service service_;  // guarded
  UniqueFd listener_;
  const std::uint16_t port_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

}  // namespace relievo::test
