// SPDX-License-Identifier: Apache-2.0
// Where a film is shown and what touches it, depending on the command line and on the machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "app/player/setup/options.h"
#include "tests/unit/player/setup/player_options.h"

namespace relievo::test {
namespace {

TEST(Options, WithoutADesktopOrAScreenItPlaysOffScreen) {
  const Parsed parsed = parse({"play", "film.mkv"});
  ASSERT_TRUE(parsed.options);
  const PlayOptions& play = parsed.options->play;
  EXPECT_EQ(play.player.source.url, "film.mkv");
  EXPECT_EQ(play.player.source.packing, Packing::Auto);
  EXPECT_EQ(play.player.source.depth_code, std::nullopt);
  EXPECT_EQ(play.player.stereo.layout, StereoLayout::Mono);
  EXPECT_EQ(devicesOf(play), "offscreen sim none none");
  EXPECT_EQ(play.player.display.width, 1280);
  EXPECT_EQ(play.player.display.height, 720);
  EXPECT_FALSE(play.player.duration);
  EXPECT_FALSE(play.player.volume);
  EXPECT_FALSE(play.player.loop);
  EXPECT_TRUE(play.player.own_threads);
  EXPECT_TRUE(play.player.unseen) << "the player says so";
  EXPECT_EQ(parsed.err, "") << "not yet: the film may be missing";
  EXPECT_FALSE(parse({"play", "film.mkv", "--display", "offscreen"}).options->play.player.unseen);
  EXPECT_EQ(parse({"film.mkv"}, machineWith(false, false, "", true)).options->play.remote, "keys");
}

TEST(Options, OnADesktopItTakesAWindowOfTheFilmsSizeAndTheMouse) {
  const Parsed parsed = parse({"film.mkv"}, machineWith(true, true));
  ASSERT_TRUE(parsed.options) << parsed.err;
  EXPECT_EQ(parsed.err, "");
  EXPECT_EQ(devicesOf(parsed.options->play), "window pointer:window window alsa");
  EXPECT_TRUE(parsed.options->play.player.display.film_size);
  EXPECT_FALSE(
      parse({"film.mkv", "--size", "640x360"}, machineWith(true, true)).options->play.player.display.film_size);
}

TEST(Options, TheWindowOfTheListFitsTheDesktopUnlessASizeIsAskedFor) {
  const auto fits = [](const std::vector<const char*>& words) {
    return parse(words, machineWith(true, true)).options->play.player.display.fits_desktop;
  };
  EXPECT_TRUE(fits({}));
  EXPECT_TRUE(fits({"play", "--films", "/films"}));
  EXPECT_FALSE(fits({"play", "--size", "1280x720"}));
  EXPECT_FALSE(fits({"film.mkv"})) << "it takes the film's size";
}

TEST(Options, AScreenHasTheModeThatItPrefersUnlessASizeIsAskedFor) {
  const auto own = [](const std::vector<const char*>& words) {
    return parse(words, machineWith(false, true)).options->play.player.display.film_size;
  };
  EXPECT_TRUE(own({"film.mkv"}));
  EXPECT_TRUE(own({})) << "the list";
  EXPECT_FALSE(own({"film.mkv", "--size", "1280x720"}));
}

TEST(Options, WithoutAFilmAWindowAndAScreenShowTheListOfFilms) {
  ::setenv("HOME", "/home/anna", 1);
  ::unsetenv("XDG_VIDEOS_DIR");
  const auto folders = [](const Machine& machine, const std::vector<const char*>& words) {
    const Parsed parsed = parse(words, machine);
    if (!parsed.options || !parsed.options->play.player.browser) return std::vector<std::string>{"no list"};
    return parsed.options->play.player.browser->folders;
  };
  const std::vector<std::string> none{"no list"};
  EXPECT_EQ(folders(machineWith(true, false), {}), (std::vector<std::string>{"/home/anna/Videos"}));
  EXPECT_EQ(folders(machineWith(false, true), {"play"}), (std::vector<std::string>{"/home/anna/Videos"}));
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "--films", "/b"}),
            (std::vector<std::string>{"/a", "/b"}));
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "film.mkv"}), none) << "it has its film";
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "--from-desktop", "film.mkv"}),
            (std::vector<std::string>{"/a"}))
      << "if the film cannot be played";
  EXPECT_EQ(folders(machineWith(false, false), {"--from-desktop", "film.mkv"}), none) << "cannot be seen off screen";
  EXPECT_EQ(folders(machineWith(true, false), {"--films", "/a", "film.mkv", "--control", "/run/r"}),
            (std::vector<std::string>{"/a"}))
      << "a box shows it after its film";
  EXPECT_EQ(folders(machineWith(false, false), {"--control", "/run/r"}), none) << "cannot be seen off screen";
}

class KeptVariable {
 public:
  explicit KeptVariable(const char* name) : name_(name) {
    if (const char* const value = std::getenv(name)) value_ = value;
  }
  KeptVariable(const KeptVariable&) = delete;
  KeptVariable& operator=(const KeptVariable&) = delete;
  ~KeptVariable() { value_ ? ::setenv(name_, value_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> value_;
};

TEST(Options, TheLanguageIsThatOfTheDesktopsMessages) {
  const KeptVariable all("LC_ALL"), messages("LC_MESSAGES"), lang("LANG");
  const auto language = [] {
    return parse({"film.mkv"}, machineWith(true, true)).options->play.player.source.desktop_language;
  };
  ::unsetenv("LC_ALL");
  ::unsetenv("LC_MESSAGES");
  ::setenv("LANG", "de_DE.UTF-8", 1);
  EXPECT_EQ(language(), "de_DE.UTF-8");
  ::setenv("LC_MESSAGES", "fr_FR.UTF-8", 1);
  EXPECT_EQ(language(), "fr_FR.UTF-8");
  ::setenv("LC_ALL", "", 1);
  EXPECT_EQ(language(), "fr_FR.UTF-8") << "an empty one says nothing";
}

TEST(Options, WithoutADesktopItTakesTheScreen) {
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(false, true)).options->play), "kms pointer evdev alsa");
}

TEST(Options, AForceFeedbackDeviceThatIsPluggedInGoesBeforeTheMouse) {
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(true, true, "falcon")).options->play),
            "window falcon window alsa");
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(false, true, "polhem")).options->play), "kms polhem evdev alsa");
  EXPECT_EQ(devicesOf(parse({"film.mkv"}, machineWith(false, false, "falcon")).options->play),
            "offscreen sim none none");
}

TEST(Options, WhatIsNamedIsNotLookedFor) {
  const Machine nobody{.desktop =
                           [] {
                             ADD_FAILURE();
                             return true;
                           },
                       .screen =
                           [] {
                             ADD_FAILURE();
                             return true;
                           },
                       .haptic =
                           [] {
                             ADD_FAILURE();
                             return std::string("falcon");
                           },
                       .terminal =
                           [] {
                             ADD_FAILURE();
                             return true;
                           }};
  EXPECT_TRUE(parse({"film.mkv", "--display", "window", "--haptic", "none", "--remote", "none"}, nobody).options);
  EXPECT_TRUE(parse({"probe", "film.mkv"}, nobody).options);
  EXPECT_TRUE(parse({"play", "--print-keys"}, nobody).options);
}

TEST(Options, TheRateOfTouchIsTheDevicesUnlessItIsAskedFor) {
  EXPECT_FALSE(parse({"film.mkv"}).options->play.rate_hz);
  for (const char* word : {"500", "1000", "8000"}) {
    EXPECT_EQ(parse({"film.mkv", "--rate", word}).options->play.rate_hz, std::stod(word));
  }
  for (const char* word : {"9000", "499", "0", "-1000", "nan", "fast"}) {
    expectRefused({"film.mkv", "--rate", word}, "--rate");
  }
}

TEST(Options, TheSignalForATelevisionIsThatOfTheLayoutOrTheOneAskedFor) {
  using enum StereoSignal;
  const struct {
    std::vector<const char*> words;
    StereoSignal signal;
    bool or_other;
  } cases[] = {{{}, None, false},
               {{"--stereo", "sbs"}, SideBySideHalf, false},
               {{"--stereo", "tab"}, TopAndBottom, false},
               {{"--stereo", "sbs:full"}, None, false},
               {{"--stereo", "rows"}, None, false},
               {{"--stereo", "frame-packing"}, FramePacking, true},
               {{"--tv-signal", "Frame-Packing"}, FramePacking, true},
               {{"--stereo", "frame-packing", "--tv-signal", "tab"}, TopAndBottom, true},
               {{"--stereo", "sbs", "--size", "1920x1080", "--tv-signal", "sbs"}, SideBySideHalf, true},
               {{"--stereo", "sbs", "--tv-signal", "off"}, None, false}};
  for (auto [words, signal, or_other] : cases) {
    words.insert(words.begin(), {"play", "film.mkv", "--display", "kms"});
    const DisplayConfig display = parse(words).options.value().play.player.display;
    EXPECT_EQ(display.stereo, signal) << words.back();
    EXPECT_EQ(display.other_stereo, or_other) << words.back();
  }
  const auto height = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"play", "film.mkv", "--stereo", "frame-packing", "--display"});
    return parse(words).options.value().play.player.display.height;
  };
  EXPECT_EQ(height({"offscreen"}), 1470);
  EXPECT_EQ(height({"offscreen", "--size", "1920x2205"}), 2205);
  EXPECT_EQ(height({"window"}), 720) << "it has no such size";
  expectRefused({"play", "film.mkv", "--tv-signal", "sbss"}, "did you mean sbs?");
  expectRefused({"play", "film.mkv", "--stereo", "SBSS"}, "did you mean sbs?");
  expectRefused({"play", "film.mkv", "--stereo", "anaglyph:grey"}, "did you mean anaglyph:gray?");
  expectRefused({"play", "film.mkv", "--as", "kiti"}, "did you mean kitti?");
  expectRefused({"play", "film.mkv", "--calibration", "lew=linear"}, "(law?)");
  expectRefused({"play", "film.mkv", "--calibration", "law=linea,near=1"}, "(linear?)");
  expectRefused({"play", "film.mkv", "--material", "stifness=1"}, "(stiffness?)");
  expectRefused({"play", "film.mkv", "--tv-signal", "holo"}, "it is one of: frame-packing tab sbs off");
}

TEST(Options, AWindowBringsItsKeysAndItsMouseAlong) {
  const auto parsedPlay = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"play", "film.mkv"});
    return parse(words).options.value().play;
  };
  EXPECT_EQ(parsedPlay({"--display", "window"}).remote, "window");
  EXPECT_EQ(parsedPlay({"--display", "kms"}).remote, "evdev");
  EXPECT_EQ(parsedPlay({"--display", "kms:/dev/dri/card1"}).remote, "evdev");
  EXPECT_EQ(parsedPlay({"--display", "kms", "--remote", "none"}).remote, "none");
  EXPECT_EQ(parsedPlay({"--display", "window"}).audio, "alsa");
  EXPECT_EQ(parsedPlay({"--display", "kms:/dev/dri/card1"}).audio, "alsa");
  EXPECT_EQ(parsedPlay({"--display", "window", "--audio", "none"}).audio, "none");
  EXPECT_EQ(parsedPlay({"--audio", "alsa:hdmi:CARD=vc4hdmi0"}).audio, "alsa:hdmi:CARD=vc4hdmi0");
  EXPECT_EQ(parsedPlay({"--decoder", "gstreamer:vah264dec"}).decoder, "gstreamer:vah264dec");
  EXPECT_EQ(parsedPlay({"--display", "window"}).haptic, "pointer:window");
  EXPECT_EQ(parsedPlay({"--display", "mock"}).haptic, "sim");
  EXPECT_EQ(parsedPlay({"--display", "window", "--haptic", "pointer"}).haptic, "pointer:window");
  EXPECT_EQ(parsedPlay({"--display", "window", "--haptic", "pointer:/dev/input/event3"}).haptic,
            "pointer:/dev/input/event3");
  EXPECT_EQ(parsedPlay({"--display", "window", "--remote", "none"}).remote, "none");
  EXPECT_EQ(parsedPlay({"--display", "window", "--remote", "window"}).remote, "window");
  EXPECT_EQ(parsedPlay({"--haptic", "pointer"}).haptic, "pointer");
  expectRefused({"play", "film.mkv", "--remote", "window"},
                "--remote window: there is no window; add --display window");
  expectRefused({"play", "film.mkv", "--haptic", "pointer:window"}, "--haptic pointer:window: there is no window");
}

TEST(Options, TakeADeviceForEachOfTwoFingers) {
  const auto parsedPlay = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"play", "film.mkv"});
    return parse(words).options.value().play;
  };
  const PlayOptions both = parsedPlay({"--haptic", "Sim:a.csv", "--haptic", "mock"});
  EXPECT_EQ(both.haptic, "sim:a.csv");
  EXPECT_EQ(both.second_haptic, "mock");
  EXPECT_EQ(parsedPlay({"--haptic", "sim"}).second_haptic, "");
  const PlayOptions window = parsedPlay({"--display", "window", "--haptic", "sim", "--haptic", "pointer"});
  EXPECT_EQ(window.second_haptic, "pointer:window");
  EXPECT_TRUE(window.player.mouse_touches);
  const PlayOptions one = parsedPlay({"--haptic", "none", "--haptic", "mock"});
  EXPECT_EQ(one.haptic, "mock") << "none beside a device is one finger";
  EXPECT_EQ(one.second_haptic, "");
  expectRefused({"play", "film.mkv", "--haptic", "mock", "--haptic", "sim", "--haptic", "none"},
                "--haptic none: is one device too many");
  for (const char* word : {"gamepad:/dev/input/event5", "pointer:/dev/input/event5"}) {
    expectRefused({"play", "film.mkv", "--haptic", word, "--haptic", word}, "is given twice, but is one device");
  }
  expectRefused({"play", "film.mkv", "--display", "window", "--haptic", "pointer", "--haptic", "pointer:window"},
                "--haptic pointer:window: is given twice");
  for (const char* word : {"gamepad", "pointer", "inverse3", "sim", "mock"}) {
    EXPECT_EQ(parsedPlay({"--haptic", word, "--haptic", word}).second_haptic, word) << "two of them";
  }
  expectRefused({"play", "film.mkv", "--haptic", "mock", "--haptic", "hand"}, "no such haptic device");
}

}  // namespace
}  // namespace relievo::test
