// SPDX-License-Identifier: Apache-2.0
// A film in simulated time with a finger that comes down onto it.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "app/media/lost_part.h"
#include "tests/scenario/player_bench.h"

namespace relievo {

inline constexpr const char* kWholeFilm = "boot idle opening buffering playing ended idle";

// From above the surface (code 100 is 15.7 mm of 40) to 15 mm, and there it stays: 0.7 to 2.1 mm deep.
inline std::vector<glm::dvec3> comingDown() {
  std::vector<glm::dvec3> path(201);
  for (std::size_t i = 0; i < path.size(); ++i) path[i] = {0, 0, 25.0 - 0.05 * static_cast<double>(i)};  // 50 mm/s
  return path;
}

// The mock's workspace is centred on z = 20, the middle of the default volume: device mm are scene mm.
class PlayerScenario : public testing::Test {
 protected:
  void playsWell() {
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
  }
  // It plays what is there of a source that is not whole, and the run does not end as if it had been whole.
  void playsInPart(const char* source) {
    const auto played = bench_.run();
    ASSERT_FALSE(played);
    EXPECT_EQ(played.error().thing, source);
    EXPECT_STREQ(played.error().error.message, failureOf({}).error.message);
  }
  PlayerBench bench_;
};

}  // namespace relievo
