// SPDX-License-Identifier: Apache-2.0
// A constant force, ticked by the cyclic thread while the user reads the scale and types what it shows.
#include "app/player/touch/calibrate.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string_view>
#include <vector>

#include "platform/cyclic_thread.h"

namespace relievo {
namespace {

constexpr std::array<double, 3> kForcesN{2, 3, 4};
constexpr double kSlewNPerS = 4;
constexpr double kAgreement = 0.2;

class HeldForce final : public CyclicTask {
 public:
  HeldForce(HapticDevice& device, double period_s) : device_(device), step_n_(kSlewNPerS * period_s) {}

  void aim(double force_n) { aim_n_ = force_n; }
  [[nodiscard]] bool lost() const { return lost_; }

  LoopControl loop(const Cycle& /*cycle*/) RELIEVO_RT override {
    force_n_ += std::clamp(aim_n_.load(std::memory_order_relaxed) - force_n_, -step_n_, step_n_);
    const bool moved = device_.read().has_value() && device_.write({0, 0, force_n_}).has_value();
    if (!moved && device_.state() == HapticDevice::State::Lost) lost_ = true;
    return lost_ ? LoopControl::Stop : LoopControl::Continue;
  }

 private:
  HapticDevice& device_;
  double step_n_;
  double force_n_ = 0;
  std::atomic<double> aim_n_{0};
  std::atomic<bool> lost_{false};
};

// Closed whatever happens; that takes the force away first.
struct Closing {
  HapticDevice& device;
  ~Closing() { device.close(); }
};

Result<double> agreed(const std::vector<double>& ratios) {
  const auto [least, most] = std::ranges::minmax(ratios);
  if (most > least * (1 + kAgreement)) {
    return fail(ErrorCode::InvalidArgument,
                "the readings do not agree within 20 %; hold the scale in line and try again");
  }
  double sum = 0;
  for (const double each : ratios) sum += each;
  return sum / static_cast<double>(ratios.size());
}

}  // namespace

Result<double> measureStrength(HapticDevice& device, const ReadScale& readScale, Clock& clock, bool own_thread) {
  const Closing closing{device};
  if (auto homed = device.home(); !homed) return std::unexpected(homed.error());
  if (auto started = device.start(); !started) return std::unexpected(started.error());

  const Duration period = fromSeconds(1 / device.capabilities().rate_hz);
  HeldForce held(device, toSeconds(period));
  CyclicThread thread(clock);  // goes before `held` and `closing`
  if (own_thread) {
    if (auto running = thread.start({.name = "relievo-scale", .period = period}, held); !running) {
      return std::unexpected(running.error());
    }
  }
  std::vector<double> ratios;
  for (const double asked_n : kForcesN) {
    if (asked_n > 0.9 * device.capabilities().peak_force_n) break;
    held.aim(asked_n);
    for (Duration t{0}; !own_thread && t < std::chrono::seconds(2); t += period) {
      clock.sleepUntil(clock.now() + period);
      (void)held.loop({});
    }
    const auto shown_n = readScale(asked_n);
    if (held.lost()) return fail(ErrorCode::Lost, "the haptic device was lost during the measurement");
    if (!shown_n) return fail(ErrorCode::Cancelled, "calibration cancelled; nothing was changed");
    if (!(*shown_n > 0.1 * asked_n && *shown_n < 10 * asked_n)) {
      return fail(ErrorCode::InvalidArgument, "the scale cannot show that; type newtons, such as 2.7");
    }
    ratios.push_back(*shown_n / asked_n);
  }
  if (ratios.empty()) return fail(ErrorCode::Unsupported, "this device has too little force to be measured");
  return agreed(ratios);
}

std::optional<double> newtonsIn(std::string line) {
  std::ranges::replace(line, ',', '.');
  char* end = nullptr;
  const double number = std::strtod(line.c_str(), &end);
  if (end == line.c_str() || !std::isfinite(number)) return std::nullopt;
  const bool all = std::string_view(end).find_first_not_of(" \tN") == std::string_view::npos;
  return all ? std::optional(number) : std::nullopt;
}

std::optional<double> askForReading(double asked_n) {
  for (;;) {
    std::printf("Requested force: %.0f N. The scale shows (N): ", asked_n);
    std::fflush(stdout);
    std::string line;
    if (!std::getline(std::cin, line) || line.empty()) return std::nullopt;
    if (const auto shown_n = newtonsIn(line)) return shown_n;
    std::puts("That is no number. Type newtons, such as 2.7; an empty line gives up.");
  }
}

}  // namespace relievo
