// SPDX-License-Identifier: Apache-2.0
// The volume of the sound, remembered for each sound output.
#pragma once

#include <string>

#include "app/player/file_writer.h"

namespace relievo {

class Loudness {
 public:
  static constexpr double kMostPercent = 130;

  // `path`: a file kept from the last run, JSON: {"DEVICE": percent, ..}; empty: nothing is remembered.
  Loudness(std::string path, std::string device);

  void set(double percent) noexcept;
  void mute(bool muted) noexcept { muted_ = muted; }
  [[nodiscard]] double percent() const noexcept { return percent_; }
  [[nodiscard]] bool muted() const noexcept { return muted_; }
  // The factor on the samples: the cube of the volume's share, which sounds linear.
  [[nodiscard]] double gain() const noexcept;
  // Queues the file for writing if the volume has changed. A failure to write is logged.
  void keep(FileWriter& files);

 private:
  std::string path_, device_;
  double percent_ = 100, kept_percent_ = 100;
  bool muted_ = false;
};

}  // namespace relievo
