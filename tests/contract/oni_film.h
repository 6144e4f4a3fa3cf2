// SPDX-License-Identifier: Apache-2.0
// The contract's film as a recording of OpenNI.
#pragma once

#include <fstream>
#include <string>

#include "tests/contract/films.h"
#include "tests/support/film/recording/oni_writer.h"

namespace relievo::test {

inline std::string oniFilm() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    OniWriter oni;
    const auto color = oni.add({.kind = kOniColor, .codec = "NONE", .cols = 64, .rows = 48, .format = kOniRgb});
    for (int i = 0; i < kFilmFrames; ++i) {
      const auto time = std::chrono::duration_cast<std::chrono::microseconds>(1000 * kFilmPeriod + i * kFilmPeriod);
      oni.write(color, static_cast<std::uint64_t>(time.count()), std::string(64 * 48 * 3, static_cast<char>(i)));
    }
    std::ofstream(folder / "film.oni", std::ios::binary) << oni.finish();
    return folder / "film.oni";
  }();
  return path;
}

}  // namespace relievo::test
