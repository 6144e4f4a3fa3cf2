// SPDX-License-Identifier: Apache-2.0
// State guards of the haptic device, and the last check of a force before it is sent.
#include "hal/haptic_device.h"

#include <algorithm>
#include <cmath>

namespace relievo {

Result<double> HapticDevice::setRate(double hz) {
  if (state_ != State::Closed)
    return fail(ErrorCode::InvalidState, "the rate of a haptic device is set before it is opened; close it first");
  if (!(hz >= kLeastRateHz && hz <= kMostRateHz))
    return fail(ErrorCode::InvalidArgument, "a haptic device takes a rate from 500 to 8000 Hz");
  asked_hz_ = hz;
  return capabilities().rate_hz;
}

double HapticDevice::rateWithin(double own_hz, double most_hz) const RELIEVO_RT {
  return asked_hz_ > 0 ? std::min(asked_hz_, most_hz) : own_hz;
}

Result<void> HapticDevice::open() {
  if (state_ != State::Closed)
    return fail(ErrorCode::InvalidState, "the haptic device is open already; close it first");
  if (cancelled_) return fail(ErrorCode::Cancelled, "opening the haptic device was cancelled");
  auto opened = openDevice();
  if (!opened) {
    closeDevice();
    return opened;
  }
  state_ = State::Opened;
  return {};
}

Result<void> HapticDevice::home() {
  if (state_ != State::Opened && state_ != State::Ready) {
    return fail(ErrorCode::InvalidState, "the haptic device can home only when opened and not running");
  }
  if (cancelled_) return fail(ErrorCode::Cancelled, "homing the haptic device was cancelled");
  auto homed = homeDevice();
  if (homed) state_ = State::Ready;
  // A device that was Ready and failed to home again no longer knows its zero: it must not start.
  else state_ = homed.error().code == ErrorCode::Lost ? State::Lost : State::Opened;
  return homed;
}

Result<void> HapticDevice::start() {
  if (state_ != State::Ready) return fail(ErrorCode::InvalidState, "the haptic device can start only after homing");
  auto started = startDevice();
  if (started) state_ = State::Running;
  else if (started.error().code == ErrorCode::Lost) state_ = State::Lost;
  return started;
}

Result<HapticSample> HapticDevice::read() RELIEVO_RT {
  if (state_ != State::Running) return fail(ErrorCode::InvalidState, "the haptic device is not running");
  auto sample = readSample();
  if (!sample && sample.error().code == ErrorCode::Lost) state_ = State::Lost;
  return sample;
}

Result<void> HapticDevice::write(const glm::dvec3& force_n) RELIEVO_RT {
  if (state_ != State::Running) return fail(ErrorCode::InvalidState, "the haptic device is not running");
  // Squared and with a rounding margin: a force limited to exactly the peak must pass.
  const double peak = capabilities().peak_force_n;
  const double squared = force_n.x * force_n.x + force_n.y * force_n.y + force_n.z * force_n.z;
  const bool acceptable = std::isfinite(squared) && squared <= peak * peak * (1.0 + 1e-9);
  auto written = writeForce(acceptable ? force_n : glm::dvec3(0));
  if (!written) {
    if (written.error().code == ErrorCode::Lost) state_ = State::Lost;
    return written;
  }
  if (!acceptable)
    return fail(ErrorCode::InvalidArgument,
                "the force was not finite or over the device's peak; zero was sent instead");
  return {};
}

void HapticDevice::stop() noexcept {
  if (state_ != State::Running) return;
  stopDevice();
  state_ = State::Ready;
}

void HapticDevice::close() noexcept {
  cancelled_ = false;
  if (state_ == State::Closed) return;
  stop();
  closeDevice();
  state_ = State::Closed;
}

}  // namespace relievo
