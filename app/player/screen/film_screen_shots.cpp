// SPDX-License-Identifier: Apache-2.0
// Screenshots: taken from the next picture that is drawn, named and written by the file writer.
#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include "app/player/png_file.h"
#include "app/player/screen/film_screen.h"
#include "app/player/user_folder.h"
#include "platform/files/answered_place.h"
#include "platform/log.h"
#include "platform/named_folder.h"
#include "platform/print.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

// The desktop's folder of pictures, else the current folder.
fs::path picturesFolder() {
  fs::path told = userFolder("XDG_PICTURES_DIR");
  const fs::path home = namedFolder("HOME");
  if (!told.empty() && isFolder(told)) return told;
  if (!home.empty() && isFolder(home / "Pictures")) return home / "Pictures";
  return ".";
}

// A name of a file has 255 bytes at most; letters of several bytes (UTF-8) stay whole.
std::string shortened(std::string name) {
  constexpr std::size_t kMost = 200;
  if (name.size() <= kMost) return name;
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;
  name.resize(end);
  return name;
}

std::string freeName(const std::string& film) {
  const fs::path folder = picturesFolder();
  const std::string stem = "relievo-" + shortened(fs::path(film).filename().stem().string());
  for (int number = 1;; ++number) {
    const fs::path path = folder / (stem + print("-%04d.png", number));
    if (!isThere(path)) return path.string();
  }
}

// Returns the notice for the viewer.
std::string save(const std::string& film, const Picture::Capture& shot) {
  const std::string path = freeName(film);
  const auto written = writePng(path, shot.width, shot.height, shot.rgb);
  std::string what = written ? "Saved " + path : path + ": " + written.error().message;
  log(written ? LogLevel::Info : LogLevel::Warning, "play", "%s", what.c_str());
  return what;
}

}  // namespace

void FilmScreen::saveScreenshot(const std::string& film) {
  screenshot_film_ = film;
  picture_.capture();
  redraw_ = true;
}

void FilmScreen::writeScreenshot(MonotonicTime now) {
  auto capture = picture_.takeCapture();
  if (!capture) return;
  const auto task = std::make_shared<std::packaged_task<std::string()>>(
      [film = screenshot_film_, shot = std::move(*capture)] { return save(film, shot); });
  if (files_.give("", [task] { (*task)(); })) saving_.push_back(task->get_future());
  else text_.notice({"Not saved: the disk is busy with the screenshots before", std::nullopt}, now);
}

void FilmScreen::noteSaved(MonotonicTime now) {
  while (!saving_.empty() && saving_.front().wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    text_.notice({saving_.front().get(), std::nullopt}, now);
    saving_.pop_front();
  }
}

}  // namespace relievo
