// SPDX-License-Identifier: Apache-2.0
// The contract's film as a bag.
#pragma once

#include <fstream>
#include <string>

#include "tests/contract/films.h"
#include "tests/support/film/recording/bag_writer.h"
#include "tests/support/film/recording/ros_messages.h"

namespace relievo::test {

inline std::string bagFilm() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    BagWriter bag("lz4");
    const auto topic = bag.connect("/camera/image_raw", "sensor_msgs/Image");
    for (int i = 0; i < kFilmFrames; ++i) {
      const std::int64_t stamp = Duration(1000 * kFilmPeriod + i * kFilmPeriod).count();
      const std::string data(64 * 48 * 3, static_cast<char>(i));
      bag.write(
          topic, stamp,
          bagImage({.stamp_ns = stamp, .cols = 64, .rows = 48, .step = 64 * 3, .encoding = "rgb8", .data = data}));
      if (i % 4 == 3) bag.endChunk();
    }
    std::ofstream(folder / "film.bag", std::ios::binary) << bag.finish();
    return folder / "film.bag";
  }();
  return path;
}

}  // namespace relievo::test
