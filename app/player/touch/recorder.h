// SPDX-License-Identifier: Apache-2.0
// Writes every tick of the haptic task as a line of CSV, exactly: `--haptic replay:FILE` plays it again.
#pragma once

#include <optional>
#include <string>

#include "app/haptics/task/finger_state.h"
#include "hal/haptic_device.h"
#include "platform/atomic_file.h"
#include "platform/error.h"

namespace relievo {

// Columns: t_s (since the first tick), hip, proxy (scene mm), force (N, on the hand), contact, media_s (the film's
// time); position (device mm) and buttons of the device, and whether it answered; workspace, forces, stiffness and rate
// of the device, in the first row that it is known in and empty afterwards; no workspace if the device points at the
// picture. Numbers are the shortest that read back as
// the same double.
class Recorder {
 public:
  [[nodiscard]] static Result<Recorder> create(const std::string& path);
  // The device whose ticks follow.
  void setDevice(const HapticCapabilities& device) noexcept { device_ = device; }
  void add(const FingerState& tick);
  // To be committed at the end.
  [[nodiscard]] AtomicFile& file() noexcept { return file_; }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  explicit Recorder(AtomicFile file) noexcept : file_(std::move(file)) {}
  AtomicFile file_;
  std::optional<MonotonicTime> first_;
  std::optional<HapticCapabilities> device_;  // not yet written
};

}  // namespace relievo
