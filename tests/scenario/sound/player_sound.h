// SPDX-License-Identifier: Apache-2.0
// A player with a sound card in simulated time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/scenario/player_bench.h"

namespace relievo::test {

// The sound that is heard is recognised by its samples (PlayerBench::soundTrack), the picture by the film's frame that
// is shown: neither is asked of the player.
class PlayerSound : public testing::Test {
 protected:
  struct Moment {
    double time_s = 0;
    std::optional<double> heard_s;  // the film's time of the sound that is in the air
  };

  PlayerSound() {
    bench_.with_haptic = false;
    bench_.audio.emplace();
    bench_.config.osd = false;  // each picture is shown once
    bench_.display.shown = [this] {
      const MonotonicTime now = bench_.clock.now();
      std::optional<double> heard_s;
      if (bench_.ear->heard) {
        if (const auto sample = bench_.ear->heard(now)) heard_s = 1e3 * static_cast<double>(*sample);
      }
      moments_.push_back({toSeconds(now.time_since_epoch()), heard_s});
    };
  }
  void film(int frames) {
    bench_.sources["film"] = PlayerBench::film(frames);
    bench_.sources["film"].tracks.push_back(PlayerBench::soundTrack(frames));
  }
  MockTrack& sound() { return bench_.sources["film"].tracks[2]; }
  void playsWell() {
    const auto played = bench_.run();
    ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
    ASSERT_EQ(bench_.report.frames_dropped, 0u);
  }
  // How far the sound is ahead of picture k, in a film that is shown from its beginning without a break.
  [[nodiscard]] double offsetMs(std::size_t k) const {
    const double picture_s = toSeconds(PlayerBench::kPeriod) * static_cast<double>(k);
    return moments_[k].heard_s ? 1e3 * (*moments_[k].heard_s - picture_s) : std::nan("");
  }
  // The worst of pictures from..to.
  [[nodiscard]] double worstOffsetMs(std::size_t from, std::size_t to) const {
    double worst = 0;
    for (std::size_t k = from; k < to; ++k) {
      if (!(std::abs(offsetMs(k)) <= worst)) worst = std::isnan(offsetMs(k)) ? 1e9 : std::abs(offsetMs(k));
    }
    return worst;
  }
  // Takes out what was shown from..to, by the machine's time.
  std::vector<Moment> takeMoments(double from_s, double to_s) {
    std::vector<Moment> taken;
    std::erase_if(moments_, [&](const Moment& moment) {
      const bool there = moment.time_s >= from_s && moment.time_s < to_s;
      if (there) taken.push_back(moment);
      return there;
    });
    return taken;
  }
  [[nodiscard]] std::size_t silentMoments() const {
    return static_cast<std::size_t>(
        std::count_if(moments_.begin(), moments_.end(), [](const Moment& m) { return !m.heard_s; }));
  }

  PlayerBench bench_;
  std::vector<Moment> moments_;  // one for each picture that is shown, the first while the film does not run yet
};

}  // namespace relievo::test
