// SPDX-License-Identifier: Apache-2.0
// The program relievo as its user runs it: real files, exit codes, what it prints and what it leaves behind.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo::test {

using nlohmann::json;

inline ClipTrack color(int frames = 30) {
  return {.pix_fmt = "yuv420p", .width = 64, .height = 48, .frames = frames, .tags = {{"title", "color"}}};
}
inline ClipTrack depth(int frames = 30) {
  return {.pix_fmt = "gray16le", .width = 64, .height = 48, .frames = frames, .tags = {{"title", "depth"}}};
}

class PlayerProgram : public testing::Test {
 protected:
  // The mock display costs nothing; one test draws.
  ProgramResult play(const std::string& words, const std::string& display = "mock") {
    return runProgram("relievo play --display " + display + " " + words, at(""));
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string textOf(const std::string& name) const { return contentOf(at(name)); }
  [[nodiscard]] json reportOf(const std::string& name) const { return json::parse(textOf(name), nullptr, false); }
  // Nothing is left but what the test itself put there and what the program said.
  void expectNothingLeft(const std::vector<std::string>& put) const {
    for (const auto& entry : std::filesystem::directory_iterator(at(""))) {
      const std::string name = entry.path().filename();
      if (name == "stdout.txt" || name == "stderr.txt") continue;
      EXPECT_NE(std::find(put.begin(), put.end(), name), put.end()) << name;
    }
  }
  static void expectOneLine(const ProgramResult& result, int exit_code, const std::string& thing) {
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_THAT(result.err, testing::StartsWith("relievo: "));
    EXPECT_THAT(result.err, testing::HasSubstr(thing));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(result.out, "");
  }

  // The arguments of a run that plays without end and has two files to write.
  [[nodiscard]] std::vector<std::string> endless(const std::string& film) const {
    return {std::string(RELIEVO_BIN_DIR) + "/relievo",
            "play",
            at(film),
            "--loop",
            "--display",
            "mock",
            "--report",
            at("r.json"),
            "--record",
            at("t.csv")};
  }

  TemporaryFolder folder_;
};

}  // namespace relievo::test
