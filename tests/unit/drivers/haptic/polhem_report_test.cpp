// SPDX-License-Identifier: Apache-2.0
// The Polhem's wire format and description files.
#include "drivers/polhem/report.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "drivers/polhem/description.h"

namespace relievo::polhem {
namespace {

TEST(PolhemReport, ACommandsBytesAreThoseOfTheBoardsOwnSource) {
  const PaddedReport bytes =
      encode(Command{.motors = {0x0102, -2, 1999}, .verb = Verb::Calibrate, .counts = {6000, -5000, 0x7FFF}});
  const std::array<std::uint8_t, kReportBytes> expected{0x02, 0x01, 0xFE, 0xFF, 0xCF, 0x07, 0x01,
                                                        0x00, 0x70, 0x17, 0x78, 0xEC, 0xFF, 0x7F};
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), bytes.begin()));
  for (std::size_t i = kReportBytes; i < bytes.size(); ++i) EXPECT_EQ(bytes[i], 0) << i;
}

TEST(PolhemReport, AReportsBytesAreThoseOfTheBoardsOwnSource) {
  const std::array<std::uint8_t, kReportBytes> bytes{0x02, 0x01, 0xFE, 0xFF, 0xCF, 0x07, 0x89,
                                                     0x13, 0x70, 0x17, 0x78, 0xEC, 0x01, 0x00};
  const auto report = decodeReport(bytes, kReportBytes);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->arm, (EncoderCounts{0x0102, -2, 1999}));
  EXPECT_EQ(report->grip, (EncoderCounts{5001, 6000, -5000}));
  EXPECT_EQ(report->info, 1);
  EXPECT_TRUE(report->button());
  const PaddedReport back = encode(*report);
  EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), back.begin()));
}

TEST(PolhemReport, OnlyTheLengthOfItsKindIsOne) {
  const std::array<std::uint8_t, kPaddedBytes> bytes{};
  for (std::size_t length = 0; length <= bytes.size(); ++length) {
    const UsbBytes part = UsbBytes(bytes).first(length);
    EXPECT_EQ(decodeReport(part, kReportBytes).has_value(), length == kReportBytes) << length;
    EXPECT_EQ(decodeReport(part, kPaddedBytes).has_value(), length == kPaddedBytes) << length;
    EXPECT_EQ(decodeCommand(part, kReportBytes).has_value(), length == kReportBytes) << length;
  }
  EXPECT_FALSE(decodeReport(UsbBytes(bytes).first(4), 4));
}

class PolhemDescription : public testing::Test {
 protected:
  static std::string textOf(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(RELIEVO_SOURCE_DIR "/drivers/polhem/" + name).rdbuf();
    return text.str();
  }
  // The description with `from` replaced by `to`.
  static Outcome<Description> changed(const std::string& from, const std::string& to) {
    std::string text = textOf("woodenhaptics-2019.json");
    const auto at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    return parseDescription(text.replace(at, from.size(), to), "arm.json");
  }
};

TEST_F(PolhemDescription, TheDefaultIsThatOfItsFile) {
  const Description file = parseDescription(textOf("woodenhaptics-2019.json"), "file").value();
  const Description& built_in = kWoodenHaptics2019;
  EXPECT_EQ(file.variant, built_in.variant);
  EXPECT_EQ(file.diameter_capstan, built_in.diameter_capstan);
  EXPECT_EQ(file.diameter_body, built_in.diameter_body);
  EXPECT_EQ(file.length_body, built_in.length_body);
  EXPECT_EQ(file.workspace_origin, built_in.workspace_origin);
  EXPECT_EQ(file.workspace_radius, built_in.workspace_radius);
  EXPECT_EQ(file.torque_constant, built_in.torque_constant);
  EXPECT_EQ(file.current_for_10_v_signal, built_in.current_for_10_v_signal);
  EXPECT_EQ(file.cpr_encoder, built_in.cpr_encoder);
  EXPECT_EQ(file.max_linear_force, built_in.max_linear_force);
  EXPECT_EQ(file.max_linear_stiffness, built_in.max_linear_stiffness);
  EXPECT_EQ(file.calibrate_enc, built_in.calibrate_enc);
  EXPECT_EQ(file.motor_and_body_aligned, built_in.motor_and_body_aligned);
  EXPECT_EQ(file.max_milliamps, built_in.max_milliamps);
}

TEST_F(PolhemDescription, ReadsWhatDiffersInOthers) {
  const Description polhem = parseDescription(textOf("polhem-1.json"), "file").value();
  EXPECT_EQ(polhem.variant, 2);
  EXPECT_EQ(polhem.length_body, (std::array{0.058, 0.174, 0.133}));
  EXPECT_EQ(polhem.calibrate_enc, (EncoderCounts{0, 0, -5000}));
  EXPECT_EQ(polhem.motor_and_body_aligned, (std::array{true, true, true}));
  const auto milliamps = changed("\"variant\": 0", "\"variant\": 1, \"max_milliamps\": 1500");
  ASSERT_TRUE(milliamps);
  EXPECT_EQ(milliamps->max_milliamps, 1500);
  EXPECT_TRUE(
      changed("\"motor_and_body_aligned_b\": false", "\"motor_and_body_aligned_b\": 1")->motor_and_body_aligned[1]);
}

TEST_F(PolhemDescription, SaysThatVariantThreeIsClosed) {
  const auto refused = changed("\"variant\": 0", "\"variant\": 3");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().error.code, ErrorCode::Unsupported);
  EXPECT_EQ(refused.error().thing, "arm.json");
}

TEST_F(PolhemDescription, NamesTheKeyThatIsWrong) {
  struct Case {
    const char *from, *to, *thing;
  };
  const Case cases[] = {
      {"\"variant\"", "\"Variant\"", "arm.json: variant"},
      {"\"length_body_b\": 0.205", "\"length_body_b\": 205", "arm.json: length_body_b"},
      {"\"torque_constant_motor_a\": 0.321", "\"torque_constant_motor_a\": 0", "arm.json: torque_constant_motor_a"},
      {"\"cpr_encoder_c\": 2000", "\"cpr_encoder_c\": \"2000\"", "arm.json: cpr_encoder_c"},
      {"\"diameter_capstan_a\": 0.01", "\"diameter_capstan_a\": -0.01", "arm.json: diameter_capstan_a"},
      {"\"calibrate_enc_c\": 6000", "\"calibrate_enc_c\": 60000", "arm.json: calibrate_enc_c"},
      {"\"motor_and_body_aligned_a\": false", "\"motor_and_body_aligned_a\": 2", "arm.json: motor_and_body_aligned_a"},
      {"\"variant\": 0", "\"variant\": 0, \"max_milliamps\": 1e9", "arm.json: max_milliamps"},
      {"\"max_linear_force\": 5", "\"max_linear_force\": null", "arm.json: max_linear_force"},
  };
  for (const Case& each : cases) {
    const auto refused = changed(each.from, each.to);
    ASSERT_FALSE(refused) << each.to;
    EXPECT_EQ(refused.error().error.code, ErrorCode::InvalidArgument) << each.to;
    EXPECT_EQ(refused.error().thing, each.thing);
  }
}

TEST_F(PolhemDescription, WhatIsNoJsonObjectIsCorruptAndWhatIsNotThereIsNotFound) {
  for (const char* text : {"", "{", "[]", "3", "{\"variant\": 0", "\xff\xfe"}) {
    const auto refused = parseDescription(text, "arm.json");
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().error.code, ErrorCode::Corrupt) << text;
  }
  EXPECT_EQ(loadDescription("/nonexistent.json").error().error.code, ErrorCode::NotFound);
}

}  // namespace
}  // namespace relievo::polhem
