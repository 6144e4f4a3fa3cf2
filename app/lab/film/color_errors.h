// SPDX-License-Identifier: Apache-2.0
// The error of depth in colours: as relievo reads it, and naively, by the colour of the map that is nearest in RGB.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "app/scene/depth_calibration.h"
#include "app/scene/height_field.h"
#include "hal/media/frame.h"
#include "platform/failure.h"

namespace relievo {

// Accumulates over pictures. All heights are of volumes 40 mm deep; errors are shares of that.
class ColorErrors {
 public:
  // `coded`: a picture of `meaning`; `own`: as relievo reads it.
  void add(const Frame& coded, const DepthCalibration& meaning, const HeightField& own, const HeightField& truth);
  enum class Reading : std::uint8_t { Own, Naive };
  // The 99th percentile; of all samples, or of those within three samples of a step of over 1.2 %.
  [[nodiscard]] double p99(Reading reading, bool edges) const;

 private:
  struct Errors {
    std::vector<float> all, edges;
  };
  std::array<Errors, 2> errors_;  // own, naive
};

struct ColorErrorsRow {
  std::string steps;
  int crf = 0;
  const ColorErrors* errors = nullptr;
};
// To bitrate-colors.csv in `folder`.
[[nodiscard]] Outcome<void> writeColorErrors(const std::vector<ColorErrorsRow>& rows, const std::string& folder);

}  // namespace relievo
