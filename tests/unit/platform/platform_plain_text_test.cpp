// SPDX-License-Identifier: Apache-2.0
// Text for people holds no commands for their terminal.
#include "platform/text/plain_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/log.h"

namespace relievo {
namespace {

// A title that would set the terminal's own and go on in red; U+009B begins such a command as well, U+00A0 is a blank.
const std::string kTitle = "a\x1b]0;b\x07\n\x1b[31mc\xc2\x9b\x33\x31md\xc2\xa0\xe6\xb5\xae\x7f\xc2";
const std::string kBlanked = " [31mc  31md\xc2\xa0\xe6\xb5\xae \xc2";

TEST(PlainText, OneLineHoldsNoControlCharacters) {
  EXPECT_EQ(oneLine(kTitle), "a ]0;b  " + kBlanked);
  EXPECT_EQ(oneLine(""), "");
}

TEST(PlainText, WhatIsSaidKeepsItsLinesAndNoOtherControlCharacters) {
  testing::internal::CaptureStdout();
  say(kTitle + "\n");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "a ]0;b \n" + kBlanked + "\n");
}

TEST(PlainText, SoDoesTheLog) {
  testing::internal::CaptureStderr();
  log(LogLevel::Error, "media", "%s.", kTitle.c_str());
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::EndsWith("a ]0;b  " + kBlanked + ".\n"));
}

}  // namespace
}  // namespace relievo
