// SPDX-License-Identifier: Apache-2.0
// The area that the letters of a subtitle line cover, against areas that were computed by hand.
#include "app/render/text/letter_area.h"

#include <gtest/gtest.h>

#include <cstdarg>
#include <memory>
#include <string>

namespace relievo {
namespace {

constexpr const char* kHead =
    "[Script Info]\nPlayResY: 100\n[V4+ Styles]\n"
    "Format: Name, Fontsize, ScaleX, ScaleY, Spacing, Outline\n"
    "Style: Default,20,100,100,0,0\n"
    "Style: Huge,500,100,200,0,0\n"
    "Style: Edged,20,100,100,0,15\n";

// In squares of 100 of the script's pixels.
double areaOf(const std::string& text, const std::string& style = "Default", const std::string& head = kHead) {
  const std::unique_ptr<ASS_Library, decltype(&ass_library_done)> library(ass_library_init(), ass_library_done);
  const std::unique_ptr<ASS_Track, decltype(&ass_free_track)> script(ass_new_track(library.get()), ass_free_track);
  ass_set_message_cb(library.get(), [](int, const char*, va_list, void*) {}, nullptr);
  std::string copy = head, line = "0,0," + style + ",,0,0,0,," + text;
  ass_process_codec_private(script.get(), copy.data(), static_cast<int>(copy.size()));
  ass_process_chunk(script.get(), line.data(), static_cast<int>(line.size()), 0, 1000);
  EXPECT_EQ(script->n_events, 1);
  return letterArea(script->events[0], *script);
}

TEST(LetterArea, IsOfAllLettersOfTheLine) {
  EXPECT_NEAR(areaOf("a"), 0.04, 1e-9);
  EXPECT_NEAR(areaOf("ab c"), 0.16, 1e-9);
  EXPECT_NEAR(areaOf("\xC3\xA4\xE4\xB8\xAD"), 0.08, 1e-9) << "two letters in five bytes";
  EXPECT_NEAR(areaOf("{a comment}a{\\fs40}b"), 0.04 + 0.16, 1e-9);
  EXPECT_NEAR(areaOf("a", "Huge"), 5 * 10, 1e-9);
  EXPECT_NEAR(areaOf("a", "Edged"), 0.5 * 0.5, 1e-9);
  // libass's own style: of 18, with an outline of 2, of 288 lines.
  EXPECT_NEAR(areaOf("a", "Default", "[Script Info]\nScaledBorderAndShadow: yes\n"), 22 * 22 / (288.0 * 288), 1e-9);
  EXPECT_NEAR(areaOf("a", "Default", "[Script Info]\nPlayResY: 48000\nScaledBorderAndShadow: no\n"),
              418 * 418 / 48000.0 / 48000, 1e-9)
      << "an outline that is as wide on each screen, of 480 lines or more";
}

TEST(LetterArea, FollowsEachTagThatChangesTheirSize) {
  EXPECT_NEAR(areaOf("{\\fs 500}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs(500)}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs+40}a"), 1, 1e-9) << "by 40 tenths more";
  EXPECT_NEAR(areaOf("{\\fs+40\\fs+40}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs9\\fs}a", "Huge"), 50, 1e-9) << "back to the style's";
  EXPECT_NEAR(areaOf("{\\fscx1000\\fscy500}a"), 2, 1e-9);
  EXPECT_NEAR(areaOf("{\\fsp2000}ab"), 2 * 20 * 0.2, 1e-9);
  EXPECT_NEAR(areaOf("{\\bord40}a"), 1, 1e-9);
  EXPECT_NEAR(areaOf("{\\ybord40}a"), 1, 1e-9);
  EXPECT_NEAR(areaOf("{\\fax9}a"), 2 * 0.2, 1e-9);
  EXPECT_GT(areaOf("{\\fs1e999}a"), 1e9);
  EXPECT_NEAR(areaOf("{\\pos(500,500)\\blur3}a"), 0.04, 1e-9) << "another tag";
}

TEST(LetterArea, ATransformCountsWithItsLargerEnd) {
  EXPECT_NEAR(areaOf("{\\t(0,500,\\fs500)}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs500\\t(0,500,\\fs10)}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs500}{\\fs10}a"), 0.01, 1e-9) << "nothing was written so large";
}

TEST(LetterArea, AnotherStyleIsTakenByItsName) {
  EXPECT_NEAR(areaOf("{\\rHuge}a{\\r}b"), 50 + 0.04, 1e-9);
  EXPECT_NEAR(areaOf("{\\rNone}a"), 0.04, 1e-9);
}

TEST(LetterArea, OfADrawingItIsToItsFarthestPoint) {
  EXPECT_NEAR(areaOf("{\\p1}m 0 0 l 300 -400 50 50"), 16, 1e-9);
  EXPECT_NEAR(areaOf("{\\p3}m 0 0 l 4e2 0"), 1, 1e-9) << "in quarters of a pixel";
  EXPECT_NEAR(areaOf("{\\p1e9}m 0 0 l 400 0"), 16, 1e-9) << "a unit of one";
  EXPECT_NEAR(areaOf("{\\p33}m 0 0 l 400 0"), 16, 1e-9) << "it is shifted by the last five bits of 32";
  EXPECT_NEAR(areaOf("{\\p0.5}a"), 0.04, 1e-9) << "no drawing";
  EXPECT_NEAR(areaOf("{\\p1\\fscx200}m 0 0 l 100 100{\\p0}a"), 2 + 0.08, 1e-9);
  EXPECT_NEAR(areaOf("{\\p1\\r}m 0 0 l 100 100"), 1, 1e-9) << "it stays one";
}

TEST(LetterArea, AClipByADrawingCountsAsThatDrawing) {
  EXPECT_NEAR(areaOf("{\\clip(m 0 0 l 90000 0 90000 20000 0 20000)}a"), 900.0 * 900 + 0.04, 1e-6);
  EXPECT_NEAR(areaOf("{\\iclip(m 0 0 l 300 0 300 -400)}a"), 16 + 0.04, 1e-9);
  EXPECT_NEAR(areaOf("{\\clip(3, m 0 0 l 800 0 800 100)}a"), 4 + 0.04, 1e-9) << "in quarters of a pixel";
  EXPECT_NEAR(areaOf("{\\clip(m 0 0 l 400 0 \\,,,)}a"), 16 + 0.04, 1e-9) << "behind a backslash no argument ends";
  EXPECT_NEAR(areaOf("{\\clip(, ,,m 0 0 l 400 0)}a"), 16 + 0.04, 1e-9) << "empty arguments do not count";
  EXPECT_NEAR(areaOf("{\\clip(1e9,m 0 0 l 400 0)}a"), 16 + 0.04, 1e-9) << "a unit of one";
  EXPECT_NEAR(areaOf("{\\clip(0,0,90000,90000)}a"), 0.04, 1e-9) << "a rectangle";
  EXPECT_NEAR(areaOf("{\\iclip(0,0,90000,90000)\\fs40}a"), 0.16, 1e-9) << "what follows it";
}

TEST(LetterArea, ABracketThatOpensNoBlockIsALetter) {
  EXPECT_NEAR(areaOf("{\\fs500}{Cd"), 3 * 25, 1e-9) << "it is not closed";
  EXPECT_NEAR(areaOf("{"), 0.04, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs500}a{"), 2 * 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs500}\\{Cd}"), 5 * 25, 1e-9) << "behind a backslash, which counts, too";
  EXPECT_NEAR(areaOf("{\\p1}m 0 0 l 100 100\\{\\p0}a"), 1 + 0.04, 1e-9) << "not in a drawing";
}

TEST(LetterArea, ASizeOfNothingOrLessIsTheStyles) {
  EXPECT_NEAR(areaOf("{\\fs0}a", "Huge"), 50, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs-10}a", "Huge"), 50, 1e-9) << "ten tenths less";
  EXPECT_NEAR(areaOf("{\\fs-15}a", "Huge"), 50, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs-5}a"), 0.01, 1e-9) << "half of it";
  EXPECT_NEAR(areaOf("{\\t(0,500,\\fs0)}a", "Huge"), 50, 1e-9);
}

TEST(LetterArea, TagsInTheBracketsOfAnotherTagAreNone) {
  EXPECT_NEAR(areaOf("{\\fs500\\pos(1,2\\fs10)}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs500\\(fs10)}a"), 25, 1e-9);
  EXPECT_NEAR(areaOf("{\\fs500\\t (0,500,\\fs10)}a"), 25, 1e-9) << "but in those of a transform";
}

}  // namespace
}  // namespace relievo
