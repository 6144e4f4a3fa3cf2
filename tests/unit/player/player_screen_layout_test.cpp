// SPDX-License-Identifier: Apache-2.0
// Where libass puts the display's words: inside the view, none over another, in views of every size and shape.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "app/player/control/key_table.h"
#include "app/player/screen/bar_script.h"
#include "app/player/screen/keys_script.h"
#include "app/player/screen/screen_script.h"
#include "app/render/text/ass_text.h"
#include "tests/support/film/long_names.h"

namespace relievo {
namespace {

struct Words {
  std::string line;
  int left = 1 << 20, top = 1 << 20, right = 0, bottom = 0;
};

class ScreenLayout : public testing::TestWithParam<TextFrame> {
 protected:
  void SetUp() override {
    auto made = AssText::create();
    if (!made) GTEST_SKIP() << made.error().message;
    text_.emplace(std::move(*made));
  }
  // The letters of each text, drawn alone. Shapes are left out.
  std::vector<Words> inkOf(const std::vector<std::string>& lines) {
    std::vector<Words> all;
    for (const std::string& line : lines) {
      if (line.find("\\p1}") != std::string::npos) continue;
      text_->begin(screenHead(GetParam().aspect));
      text_->add(line, Duration(0), std::chrono::hours(1));
      std::vector<TextPicture> pictures;
      text_->draw(GetParam(), Duration(0), pictures, true);
      Words words{.line = line};
      for (const TextPicture& picture : pictures) grow(words, picture);
      all.push_back(std::move(words));
    }
    return all;
  }
  // Without the black outline, which may lie over that of the next line.
  static void grow(Words& words, const TextPicture& picture) {
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* rgba = &picture.rgba[4 * (static_cast<std::size_t>(y) * picture.width + x)];
        if (std::max({rgba[0], rgba[1], rgba[2]}) < 64) continue;
        words.left = std::min(words.left, picture.x + x);
        words.top = std::min(words.top, picture.y + y);
        words.right = std::max(words.right, picture.x + x + 1);
        words.bottom = std::max(words.bottom, picture.y + y + 1);
      }
    }
  }
  void expectApart(const std::vector<Words>& all) const {
    for (auto a = all.begin(); a != all.end(); ++a) {
      EXPECT_TRUE(a->left >= 0 && a->top >= 0 && a->right <= GetParam().width && a->bottom <= GetParam().height)
          << a->line << " is not all in the view: " << a->left << ".." << a->right << ", " << a->top << ".."
          << a->bottom;
      for (auto b = a + 1; b != all.end(); ++b) {
        const bool apart = a->right <= b->left || b->right <= a->left || a->bottom <= b->top || b->bottom <= a->top;
        EXPECT_TRUE(apart) << a->line << "\n  and\n" << b->line;
      }
    }
  }
  void expectApart(const ScreenContent& content) {
    std::vector<std::string> lines = screenLines(content, GetParam().aspect, GetParam().height);
    for (std::string& line : linesOverPosters(content, GetParam().aspect)) lines.push_back(std::move(line));
    const auto words = inkOf(lines);
    EXPECT_GT(words.size(), 2u);
    expectApart(words);
  }
  // The size of a line's letters in the view; of a shape more than any.
  [[nodiscard]] double pixelsOf(const std::string& line) const {
    const std::size_t at = line.find("\\fs");
    return at == std::string::npos ? 1e9 : std::strtod(line.c_str() + at + 3, nullptr) * GetParam().height / 720;
  }
  static constexpr const char* kKeyColor = "&H47C7FF&";
  [[nodiscard]] bool narrow() const { return GetParam().aspect < 0.9; }

  std::optional<AssText> text_;
};

TEST_P(ScreenLayout, AFilmsWordsDoNotMeet) {
  for (const char* title : {"film.mkv", test::kLongName, test::kJapaneseName, test::kArabicName}) {
    ScreenContent content;
    content.bar = ScreenBar{.title = title,
                            .times = "1:01:23 / 1:02:05   paused   1/8x   film 12 of 345   repeat",
                            .status = "3D: mono   no depth in this film, nothing to feel",
                            .has_length = true,
                            .pointed = 0.999,
                            .pointed_time = "1:02:00"};
    content.forces_n = {9.9, 9.8};
    content.notice = ScreenNotice{std::string("Saved /home/somebody/Pictures/") + title, 0.5};
    content.warning = std::string(title) + ": not one picture of its video could be decoded; it is empty or damaged";
    content.hint = "Press into the picture to feel it.  h: all keys";
    expectApart(content);
    content.hint.clear();
    content.warning.clear();
    content.statistics = {{"rate", "29.9 of 30.00 frames/s, 0 dropped"},
                          {"picture", "1920x1080 h264, depth 1920x1080 h264"},
                          {"tracks", "sound eng [deu] jpn fra, subtitles eng deu [ara] jpn fra"},
                          {"decoder", "ffmpeg"},
                          {"drawing", "12.3 ms, 12345 triangles, error 0.50 px"},
                          {"tick", "1000 Hz, 12.3 us, 99.9 % under 45.6 us, 0 missed"},
                          {"force", "1.23 N, at most 4.56 N"}};
    expectApart(content);
  }
}

TEST_P(ScreenLayout, TheListsWordsDoNotMeet) {
  ScreenContent content;
  content.list =
      ScreenList{.rows = {{.title = "Recent", .top = 80},
                          {.title = "broken", .film = 0, .top = 126, .in_poster = "cannot be read"},
                          {.title = test::kLongName, .detail = "12:31 of 1:02:10   Holidays", .film = 1, .top = 222},
                          {.title = test::kJapaneseName, .film = 2, .top = 318},
                          {.title = test::kArabicName, .film = 3, .top = 414}},
                 .selected = 1,
                 .films = 100};
  if (!narrow()) content.notice = ScreenNotice{"Show stereo as frame-packing for a screen that takes it", 0.5};
  expectApart(content);
  content.notice.reset();
  content.warning = std::string(test::kLongName) + ": cannot be read";
  expectApart(content);
}

TEST_P(ScreenLayout, ThePageOfKeysHasEveryWordOfEveryKey) {
  for (const KeyBoard held : {KeyBoard::Keyboard, KeyBoard::Remote}) {
    for (const PlayerState state : {PlayerState::Playing, PlayerState::Browsing}) {
      ScreenContent content;
      content.keys = mouseRows(state == PlayerState::Browsing, true);
      for (auto& row : KeyTable::usual().rowsIn(state, held)) content.keys.push_back(std::move(row));
      if (!narrow()) content.notice = ScreenNotice{"Volume 100 %", 0.5};
      content.help_key = "Help or Menu";
      std::size_t shown = 0;
      const std::size_t pages = keyPages(content.keys, GetParam().aspect, GetParam().height);
      EXPECT_LE(pages, GetParam().height < 300 ? 8u : narrow() ? 2u : GetParam().height < 720 ? 2u : 1u);
      for (; content.keys_page < pages; ++content.keys_page) {
        for (const std::string& line : screenLines(content, GetParam().aspect, GetParam().height)) {
          EXPECT_EQ(line.find("…"), std::string::npos) << line;
          if (line.find(kKeyColor) != std::string::npos) ++shown;
          EXPECT_GE(line.ends_with("Volume 100 %") ? 11.0 : pixelsOf(line), 10.9) << line;
        }
        expectApart(content);
      }
      EXPECT_GE(shown, content.keys.size());
    }
  }
}

// Subtitles are lifted to where the bar's ground begins, which is above all its words and below those of the force.
TEST_P(ScreenLayout, NothingOfTheBarIsInTheSubtitlesRoom) {
  ScreenContent content;
  EXPECT_EQ(roomForWords(content, GetParam().aspect), 1);
  content.bar = ScreenBar{.title = test::kLongName,
                          .times = "0:01",
                          .status = "3D: mono   touch: Novint Falcon",
                          .has_length = true,
                          .pointed = 0.5,
                          .pointed_time = "1"};
  content.forces_n = {9.9, 9.8};
  const double room = roomForWords(content, GetParam().aspect) * GetParam().height;
  EXPECT_GT(room, 0.6 * GetParam().height);
  for (const Words& words : inkOf(screenLines(content, GetParam().aspect))) {
    const bool force = words.line.ends_with(" N") || words.line.find("\\an6\\") != std::string::npos;
    if (force) EXPECT_LE(words.bottom, room) << words.line;
    else EXPECT_GE(words.top, room) << words.line;
  }
}

// As many as a film can have. Each word lies in the place that takes its click.
TEST_P(ScreenLayout, TheBarsButtonsMeetNoOtherWord) {
  using enum PlayerVerb;
  const std::vector<ScreenButton> all{{PlayPause, "Pause"},  {Next, "Next"},         {SubtitleTrack, "Subtitles"},
                                      {AudioTrack, "Sound"}, {Layout, "3D"},         {FullScreen, "Full screen"},
                                      {Back, "Films"},       {PlayerVerb::Keys, "?"}};
  for (const char* title : {"", "film.mkv", test::kLongName}) {
    for (const std::size_t count : {std::size_t{4}, all.size()}) {
      ScreenContent content;
      content.bar = ScreenBar{.title = title,
                              .times = "1:01:23 / 1:02:05   paused   1/8x   film 12 of 345   repeat",
                              .status = "3D: mono   no depth in this film, nothing to feel",
                              .has_length = true,
                              .pointed = 0.999,
                              .pointed_time = "1:02:00",
                              .buttons = {all.end() - static_cast<std::ptrdiff_t>(count), all.end()},
                              .pointed_button = FullScreen};
      content.forces_n = {9.9, 9.8};
      expectApart(content);
      for (const Words& words : inkOf(screenLines(content, GetParam().aspect))) {
        const auto button = std::ranges::find_if(
            content.bar->buttons, [&](const ScreenButton& each) { return words.line.ends_with("}" + each.word); });
        if (button == content.bar->buttons.end()) continue;
        for (const double x : {words.left + 0.5, words.right - 0.5}) {
          EXPECT_EQ(
              barButtonAt(*content.bar, x / GetParam().width, (words.top + 0.5) / GetParam().height, GetParam().aspect),
              button->verb)
              << button->word;
        }
      }
    }
  }
}

constexpr double kWide = 16.0 / 9;
INSTANTIATE_TEST_SUITE_P(Views, ScreenLayout,
                         testing::Values(TextFrame{.width = 1280, .height = 720, .aspect = kWide},
                                         TextFrame{.width = 3840, .height = 2160, .aspect = kWide},
                                         TextFrame{.width = 640, .height = 720, .aspect = kWide},
                                         TextFrame{.width = 1280, .height = 360, .aspect = kWide},
                                         TextFrame{.width = 640, .height = 480, .aspect = 4.0 / 3},
                                         TextFrame{.width = 1920, .height = 817, .aspect = 2.35},
                                         TextFrame{.width = 600, .height = 600, .aspect = 1},
                                         TextFrame{.width = 320, .height = 240, .aspect = 4.0 / 3},
                                         TextFrame{.width = 640, .height = 360, .aspect = kWide},
                                         TextFrame{.width = 405, .height = 720, .aspect = 9.0 / 16}));

}  // namespace
}  // namespace relievo
