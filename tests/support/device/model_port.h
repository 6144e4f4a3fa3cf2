// SPDX-License-Identifier: Apache-2.0
// A USB port with a model of a device behind it, in simulated time and in one thread.
#pragma once

#include <functional>
#include <limits>

#include "platform/allocation_counter.h"
#include "tests/support/device/usb/usb_model.h"

namespace relievo::test {

// The test's control of the cable. `verbs_left` counts down with every call: at zero the cable is unplugged, or the
// test's own action is done.
struct Cable {
  std::function<void()> instead;
  bool plugged = true;
  bool deaf = false;        // the device accepts no commands
  bool comes_back = false;  // it is plugged in again before the next `open`
  int verbs_left = std::numeric_limits<int>::max();
  MonotonicTime pulled_at;
  int exchanges = 0;  // the number started
  bool open = false, exchanging = false;
  std::uint64_t model_allocations = 0;  // by the model, on the thread of its caller
};

class ModelPort final : public UsbPort {
 public:
  ModelPort(UsbModel& model, Cable& cable, Clock& clock) : model_(model), cable_(cable), clock_(clock) {}
  ~ModelPort() override { close(); }

  Result<void> open() override {
    if (cable_.comes_back) cable_.plugged = true;
    if (!there()) return fail(ErrorCode::NotFound, "no model is plugged in");
    cable_.open = true;
    return {};
  }
  void close() noexcept override {
    stopExchange();
    cable_.open = false;
  }

  Result<void> control(std::uint8_t request, std::uint16_t value) override {
    if (!there()) return gone();
    model_.control(request, value, clock_.now());
    return {};
  }
  Result<void> send(UsbBytes bytes, Duration /*timeout*/) override {
    if (!there()) return gone();
    model_.write(bytes, clock_.now());
    return {};
  }
  Result<UsbPacket> receive(Duration timeout) override {
    const MonotonicTime until = clock_.now() + timeout;
    for (;;) {
      if (!there()) return gone();
      if (const auto packet = model_.read(clock_.now())) return *packet;
      if (clock_.now() >= until) return fail(ErrorCode::Timeout, "the model has nothing to say");
      clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(1));
    }
  }

  Result<void> startExchange(UsbBytes quiet) override {
    if (!there()) return gone();
    quiet_.assign(quiet.begin(), quiet.end());
    cable_.exchanging = true;
    ++cable_.exchanges;
    return {};
  }
  Result<UsbPacket> take() RELIEVO_RT override {
    if (!there()) return gone();
    const ModelAllocations counted(cable_);
    return model_.read(clock_.now()).value_or(UsbPacket{});
  }
  Result<bool> post(UsbBytes bytes) RELIEVO_RT override {
    if (!there()) return gone();
    if (cable_.deaf) return false;
    const ModelAllocations counted(cable_);
    model_.write(bytes, clock_.now());
    return true;
  }
  void stopExchange() noexcept override { cable_.exchanging = false; }
  bool quieten() noexcept override {
    if (!cable_.plugged || !cable_.exchanging || cable_.deaf) return false;
    model_.write(quiet_, clock_.now());
    return true;
  }

 private:
  // Counts the model's allocations, so that a test can subtract them from the driver's.
  class ModelAllocations {
   public:
    explicit ModelAllocations(Cable& cable) : cable_(cable), before_(threadAllocations()) {}
    ~ModelAllocations() { cable_.model_allocations += threadAllocations() - before_; }
    ModelAllocations(const ModelAllocations&) = delete;
    ModelAllocations& operator=(const ModelAllocations&) = delete;

   private:
    Cable& cable_;
    std::uint64_t before_;
  };

  bool there() RELIEVO_RT {
    if (cable_.verbs_left > 0 && --cable_.verbs_left == 0) {
      cable_.plugged = cable_.instead != nullptr;
      if (cable_.instead) cable_.instead();
      cable_.pulled_at = clock_.now();
    }
    return cable_.plugged;
  }
  static std::unexpected<Error> gone() RELIEVO_RT { return fail(ErrorCode::Lost, "the model was unplugged"); }

  UsbModel& model_;
  Cable& cable_;
  Clock& clock_;
  std::vector<std::uint8_t> quiet_;
};

}  // namespace relievo::test
