// SPDX-License-Identifier: Apache-2.0
// The layers, read from the includes: dependencies run downward only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
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

// "drivers/egl/egl.h" -> "drivers/egl", "hal/media/frame.h" -> "hal", "drivers/registry.h" -> "drivers".
std::string folderOf(std::string_view path) {
  return std::string(path.substr(0, path.rfind('/')));
}

// "drivers/ffmpeg" of "drivers/ffmpeg/views/view_pairs.h".
std::string_view driverOf(std::string_view path) {
  return path.substr(0, path.find('/', path.find('/') + 1));
}

bool isRegistry(std::string_view path) {
  return folderOf(path) == "drivers" && path.starts_with("drivers/registry");
}

// What each folder of the application ("room") may include from others, besides hal and platform. A file belongs to the
// longest folder of this list that contains it. It may include its own folder; a folder in `uses` includes all folders
// below it.
struct Room {
  std::string_view folder;
  std::vector<std::string_view> uses;
};
const std::vector<Room>& rooms() {
  static const std::vector<Room> all = {
      {"app/scene/codes", {}},
      {"app/scene/color", {"app/scene/codes"}},  // depth in colours
      {"app/scene", {"app/scene"}},
      // where the depth is and what it means: of streams and pictures alone
      {"app/media/reading", {"app/media/reading", "app/scene"}},
      {"app/media/registration", {"app/scene"}},  // depth of one camera in the view of another
      {"app/media/tracks", {}},                   // one track's data, decoded
      {"app/media", {"app/media", "app/scene"}},
      {"app/coding", {}},
      {"app/depth_window", {"app/scene"}},
      {"app/haptics/method", {"app/scene", "app/depth_window"}},
      {"app/haptics/task", {"app/scene", "app/depth_window", "app/haptics/method"}},
      {"app/haptics/baseline", {"app/scene", "app/depth_window", "app/haptics/method"}},
      {"app/render/relief", {"app/scene"}},
      {"app/render/text", {}},
      {"app/render/gl", {"app/render/gl", "app/scene", "app/render/relief", "app/render/text"}},
      {"app/cli", {"app/scene", "app/media"}},
      {"app/player",
       {"app/player", "app/scene", "app/media", "app/depth_window", "app/haptics/method", "app/haptics/task",
        "app/render", "app/cli", "app/stereo/quick"}},
      {"app/enhance", {"app/scene"}},
      {"app/motion", {"app/scene"}},                // how the things of a picture have moved
      {"app/stereo", {"app/stereo", "app/scene"}},  // depth from two views
      {"app/stereo/quick",
       {"app/stereo", "app/scene", "app/motion"}},                  // the same, while a film plays, without a library
      {"app/estimate", {"app/scene", "app/motion", "app/stereo"}},  // depth guessed from one view
      {"app/author/sample", {"app/author", "app/scene", "app/coding"}},
      {"app/author",
       {"app/author", "app/scene", "app/media", "app/coding", "app/depth_window", "app/cli", "app/enhance",
        "app/estimate", "app/motion", "app/stereo"}},
      {"app/lab/truth", {"app/scene"}},  // the truth that the methods are compared with does not use them
      {"app/lab",
       {"app/lab", "app/scene", "app/media", "app/coding", "app/depth_window", "app/haptics", "app/render", "app/cli",
        "app/enhance", "app/stereo"}},
  };
  return all;
}

const Room* roomOf(std::string_view path) {
  const Room* longest = nullptr;
  for (const Room& room : rooms()) {
    if (isUnder(path, room.folder) && (longest == nullptr || room.folder.size() > longest->folder.size())) {
      longest = &room;
    }
  }
  return longest;
}

// Whether `path` may include `included`, both written from the project's root.
bool mayInclude(std::string_view path, std::string_view included) {
  const std::string folder = folderOf(path);
  if (folderOf(included) == folder) return !isRegistry(included) || isRegistry(path);
  if (isUnder(included, "platform")) return true;
  if (isUnder(path, "platform")) return false;
  if (isUnder(included, "hal")) return true;
  if (isUnder(path, "hal")) return false;
  if (isRegistry(path)) return isUnder(included, "drivers");
  // A bus, what devices with motors share, what a window hears, what kinds of pictures share, what input devices share,
  // and what unpacks.
  if (isUnder(path, "drivers")) {
    if (driverOf(included) == driverOf(path)) return true;
    if (included == "drivers/evdev/event_nodes.h" || included == "drivers/evdev/event_reports.h") return true;
    return isUnder(included, "drivers/usb") || isUnder(included, "drivers/force") ||
           isUnder(included, "drivers/window") || isUnder(included, "drivers/floats") ||
           isUnder(included, "drivers/photo") || isUnder(included, "drivers/inflate");
  }
  if (path.ends_with("/main.cpp") && included == "drivers/registry.h") return true;
  const Room* const room = roomOf(path);
  if (room == nullptr) return false;
  return std::any_of(room->uses.begin(), room->uses.end(), [&](auto used) { return isUnder(included, used); });
}

// Real-time and pure code has no thread, no lock, no clock, no file and no system call of its own.
constexpr std::string_view kImpureHeaders[] = {"thread",   "mutex",      "shared_mutex", "condition_variable",
                                               "future",   "semaphore",  "latch",        "barrier",
                                               "chrono",   "stop_token", "ctime",        "time.h",
                                               "unistd.h", "pthread.h",  "sched.h",      "fcntl.h",
                                               "poll.h",   "signal.h",   "csignal",      "semaphore.h",
                                               "iostream", "fstream",    "filesystem"};
constexpr std::string_view kImpureWords[] = {
    "steady_clock", "system_clock", "high_resolution_clock", "clock_gettime", "std::thread", "std::mutex", "fopen"};

bool isPure(std::string_view path) {
  return isUnder(path, "app/scene") || isUnder(path, "app/haptics");
}

bool isImpureHeader(std::string_view header) {
  return header.starts_with("sys/") || std::ranges::find(kImpureHeaders, header) != std::end(kImpureHeaders);
}

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text;
}

struct Include {
  bool quoted = false;  // "..", not <..>
  std::string name;
};

std::optional<Include> parseInclude(std::string_view line) {
  line = trimmed(line);
  if (!line.starts_with('#')) return std::nullopt;
  line = trimmed(line.substr(1));
  if (!line.starts_with("include")) return std::nullopt;
  line = trimmed(line.substr(7));
  if (!line.starts_with('"') && !line.starts_with('<')) return std::nullopt;
  const bool quoted = line.front() == '"';
  line.remove_prefix(1);
  return Include{quoted, std::string(line.substr(0, line.find(quoted ? '"' : '>')))};
}

// The offences of one file against the layers. `path` is from the project's root.
std::vector<std::string> offences(const std::string& path, const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const auto report = [&](const std::string& what) {
      found.push_back(path + ":" + std::to_string(number) + ": " + what);
    };
    if (const auto include = parseInclude(line)) {
      if (include->quoted && !mayInclude(path, include->name)) report("may not include " + include->name);
      const bool offline = isUnder(path, "app/enhance") || isUnder(path, "app/estimate") ||
                           (isUnder(path, "app/stereo") && !isUnder(path, "app/stereo/quick"));
      if (include->name.starts_with("opencv2/") && !offline) {
        report("OpenCV is for enhancement and for depth made from views alone");  // not on the box
      }
      if (!include->quoted && isPure(path) && isImpureHeader(include->name)) {
        report("pure code does not include <" + include->name + ">");
      }
      continue;
    }
    const std::string_view code = std::string_view(line).substr(0, line.find("//"));
    for (const std::string_view word : kImpureWords) {
      if (isPure(path) && code.find(word) != code.npos) report("pure code does not use " + std::string(word));
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
      Example{"platform/clock.cpp", "#include \"hal/media/frame.h\"\n"},
      Example{"hal/media/frame.h", "#include \"app/scene/height_field.h\"\n"},
      Example{"hal/display.cpp", "#include \"drivers/egl/egl.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"app/render/gl/scene_renderer.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"drivers/ffmpeg/ffmpeg.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"drivers/registry.h\"\n"},
      Example{"drivers/v4l2/annex_b.cpp", "#include \"drivers/ffmpeg/views/view_layers.h\"\n"},
      Example{"drivers/force/watchdog.cpp", "#include \"drivers/falcon/falcon.h\"\n"},
      Example{"drivers/window/window_remote.cpp", "#include \"drivers/egl/egl.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"egl.h\"\n"},  // not from the root
      Example{"drivers/registry.cpp", "#include \"app/scene/display_volume.h\"\n"},
      Example{"app/scene/height_field.h", "#include \"app/haptics/method/method.h\"\n"},
      Example{"app/scene/height_field.h", "#include <chrono>\n"},
      Example{"app/haptics/task/haptic_task.cpp", "#include \"app/render/relief/stereo.h\"\n"},
      Example{"app/haptics/task/haptic_task.cpp", "#include \"drivers/sim/sim.h\"\n"},
      Example{"app/haptics/task/haptic_task.cpp", "  #  include <thread>\n"},
      Example{"app/haptics/task/haptic_task.cpp", "#include <mutex>\n"},
      Example{"app/haptics/task/haptic_task.cpp", "#include <unistd.h>\n"},
      Example{"app/haptics/task/haptic_task.cpp", "#include <pthread.h>\n"},
      Example{"app/haptics/task/haptic_task.cpp", "auto t = std::chrono::steady_clock::now();\n"},
      Example{"app/render/relief/stereo.cpp", "#include \"app/player/player.h\"\n"},
      Example{"app/cli/options.cpp", "#include \"app/player/setup/options.h\"\n"},
      Example{"app/player/player.cpp", "#include \"app/lab/chart/report.h\"\n"},
      Example{"app/player/touch/haptic_session.cpp", "#include \"app/haptics/baseline/methods.h\"\n"},
      Example{"app/depth_window/touch_plan.h", "#include \"app/haptics/method/felt_surface.h\"\n"},
      Example{"app/haptics/method/relievo_method.cpp", "#include \"app/haptics/baseline/penalty.h\"\n"},
      Example{"app/haptics/task/haptic_task.h", "#include \"app/haptics/baseline/methods.h\"\n"},
      Example{"app/lab/truth/oracle.cpp", "#include \"app/haptics/method/method.h\"\n"},
      Example{"app/render/relief/silhouette.h", "#include \"app/render/gl/gl_objects.h\"\n"},
      Example{"app/player/player.cpp", "#include \"app/enhance/enhancer.h\"\n"},
      Example{"app/enhance/enhancer.cpp", "#include \"app/author/author.h\"\n"},
      Example{"app/render/relief/stereo.cpp", "#include <opencv2/core.hpp>\n"},
      Example{"app/player/player.cpp", "#include \"app/stereo/stereo_depth.h\"\n"},
      Example{"app/player/player.cpp", "#include \"app/estimate/steady_relief.h\"\n"},
      Example{"app/stereo/stereo_depth.cpp", "#include \"app/media/pair_reader.h\"\n"},
      Example{"app/player/player.cpp", "#include \"drivers/registry.h\"\n"},
      Example{"app/player/main.cpp", "#include \"drivers/mock/mock.h\"\n"},
      Example{"app/player/main.cpp", "#include \"tests/support/film.h\"\n"},
      Example{"app/nowhere/file.cpp", "#include \"app/scene/height_field.h\"\n"},  // a folder that is not in the list
  };
  for (const Example& example : bad) {
    EXPECT_THAT(offences(example.path, example.text), SizeIs(1)) << example.path << ": " << example.text;
  }
}

TEST(Layers, WhatIsAllowedIsNotReported) {
  const std::array good = {
      Example{"platform/clock.cpp", "#include \"platform/clock.h\"\n#include <chrono>\n#include <unistd.h>\n"},
      Example{"hal/media/frame.h", "#include \"hal/media/media_time.h\"\n#include \"platform/error.h\"\n"},
      Example{"drivers/egl/egl.cpp", "#include \"drivers/egl/egl.h\"\n#include \"hal/display.h\"\n#include <thread>\n"},
      Example{"drivers/ffmpeg/decoder.cpp", "#include \"drivers/ffmpeg/views/view_pairs.h\"\n"},
      Example{"drivers/falcon/link.h", "#include \"drivers/usb/usb_port.h\"\n"},
      Example{"drivers/egl/egl.h", "#include \"drivers/window/window_input.h\"\n"},
      Example{"drivers/registry.cpp", "#include \"drivers/registry.h\"\n#include \"drivers/egl/egl.h\"\n"},
      Example{"app/scene/height_field.h",
              "#include \"hal/media/frame.h\"\n#include \"platform/error.h\"\n#include <cmath>\n"},
      Example{"app/enhance/cleaning.cpp",
              "#include \"app/scene/depth_calibration.h\"\n#include <opencv2/imgproc.hpp>\n"},
      Example{"app/haptics/task/safety.cpp", "#include \"app/scene/display_volume.h\"\n// no steady_clock here\n"},
      Example{"app/player/main.cpp", "#include \"drivers/registry.h\"\n#include \"app/player/player.h\"\n"},
  };
  for (const Example& example : good) EXPECT_THAT(offences(example.path, example.text), IsEmpty());
}

}  // namespace
