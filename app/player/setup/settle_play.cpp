// SPDX-License-Identifier: Apache-2.0
// The default devices of a window differ from those of a screen; off screen there are neither.
#include "app/player/setup/settle_play.h"

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

#include "app/player/user_folder.h"
#include "platform/named_folder.h"

namespace relievo {
namespace {

bool has(const std::function<bool()>& thing) {
  return thing && thing();
}

void settleDisplay(PlayOptions& play, const Machine& machine) {
  if (!play.display.word.empty()) return;
  play.display = has(machine.desktop) ? "window" : has(machine.screen) ? "kms" : "offscreen";
}

// "none" beside a device is one finger.
void settleFingers(PlayOptions& play) {
  if (play.second_haptic.plain("none")) play.second_haptic = {};
  if (play.haptic.plain("none") && !play.second_haptic.word.empty())
    play.haptic = std::exchange(play.second_haptic, {});
}

// A device that both fingers name is given the forces of both. Named without a path, two are found for two fingers.
bool isOneDevice(const PlayOptions& play) {
  const bool by_path = play.haptic.withArgument("gamepad") || play.haptic.withArgument("pointer");
  return by_path && play.haptic == play.second_haptic;
}

// A window comes with its keys and its mouse; other displays do not have them. A whole screen is watched from a sofa.
// Whoever sees the film also hears it, and feels it with the available device.
Outcome<void> settleDevices(PlayOptions& play, const Machine& machine, bool chosen) {
  const bool window = play.display.plain("window");
  const bool seen = window || play.display.word == "kms";
  settleFingers(play);
  if (play.haptic.word.empty()) {
    play.haptic = !seen ? "sim" : machine.haptic ? machine.haptic() : "";
    if (play.haptic.word.empty()) play.haptic = "pointer";
  }
  if (play.remote.word.empty())
    play.remote = window ? "window" : seen ? "evdev" : has(machine.terminal) ? "keys" : "none";
  if (play.audio.word.empty()) play.audio = seen ? "alsa" : "none";
  for (BackEndName* const finger : {&play.haptic, &play.second_haptic}) {
    if (window && finger->plain("pointer")) finger->argument = "window";
  }
  play.player.has_mouse = window;
  play.player.mouse_touches = play.haptic.with("pointer", "window") || play.second_haptic.with("pointer", "window");
  const bool typed = play.remote.plain("window") || play.remote.plain("keys");
  play.player.held = typed ? KeyBoard::Keyboard : KeyBoard::Remote;
  const auto none = [](const std::string& thing) {
    return failOn(thing, {ErrorCode::InvalidArgument, 0, "there is no window; add --display window"});
  };
  if (!window && play.remote.plain("window")) return none("--remote window");
  if (!window && play.player.mouse_touches) return none("--haptic pointer:window");
  if (isOneDevice(play)) {
    return failOn("--haptic " + play.haptic.text(),
                  {ErrorCode::InvalidArgument, 0, "is given twice, but is one device; leave one out, or name another"});
  }
  play.player.unseen = !chosen && !seen;
  return {};
}

// A television that supports the signal shows the two pictures as one; otherwise a picture of two halves is still
// shown. In the signals for two halves, each eye has half the size.
void settleSignal(PlayOptions& play) {
  DisplayConfig& display = play.player.display;
  const StereoSettings& stereo = play.player.stereo;
  if (play.tv_signal) {
    display.stereo = *play.tv_signal;
    display.other_stereo = display.stereo != StereoSignal::None;
  } else if (stereo.layout == StereoLayout::FramePacking) {
    display.stereo = StereoSignal::FramePacking;
    display.other_stereo = true;
  } else if (stereo.layout == StereoLayout::SideBySide && !stereo.full) {
    display.stereo = StereoSignal::SideBySideHalf;
  } else if (stereo.layout == StereoLayout::TopBottom && !stereo.full) {
    display.stereo = StereoSignal::TopAndBottom;
  }
  // Off screen any size can be had: that of the usual 1280x720 as HDMI packs it.
  const bool any_size = play.display.word == "offscreen" && display.film_size;
  if (any_size && stereo.layout == StereoLayout::FramePacking) display.height = 1470;
}

std::string usualFilms() {
  if (const auto xdg = userFolder("XDG_VIDEOS_DIR"); !xdg.empty()) return xdg;
  if (const auto home = namedFolder("HOME"); !home.empty()) return home / "Videos";
  return "/srv/films";
}

// POSIX, Environment Variables 8.2: which of them holds for messages.
std::string desktopLanguage() {
  for (const char* const name : {"LC_ALL", "LC_MESSAGES", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value != nullptr && *value != '\0') return value;
  }
  return "";
}

// The list of films needs a visible screen, or programs that know its folders.
void settleBrowser(PlayOptions& play) {
  const bool no_film = play.player.source.url.empty();
  const bool seen = play.display.plain("window") || play.display.word == "kms";
  play.player.faults_in_list = play.from_desktop && seen && !no_film;
  const bool programs_choose = play.player.stays && !play.films.empty();
  if (!(no_film ? seen || !play.films.empty() : programs_choose || play.player.faults_in_list)) return;
  if (play.films.empty()) play.films.push_back(usualFilms());
  play.player.browser = BrowserConfig{.folders = play.films, .takes_drops = play.display.plain("window")};
  // A window has one size for the list and all films.
  if (no_film && play.display.plain("window"))
    play.player.display.fits_desktop = std::exchange(play.player.display.film_size, false);
}

}  // namespace

Outcome<void> settlePlay(PlayOptions& play, const Machine& machine) {
  if (play.print_keys || play.print_states) return {};
  play.player.stays = !play.control_path.empty();
  play.player.source.desktop_language = desktopLanguage();
  play.player.osd = play.osd || play.display.word != "offscreen";  // never in a capture unasked
  const bool chosen = !play.display.word.empty();
  settleDisplay(play, machine);
  settleSignal(play);
  const bool seen = play.display.plain("window") || play.display.word == "kms";
  if (play.player.source.url.empty() && !play.films.empty() && !seen && !play.player.stays) {
    return failOn("--films", {ErrorCode::InvalidArgument, 0,
                              "shows a list, which cannot be seen off screen; use --display window or kms, or add "
                              "--control for a program to choose"});
  }
  settleBrowser(play);
  if (play.player.fault && !play.player.browser) return std::unexpected(*play.player.fault);  // it would not be seen
  if (play.player.source.url.empty() && !play.player.stays && !play.player.browser) {
    return failOn("SOURCE", {ErrorCode::InvalidArgument, 0,
                             "is missing; name a film, as in relievo film.mkv; see relievo --help"});
  }
  return settleDevices(play, machine, chosen);
}

}  // namespace relievo
