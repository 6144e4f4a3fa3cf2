// SPDX-License-Identifier: Apache-2.0
// Folders of files that stand for pictures, read as a film.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "drivers/pictures/pictures.h"
#include "tests/support/film/clip_maker.h"

namespace relievo::test {

// Files whose content is their name, so that a packet tells which file it is.
class Pictures : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text = "") const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << (text.empty() ? name : text);
    return path;
  }
  static Result<StreamInfo> describe(const std::string& path) {
    StreamInfo stream;
    stream.codec = std::filesystem::path(path).extension().string();
    return stream;
  }
  struct Film {
    std::vector<std::string> color, depth;  // "ms name"
    std::vector<std::string> notes;
    std::vector<StreamInfo> streams;
    Duration duration{0};
    std::optional<Error> error;
  };
  [[nodiscard]] std::string line(const Packet& packet) const {
    char ms[32];
    std::snprintf(ms, sizeof ms, "%.6g ", 1e3 * toSeconds(*packet.pts));
    return ms + std::string(reinterpret_cast<const char*>(packet.data), packet.bytes);
  }
  [[nodiscard]] Film read(const std::string& url, std::optional<double> rate = std::nullopt,
                          std::optional<MediaTime> from = std::nullopt) const {
    const auto source = makePicturesSource(describe);
    source->setPictureRate(rate);
    Film film;
    if (auto opened = source->open(url); !opened) {
      film.error = opened.error();
      return film;
    }
    if (from) {
      EXPECT_TRUE(source->seek(*from));
    }
    film.notes = source->notes();
    film.streams = source->streams();
    film.duration = source->duration();
    for (auto packet = source->read(); packet && *packet; packet = source->read()) {
      EXPECT_TRUE((*packet)->keyframe);
      ((*packet)->stream == 0 ? film.color : film.depth).push_back(line(**packet));
    }
    return film;
  }

  TemporaryFolder folder_;
};

}  // namespace relievo::test
