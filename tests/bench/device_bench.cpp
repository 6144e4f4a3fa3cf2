// SPDX-License-Identifier: Apache-2.0
// The time of one tick of a haptic device's driver, `read` and `write`, without USB transfer: the port has an answer
// ready for each command. The finger moves at 0.3 m/s.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "drivers/falcon/falcon.h"
#include "drivers/inverse3/inverse3.h"
#include "drivers/polhem/polhem.h"
#include "drivers/polhem/report.h"
#include "platform/histogram.h"
#include "tests/support/device/inverse3_service.h"

namespace relievo {
namespace {

constexpr std::size_t kAnswers = 4096;

// Returns its answers in order, forwards and backwards, one per command.
class NullPort final : public UsbPort {
 public:
  explicit NullPort(std::vector<UsbPacket> answers) : answers_(std::move(answers)) {}

  Result<void> open() override { return {}; }
  void close() noexcept override {}
  Result<void> control(std::uint8_t, std::uint16_t) override { return {}; }
  Result<void> send(UsbBytes, Duration) override {
    asked_ = true;
    return {};
  }
  Result<UsbPacket> receive(Duration) override { return take(); }
  Result<void> startExchange(UsbBytes) override { return {}; }
  Result<UsbPacket> take() RELIEVO_RT override {
    if (!asked_) return UsbPacket{};
    asked_ = false;
    if (moving) ++at_;
    const std::size_t i = at_ % (2 * kAnswers);
    return answers_[i < kAnswers ? i : 2 * kAnswers - 1 - i];
  }
  Result<bool> post(UsbBytes bytes) RELIEVO_RT override {
    benchmark::DoNotOptimize(bytes.data());
    asked_ = true;
    return true;
  }
  void stopExchange() noexcept override {}
  bool quieten() noexcept override { return true; }

  bool moving = false;

 private:
  std::vector<UsbPacket> answers_;
  bool asked_ = false;
  std::size_t at_ = 0;
};

template <class Bytes>
UsbPacket packetOf(const Bytes& bytes, std::size_t header, std::size_t count) {
  UsbPacket packet;
  std::copy_n(bytes.begin(), count, packet.data.begin() + static_cast<std::ptrdiff_t>(header));
  packet.bytes = header + count;
  return packet;
}

// A path of 20 mm and more within the workspace, 0.3 mm per tick.
glm::dvec3 figure(std::size_t i) {
  const double phase = 0.01 * static_cast<double>(i);
  return {20 * std::sin(phase), 20 * std::sin(0.8 * phase), 20 * std::cos(0.6 * phase)};
}

// The emulator's wire. From the call of `moving` on it repeats one answer, once for each message.
class NullWire final : public inverse3::Wire {
 public:
  NullWire(test::Inverse3Service& service, Clock& clock) : wire_(service, clock) {}

  Result<void> open(const std::atomic<bool>& cancelled) override { return wire_.open(cancelled); }
  void close() noexcept override { wire_.close(); }
  Result<std::size_t> receive(std::span<char> to) RELIEVO_RT override {
    if (!moving) {
      const auto bytes = wire_.receive(to);
      if (bytes && *bytes > 0) answer_.assign(to.data(), *bytes);
      return bytes;
    }
    const std::size_t bytes = asked_ ? answer_.size() : 0;
    asked_ = false;
    std::copy_n(answer_.begin(), bytes, to.begin());
    return bytes;
  }
  Result<std::size_t> send(std::span<const char> bytes) RELIEVO_RT override {
    if (!moving) return wire_.send(bytes);
    benchmark::DoNotOptimize(bytes.data());
    asked_ = true;
    return bytes.size();
  }
  void cut() noexcept override { wire_.cut(); }

  bool moving = false;

 private:
  test::EmulatedWire wire_;
  std::string answer_;
  bool asked_ = true;
};

template <class Port>
void run(benchmark::State& state, HapticDevice& device, Port& port) {
  const MonotonicClock clock;
  if (!device.open() || !device.home() || !device.start()) return state.SkipWithError("the device does not run");
  port.moving = true;
  Histogram times;
  double sum = 0;
  for (auto _ : state) {
    const MonotonicTime begin = clock.now();
    const auto sample = device.read();
    const auto written = device.write({1, -2, 0.5});
    times.add(clock.now() - begin);
    if (!sample || !written) return state.SkipWithError("a tick has failed");
    sum += sample->position_mm.x;
  }
  benchmark::DoNotOptimize(sum);
  const auto us = [&](double q) { return static_cast<double>(times.quantile(q).count()) * 1e-3; };
  state.counters["median_us"] = us(0.5);
  state.counters["p99_us"] = us(0.99);
  state.counters["p99.9_us"] = us(0.999);
}

void falconTick(benchmark::State& state) {
  std::vector<UsbPacket> answers;
  for (std::size_t i = 0; i < kAnswers; ++i) {
    const auto pose = falcon::inverse(falcon::kCentreMm + figure(i));
    answers.push_back(packetOf(falcon::encode(falcon::Reply{.encoders = falcon::countsOf(pose->theta_rad), .homed = 7}),
                               2, falcon::kPacketBytes));
  }
  auto port = std::make_unique<NullPort>(std::move(answers));
  NullPort& null = *port;
  MonotonicClock clock;
  const auto device = makeFalcon({.watchdog_thread = false}, std::move(port), clock);
  run(state, *device, null);
}

void polhemTick(benchmark::State& state) {
  std::vector<UsbPacket> answers;
  for (std::size_t i = 0; i < kAnswers; ++i) {
    const glm::dvec3 p = 20.0 * figure(i);  // in counts of about 0.05 mm
    polhem::Report report;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      report.arm[axis] = static_cast<std::int16_t>(0.33 * p[static_cast<int>(axis)]);
    }
    answers.push_back(packetOf(polhem::encode(report), 0, polhem::kReportBytes));
  }
  auto port = std::make_unique<NullPort>(std::move(answers));
  NullPort& null = *port;
  MonotonicClock clock;
  const auto device = makePolhem({.watchdog_thread = false}, std::move(port), clock);
  run(state, *device, null);
}

void inverse3Tick(benchmark::State& state) {
  MonotonicClock clock;
  test::Inverse3Service service(test::Inverse3Service::Version::V3_5);
  auto wire = std::make_unique<NullWire>(service, clock);
  NullWire& null = *wire;
  const auto device = makeInverse3({.watchdog_thread = false}, std::move(wire), clock);
  run(state, *device, null);
}

BENCHMARK(inverse3Tick)->Iterations(500000);
BENCHMARK(falconTick)->Iterations(500000);
BENCHMARK(polhemTick)->Iterations(500000);

}  // namespace
}  // namespace relievo
