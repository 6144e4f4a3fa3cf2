// SPDX-License-Identifier: Apache-2.0
// Any text as a recording's name, and as the file that its own program left beside it: the settings that are read from
// them are valid.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "app/media/reading/recording_place.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

void check(const RecordingPlace& place) {
  if (place.kind == nullptr) {
    require(place.settings.empty(), "settings only of a known kind");
    return;
  }
  const KnownKind* const listed = findKind(place.kind->name);
  require(place.own ? place.own.get() == place.kind && listed != nullptr : listed == place.kind,
          "a kind that --as has, or one of its own by that name");
  require(!place.why.empty(), "a kind is explained");
  std::string settings;
  for (const auto& [key, value] : place.settings) settings += (settings.empty() ? "" : ",") + key + "=" + value;
  require(settings.empty() || parseCalibration(settings).has_value(), "settings that a calibration may have");
}

// A folder for this run, two levels below the folder that is removed at the end, because the search for a scale also
// looks in the folders above.
class Scratch {
 public:
  Scratch() {
    std::array<char, 32> pattern{"/tmp/recording-fuzz-XXXXXX"};
    if (::mkdtemp(pattern.data()) == nullptr) std::abort();
    root_ = pattern.data();
    fs::create_directories(folder());
    fs::create_directories(meta());
    std::atexit([] { fs::remove_all(root_); });
  }
  [[nodiscard]] static fs::path folder() { return fs::path(root_) / "a" / "b"; }
  // Of a LeRobot data set whose camera is "b".
  [[nodiscard]] static fs::path meta() { return fs::path(root_) / "a" / "meta"; }

 private:
  static inline std::string root_;
};

std::string fileName(std::string_view text) {
  constexpr std::size_t kLongest = 100;
  std::string name(text.substr(0, kLongest));
  std::ranges::replace(name, '/', '_');
  std::ranges::replace(name, '\0', '_');
  return name.empty() || name == "." || name == ".." ? "x" : name;
}

// The first line is the film's name, the next letter the file beside it, the rest what that file says.
void fuzz(std::string_view text) {
  static const Scratch scratch;
  const std::size_t end = std::min(text.find('\n'), text.size());
  const fs::path film = Scratch::folder() / fileName(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  const char which = text.empty() ? 'n' : text.front();
  text.remove_prefix(text.empty() ? 0 : 1);

  check(lookAtTags({{"COMMENT", std::string(text)}}));
  fs::path beside = film;
  if (which == 't') beside.replace_extension(".txt");
  if (which == 'j') beside.replace_extension(".json");
  if (which == 'c') beside = Scratch::folder().parent_path() / "camera.json";
  if (which == 's') beside = Scratch::folder() / "scene_camera.json";
  if (which == 'l') beside = Scratch::meta() / "info.json";
  std::ofstream(beside, std::ios::binary) << text;
  check(lookAtPlace(film, ""));
  check(lookAtPlace("", film));
  fs::remove(beside);
}

}  // namespace
}  // namespace relievo

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  relievo::fuzz({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
