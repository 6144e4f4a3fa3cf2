// SPDX-License-Identifier: Apache-2.0
// A child with the remote: ten thousand keys at random, in simulated time, and seconds of them in real time. A seed
// that fails is printed; it fails again with RELIEVO_SEED set to it. RELIEVO_KEYS sets how many keys the real films get
// in simulated time, RELIEVO_SECONDS for how long in real time, and RELIEVO_FILM names a film that joins them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "drivers/ffmpeg/ffmpeg.h"
#include "hal/key_names.h"
#include "tests/scenario/player_bench.h"
#include "tests/support/film/clip_maker.h"
#include "tests/support/machine/program.h"

namespace relievo {
namespace {

constexpr std::uint16_t kKeys[] = {
    KEY_PLAY,    KEY_PAUSE,      KEY_PLAYPAUSE, KEY_OK,         KEY_ENTER,       KEY_FORWARD,
    KEY_REWIND,  KEY_FORWARD,    KEY_REWIND,    KEY_0,          KEY_3,           KEY_5,
    KEY_9,       KEY_RIGHTBRACE, KEY_LEFTBRACE, KEY_RIGHTBRACE, KEY_LEFTBRACE,   KEY_SLOW,
    KEY_DOT,     KEY_DOT,        KEY_NEXT,      KEY_NEXT,       KEY_PREVIOUS,    KEY_RED,
    KEY_3D_MODE, KEY_BLUE,       KEY_F3,        KEY_F2,         KEY_INFO,        KEY_STOP,
    KEY_BACK,    KEY_PLAY,       KEY_F5,        KEY_VOLUMEUP,   KEY_FASTFORWARD, KEY_FASTFORWARD};

unsigned seedOf(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : static_cast<unsigned>(std::strtoul(text, nullptr, 10));
}

// `count` keys, then what brings any player back to a film that plays; the time when that must have worked.
double pressAtRandom(PlayerBench& bench, std::mt19937& random, int count) {
  std::exponential_distribution<double> wait(1.0 / 0.25);
  std::uniform_real_distribution<double> held(0.02, 1.2);
  double at_s = 0.5;
  for (int i = 0; i < count; ++i) {
    at_s += wait(random);
    bench.press(at_s, kKeys[random() % std::size(kKeys)], held(random));
  }
  bench.press(at_s + 3, KEY_STOP);
  bench.press(at_s + 4, KEY_PLAY);
  return at_s + 5;
}

// A hand that comes down, rests in the surface and strokes it.
void aHand(PlayerBench& bench) {
  bench.haptic.position_mm = [](double t) {
    return glm::dvec3(30 * std::sin(1.3 * t), 20 * std::sin(0.7 * t), 22 + 12 * std::cos(0.9 * t));
  };
}

void expectWell(const PlayerBench& bench, const Outcome<void>& played) {
  ASSERT_TRUE(played) << played.error().thing << ": " << played.error().error.message;
  const auto& states = bench.report.states;
  ASSERT_GE(states.size(), 2u);
  EXPECT_EQ(states[states.size() - 2], PlayerState::Playing) << bench.states();
  EXPECT_EQ(bench.report.pairs.mismatched, 0u);
  EXPECT_LE(bench.report.haptic.max_force_n, 10.0 + 1e-9);
  EXPECT_LE(bench.report.haptic.max_scene_slew_n_per_s, 50.0 + 1e-6);
  EXPECT_EQ(bench.force_left, glm::dvec3(0));
  EXPECT_EQ(bench.report.haptic.allocations, 0u);
}

TEST(RandomRemote, TenThousandKeysOnAListOfManyKindsOfFilms) {
  const unsigned first = seedOf("RELIEVO_SEED", 20'261'122);
  const unsigned rounds = std::getenv("RELIEVO_SEED") == nullptr ? 100 : 1;
  std::uint64_t contact = 0, shown = 0;
  for (unsigned seed = first; seed < first + rounds; ++seed) {
    SCOPED_TRACE("RELIEVO_SEED=" + std::to_string(seed));
    std::mt19937 random(seed);
    PlayerBench bench;
    bench.sources = {{"./long", PlayerBench::film(2000)},
                     {"./short", PlayerBench::film(30)},
                     {"./keys", PlayerBench::film(500)},
                     {"./live", PlayerBench::film(300)},
                     {"./flat", {.tracks = {PlayerBench::colorTrack(200)}}}};
    for (MockTrack& track : bench.sources["./keys"].tracks) track.keyframe_interval = 25;
    bench.sources["./long"].tracks[0].keyframe_interval = 12;
    bench.sources["./long"].tracks[1].keyframe_interval = 7;
    bench.sources["./live"].live = true;
    bench.texts["list.m3u"] = "long\nshort\nmissing\nkeys\nlive\nflat\n";
    bench.config.source.url = "list.m3u";
    bench.config.stays = true;
    aHand(bench);
    bench.config.duration = fromSeconds(pressAtRandom(bench, random, 100));
    expectWell(bench, bench.run());
    contact += bench.report.haptic.contact_ticks;
    shown += bench.report.frames_shown;
    if (testing::Test::HasFailure()) return;
  }
  if (rounds == 1) return;
  EXPECT_GT(contact, 100'000u) << "the hand has felt too little for this to say much";
  EXPECT_GT(shown, 10'000u);
}

// A list of real depth video; nothing where there is none.
std::string realFilms() {
  const std::string cup = std::string(RELIEVO_TEST_DATA) + "/cup/";
  if (!std::filesystem::exists(cup)) return "";
  const std::string film = "#RELIEVO-DEPTH:" + cup + "depth_output.webm\n" + cup + "color_output.webm\n";
  const char* another = std::getenv("RELIEVO_FILM");
  return film + (another == nullptr ? film : std::string(another) + "\n");
}

TEST(RandomRemote, KeysOnRealFilmsJoined) {
  const std::string films = realFilms();
  if (films.empty()) GTEST_SKIP() << "there is no real depth video in " << RELIEVO_TEST_DATA;
  const unsigned seed = seedOf("RELIEVO_SEED", 7);
  SCOPED_TRACE("RELIEVO_SEED=" + std::to_string(seed));
  std::mt19937 random(seed);
  PlayerBench bench;
  bench.make_source = makeFfmpegSource;
  bench.make_decoder = makeFfmpegDecoder;
  bench.texts["list.m3u"] = films;
  bench.config.stays = true;
  bench.config.loop = true;
  bench.config.source.url = "list.m3u";
  aHand(bench);
  const unsigned keys = seedOf("RELIEVO_KEYS", 60);
  bench.config.duration = fromSeconds(pressAtRandom(bench, random, static_cast<int>(keys)));
  expectWell(bench, bench.run());
  EXPECT_GT(bench.report.haptic.contact_ticks, 1000u);
}

// The program with all its threads. Keys that end it, or let it end, are left out: it has to last.
TEST(RandomRemote, SecondsInRealTime) {
  const std::string films = realFilms();
  if (films.empty()) GTEST_SKIP() << "there is no real depth video in " << RELIEVO_TEST_DATA;
  const unsigned seed = seedOf("RELIEVO_SEED", 7), seconds = seedOf("RELIEVO_SECONDS", 6);
  SCOPED_TRACE("RELIEVO_SEED=" + std::to_string(seed));
  std::mt19937 random(seed);
  std::exponential_distribution<double> wait(1.0 / 0.25);
  const test::TemporaryFolder folder;
  std::ofstream(folder / "list.m3u") << films;
  {
    std::ofstream script(folder / "keys.txt");
    for (double at_s = 0.5; at_s < seconds - 2.5; at_s += wait(random)) {
      const std::uint16_t key = kKeys[random() % std::size(kKeys)];
      if (key != KEY_STOP && key != KEY_BACK && key != KEY_RED) script << at_s << " " << keyName(key) << "\n";
    }
    script << seconds - 2 << " PREVIOUS\n" << seconds - 1.5 << " PLAY\n";
  }
  const auto played = test::runProgram(
      "relievo play --display offscreen --loop --haptic sim:phantom,stroking --remote script:" + folder / "keys.txt" +
          " --duration " + std::to_string(seconds) + " --report " + folder / "r.json" + " --record " +
          folder / "t.csv " + folder / "list.m3u",
      folder / "");
  ASSERT_EQ(played.exit_code, 0) << played.err;
  std::ifstream file(folder / "r.json");
  const auto report = nlohmann::json::parse(file, nullptr, false);
  ASSERT_TRUE(report.is_object());
  std::cout << report["haptic"].dump() << "\n";
  EXPECT_EQ(report["video"]["pairs_mismatched"], 0);
  EXPECT_GT(report["video"]["frames_shown"], 0);  // how many depends on the load of the machine
  EXPECT_GT(report["haptic"]["contact_share"], 0.05);
  EXPECT_LE(report["force"]["max_n"], 10.0 + 1e-6);
  EXPECT_LE(report["force"]["max_scene_slew_n_per_s"], 50.0 + 1e-6);
  EXPECT_EQ(report["haptic"]["allocations"], 0);
}

}  // namespace
}  // namespace relievo
