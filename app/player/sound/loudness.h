// SPDX-License-Identifier: Apache-2.0
// How loud the sound is: a soft factor, remembered for each sound output.
#pragma once

#include <string>

#include "app/player/file_writer.h"

namespace relievo {

class Loudness {
 public:
  static constexpr double kMostPercent = 130;

  // `path`: a file of the last run, JSON: {"DEVICE": percent, ..}; empty: nothing is remembered.
  Loudness(std::string path, std::string device);

  void set(double percent) noexcept;
  void mute(bool muted) noexcept { muted_ = muted; }
  [[nodiscard]] double percent() const noexcept { return percent_; }
  [[nodiscard]] bool muted() const noexcept { return muted_; }
  // The factor on the samples: the cube of the share, which sounds even.
  [[nodiscard]] double gain() const noexcept;
  // Has the file written if the volume has changed. What cannot be written is told in the log.
  void keep(FileWriter& files);

 private:
  std::string path_, device_;
  double percent_ = 100, kept_percent_ = 100;
  bool muted_ = false;
};

}  // namespace relievo
