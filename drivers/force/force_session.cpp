// SPDX-License-Identifier: Apache-2.0
// Counts the time since the device answered, and fades the force in and out.
#include "drivers/force/force_session.h"

#include <algorithm>

namespace relievo {
namespace {

using namespace std::chrono_literals;

constexpr Duration kSilence = 100ms;
constexpr double kFadeInS = 0.5;

}  // namespace

Result<void> ForceSession::begin(PortBytes quiet) {
  auto begun = port_.startExchange(quiet);
  exchanging_ = begun.has_value();
  heard_ = clock_.now();
  return begun;
}

Result<void> ForceSession::beginForces(PortBytes quiet, bool watchdog_thread) {
  if (auto begun = begin(quiet); !begun) return begun;
  fade_ = 0;
  blind_ = false;
  last_share_ = heard_;
  auto watched = watchdog_.start(watchdog_thread);
  if (!watched) end();
  return watched;
}

void ForceSession::end() noexcept {
  watchdog_.stop();
  if (!exchanging_) return;
  static_cast<void>(port_.quieten());  // fails only if the device has gone
  port_.stopExchange();
  exchanging_ = false;
}

Result<void> ForceSession::listened(bool answered, bool known) RELIEVO_RT {
  const MonotonicTime now = clock_.now();
  if (answered) heard_ = now;
  if (now - heard_ > kSilence)
    return fail(ErrorCode::Lost, "the device stopped answering; unplug it and plug it in again");
  blind_ = !known || now - heard_ > watchdog_.patience();
  if (watchdog_.check(now)) fade_ = 0;
  return {};
}

ForceSession::Share ForceSession::nextShare() RELIEVO_RT {
  const MonotonicTime now = clock_.now();
  const double elapsed_s = toSeconds(now - last_share_);
  last_share_ = now;
  fade_ = blind_ ? 0 : std::min(1.0, fade_ + elapsed_s / kFadeInS);
  return {.of_force = fade_, .elapsed_s = elapsed_s};
}

Result<void> ForceSession::send(PortBytes command) RELIEVO_RT {
  const auto sent = port_.post(command);
  if (!sent) return std::unexpected(sent.error());
  if (*sent) watchdog_.feed(last_share_);
  return {};
}

}  // namespace relievo
