// SPDX-License-Identifier: Apache-2.0
// Films of simulated time, alone and in a list, with a finger that may rest in them.
#pragma once

#include <gtest/gtest.h>

#include "tests/scenario/player_bench.h"

namespace relievo {

class PlayerTransport : public testing::Test {
 protected:
  void playsWell() {
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
  }
  // Films of 1, 2, 3 s.
  void aList() {
    bench_.sources = {{"./a", PlayerBench::film(25)}, {"./b", PlayerBench::film(50)}, {"./c", PlayerBench::film(75)}};
    bench_.texts["list.m3u"] = "#EXTM3U\na\nb\nc\n";
    bench_.config.source.url = "list.m3u";
  }
  // At rest in the highest plane of the film (code 109, 17.1 mm).
  void aFingerInside() {
    bench_.haptic.position_mm = [](double t) { return glm::dvec3(0, 0, t < 0.3 ? 25 : 15); };
  }

  PlayerBench bench_;
};

}  // namespace relievo
