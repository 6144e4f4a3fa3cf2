// SPDX-License-Identifier: Apache-2.0
// The layers, read from the includes: dependencies run downward only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

using testing::IsEmpty;
using testing::SizeIs;

bool isUnder(std::string_view path, std::string_view folder) {
  return path.size() > folder.size() && path.starts_with(folder) && path[folder.size()] == '/';
}

// "drivers/egl/egl.h" -> "drivers/egl", "hal/frame.h" -> "hal", "drivers/registry.h" -> "drivers".
std::string folderOf(std::string_view path) {
  return std::string(path.substr(0, path.rfind('/')));
}

bool isRegistry(std::string_view path) {
  return path == "drivers/registry.h" || path == "drivers/registry.cpp";
}

// What the rooms of the application may use of one another, besides hal and platform. The mains are in the
// last three.
struct Room {
  std::string_view folder;
  std::vector<std::string_view> uses;
};
const std::vector<Room>& rooms() {
  static const std::vector<Room> all = {
      {"app/scene", {}},
      {"app/media", {"app/scene"}},
      {"app/haptics", {"app/scene"}},
      {"app/render", {"app/scene"}},
      {"app/player", {"app/scene", "app/media", "app/haptics", "app/render"}},
      {"app/author", {"app/scene", "app/media"}},
      {"app/lab", {"app/scene", "app/media", "app/haptics", "app/render"}},
  };
  return all;
}

// Whether `path` may include `included`, both written from the project's root.
bool mayInclude(std::string_view path, std::string_view included) {
  const std::string folder = folderOf(path);
  if (folderOf(included) == folder) return !isRegistry(included) || isRegistry(path);
  if (isUnder(path, "platform")) return false;
  if (isUnder(included, "platform")) return true;
  if (isUnder(path, "hal")) return false;
  if (isUnder(included, "hal")) return true;
  if (isRegistry(path)) return isUnder(included, "drivers");
  if (isUnder(path, "drivers")) return false;
  if (path.ends_with("/main.cpp") && included == "drivers/registry.h") return true;
  for (const Room& room : rooms()) {
    if (!isUnder(path, room.folder)) continue;
    return std::any_of(room.uses.begin(), room.uses.end(),
                       [&](auto used) { return isUnder(included, used); });
  }
  return false;
}

// Real-time and pure code has no thread, no lock, no clock and no system call of its own.
const std::regex kImpureHeader(
    R"(^(thread|mutex|shared_mutex|condition_variable|future|semaphore|latch|barrier|stop_token|chrono|ctime|time\.h)"
    R"(|unistd\.h|pthread\.h|sched\.h|semaphore\.h|fcntl\.h|poll\.h|signal\.h|csignal|sys/.*|iostream|fstream)"
    R"(|filesystem)$)");
const std::regex kImpureWord(
    R"(\b(steady_clock|system_clock|high_resolution_clock|clock_gettime|std::thread|std::mutex|fopen)\b)");

bool isPure(std::string_view path) {
  return isUnder(path, "app/scene") || isUnder(path, "app/haptics");
}

// The offences of one file against the layers, each "line: what". `path` is from the project's root.
std::vector<std::string> offences(const std::string& path, const std::string& text) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*(?:"([^"]*)"|<([^>]*)>))re");
  std::vector<std::string> found;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto report = [&](const std::string& what) {
      found.push_back(path + ":" + std::to_string(number) + ": " + what);
    };
    const std::string code = line.substr(0, line.find("//"));
    std::smatch match;
    if (std::regex_search(line, match, kInclude)) {
      if (match[1].matched && !mayInclude(path, match[1].str())) report("may not include " + match[1].str());
      if (match[2].matched && isPure(path) && std::regex_match(match[2].str(), kImpureHeader)) {
        report("pure code does not include <" + match[2].str() + ">");
      }
    } else if (isPure(path) && std::regex_search(code, match, kImpureWord)) {
      report("pure code does not use " + match[0].str());
    }
  }
  return found;
}

struct SourceFile {
  std::string path;
  std::string text;
};

std::vector<SourceFile> readTree() {
  namespace fs = std::filesystem;
  std::vector<SourceFile> files;
  const fs::path root = RELIEVO_SOURCE_DIR;
  for (const char* top : {"platform", "hal", "drivers", "app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (!entry.is_regular_file() || (extension != ".h" && extension != ".cpp")) continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      files.push_back({entry.path().lexically_relative(root).generic_string(), text.str()});
    }
  }
  return files;
}

TEST(Layers, NoIncludeGoesAgainstThem) {
  const std::vector<SourceFile> files = readTree();
  ASSERT_GT(files.size(), 50u) << "the tree was not found";
  for (const SourceFile& file : files) EXPECT_THAT(offences(file.path, file.text), IsEmpty());
}

struct Example {
  const char* path;
  const char* text;
};

// Each breaks one rule, so that a checker that lets everything pass is seen.
TEST(Layers, EachKindOfOffenceIsSeen) {
  const std::array bad = {
      Example{"platform/clock.cpp", "#include \"hal/frame.h\"\n"},
      Example{"hal/frame.h", "#include \"app/scene/height_field.h\"\n"},
      Example{"hal/display.cpp", "#include \"drivers/egl/egl.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"app/render/scene_renderer.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"drivers/ffmpeg/ffmpeg.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"drivers/registry.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"egl.h\"\n"},  // not from the root
      Example{"drivers/registry.cpp", "#include \"app/scene/display_volume.h\"\n"},
      Example{"app/scene/height_field.h", "#include \"app/haptics/method.h\"\n"},
      Example{"app/scene/height_field.h", "#include <chrono>\n"},
      Example{"app/haptics/haptic_task.cpp", "#include \"app/render/stereo.h\"\n"},
      Example{"app/haptics/haptic_task.cpp", "#include \"drivers/sim/sim.h\"\n"},
      Example{"app/haptics/haptic_task.cpp", "  #  include <thread>\n"},
      Example{"app/haptics/haptic_task.cpp", "#include <mutex>\n"},
      Example{"app/haptics/haptic_task.cpp", "#include <unistd.h>\n"},
      Example{"app/haptics/haptic_task.cpp", "#include <pthread.h>\n"},
      Example{"app/haptics/haptic_task.cpp", "auto t = std::chrono::steady_clock::now();\n"},
      Example{"app/render/stereo.cpp", "#include \"app/player/player.h\"\n"},
      Example{"app/player/player.cpp", "#include \"app/lab/report.h\"\n"},
      Example{"app/player/player.cpp", "#include \"drivers/registry.h\"\n"},
      Example{"app/player/main.cpp", "#include \"drivers/mock/mock.h\"\n"},
      Example{"app/player/main.cpp", "#include \"tests/support/film.h\"\n"},
      Example{"app/nowhere/file.cpp",
              "#include \"app/scene/height_field.h\"\n"},  // a room that nobody has planned
  };
  for (const Example& example : bad) {
    EXPECT_THAT(offences(example.path, example.text), SizeIs(1)) << example.path << ": " << example.text;
  }
}

TEST(Layers, WhatIsAllowedIsNotReported) {
  const std::array good = {
      Example{"platform/clock.cpp",
              "#include \"platform/clock.h\"\n#include <chrono>\n#include <unistd.h>\n"},
      Example{"hal/frame.h", "#include \"hal/media_time.h\"\n#include \"platform/error.h\"\n"},
      Example{"drivers/egl/egl.cpp",
              "#include \"drivers/egl/egl.h\"\n#include \"hal/display.h\"\n#include <thread>\n"},
      Example{"drivers/registry.cpp", "#include \"drivers/registry.h\"\n#include \"drivers/egl/egl.h\"\n"},
      Example{"app/scene/height_field.h",
              "#include \"hal/frame.h\"\n#include \"platform/error.h\"\n#include <cmath>\n"},
      Example{"app/haptics/safety.cpp", "#include \"app/scene/display_volume.h\"\n// no steady_clock here\n"},
      Example{"app/player/main.cpp", "#include \"drivers/registry.h\"\n#include \"app/player/player.h\"\n"},
  };
  for (const Example& example : good) EXPECT_THAT(offences(example.path, example.text), IsEmpty());
}

}  // namespace
