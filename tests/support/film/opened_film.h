// SPDX-License-Identifier: Apache-2.0
// A film as `relievo FILE` opens it: what is known of it, and its first pair.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "app/media/pair_reader.h"
#include "app/scene/height_field.h"
#include "drivers/registry.h"

namespace relievo::test {

struct OpenedFilm {
  FilmInfo info;
  FramePair pair;

  // Between the far end (0) and the near end (1) of the box; NaN for a hole.
  [[nodiscard]] double heightAt(int c, int r) const {
    const auto field =
        HeightField::make(pair.depth, info.calibration.calibration, {.width_mm = 1, .height_mm = 1, .depth_mm = 1});
    return field ? field->heightMm(c, r) : -1;
  }
  // In mm, by the definition in app/scene/depth_calibration.h: z = D (far - Z)/(far - near).
  [[nodiscard]] double distanceAt(int c, int r) const {
    const DepthCalibration& calibration = info.calibration.calibration;
    return calibration.far_mm - heightAt(c, r) * (calibration.far_mm - calibration.near_mm);
  }
};

[[nodiscard]] inline OpenedFilm openFilm(const SourceOptions& options) {
  PairReader reader({.make_source = [](const std::string& url) { return drivers::makeMediaSource(url); },
                     .make_decoder = [](const StreamInfo& stream) { return drivers::makeSoftwareDecoder(stream); },
                     .read_text = {}});
  const auto opened = reader.open(options);
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  if (!opened) return {};
  OpenedFilm film{reader.info(), {}};
  if (auto pair = reader.next(); pair && *pair) film.pair = std::move(**pair);
  return film;
}

}  // namespace relievo::test
