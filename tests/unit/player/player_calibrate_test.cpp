// SPDX-License-Identifier: Apache-2.0
// The spring scale's procedure on a Falcon that is stronger than it is thought to be, and the file that keeps the
// result.
#include "app/player/touch/calibrate.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "app/player/setup/config_file.h"
#include "drivers/falcon/falcon.h"
#include "tests/support/device/falcon_model.h"
#include "tests/support/device/model_port.h"

namespace relievo {
namespace {

class Calibrate : public testing::Test {
 protected:
  Calibrate() { model_.runFirmware(); }
  std::unique_ptr<HapticDevice> falcon(double counts_per_nm) {
    return makeFalcon({.counts_per_nm = counts_per_nm, .watchdog_thread = false},
                      std::make_unique<test::ModelPort>(model_, cable_, clock_), clock_);
  }
  Result<double> measure(HapticDevice& device, const ReadScale& readScale) {
    EXPECT_TRUE(device.open());
    return measureStrength(device, readScale, clock_, false);
  }
  // What a scale shows on a Falcon of so many counts a newton-metre.
  ReadScale scale(double true_counts_per_nm) {
    return [this, true_counts_per_nm](double) {
      return test::FalconModel::forceOf(model_.last().motors, {0, 0, 120}, true_counts_per_nm).z;
    };
  }

  test::FalconModel model_{{}};
  test::Cable cable_;
  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
};

TEST_F(Calibrate, FindsTheTrueScale) {
  const auto device = falcon(6000);
  const auto ratio = measure(*device, scale(9264));
  ASSERT_TRUE(ratio) << ratio.error().message;
  EXPECT_NEAR(6000 / *ratio, 9264, 20);
  EXPECT_EQ(model_.last().motors, falcon::Words{}) << "no force is left";
  EXPECT_EQ(device->state(), HapticDevice::State::Closed);

  const auto again = falcon(6000 / *ratio);
  EXPECT_NEAR(measure(*again, scale(9264)).value(), 1, 0.005);
}

TEST_F(Calibrate, EndsWithoutForceWhenTheUserGivesUpOrTheCableIsPulled) {
  const auto device = falcon(6000);
  EXPECT_EQ(measure(*device, [](double) { return std::nullopt; }).error().code, ErrorCode::Cancelled);
  EXPECT_EQ(model_.last().motors, falcon::Words{});
  const auto pulled = measure(*device, [&](double asked_n) {
    cable_.plugged = asked_n < 3;
    return asked_n;
  });
  EXPECT_EQ(pulled.error().code, ErrorCode::Lost);
}

TEST_F(Calibrate, RefusesReadingsThatCannotBe) {
  const auto device = falcon(6000);
  const ReadScale far_off = [](double) { return 100.0; };
  EXPECT_EQ(measure(*device, far_off).error().code, ErrorCode::InvalidArgument);
  const ReadScale apart = [](double asked_n) { return asked_n > 3.5 ? 8.0 : asked_n; };
  EXPECT_EQ(measure(*device, apart).error().code, ErrorCode::InvalidArgument);
}

TEST(Newtons, AreReadAsPeopleWriteThem) {
  EXPECT_EQ(newtonsIn("2.7"), 2.7);
  EXPECT_EQ(newtonsIn("2,7"), 2.7);
  EXPECT_EQ(newtonsIn(" 3 N "), 3.0);
  for (const char* none : {"", "x", "2.7 kg", "2.7.1", "270 g", "nan", "1e999"}) EXPECT_FALSE(newtonsIn(none)) << none;
}

class Config : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string path = testing::TempDir() + "relievo-config-test.toml";
    std::ofstream(path) << text;
    return path;
  }
};

TEST_F(Config, ReadsWhatIsThere) {
  const auto config = loadConfig(write("# mine\n[falcon]\nfirmware = \"/a b/c.bin\"\ncounts_per_nm = 7000\n"));
  ASSERT_TRUE(config);
  EXPECT_EQ(config->falcon_firmware, "/a b/c.bin");
  EXPECT_EQ(config->falcon_counts_per_nm, 7000);
  EXPECT_FALSE(loadConfig(write(""))->falcon_firmware);
}

TEST_F(Config, NamesTheLineThatIsWrong) {
  const struct {
    const char* text;
    const char* line;
  } cases[] = {{"[falcon]\ncounts_per_nm = \"many\"\n", ":2"},
               {"[falcon]\ncounts_per_nm = 3\n", ":2"},
               {"\n\n[falcn]\n", ":3"},
               {"[falcon]\n\nfirmwre = \"a\"\n", ":3"},
               {"[falcon]\nfirmware = 3\n", ":2"},
               {"falcon = 3\n", ":1"},
               {"[falcon\n", ":1"}};
  for (const auto& each : cases) {
    const auto config = loadConfig(write(each.text));
    ASSERT_FALSE(config) << each.text;
    EXPECT_EQ(config.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_TRUE(config.error().thing.ends_with(each.line)) << each.text << config.error().thing;
  }
  EXPECT_EQ(loadConfig("/nowhere/relievo.toml").error().error.code, ErrorCode::NotFound);
}

TEST_F(Config, ANumberIsSetAndAllElseStays) {
  EXPECT_EQ(withNumber("", "falcon", "counts_per_nm", 7421.5), "[falcon]\ncounts_per_nm = 7421.5\n");
  EXPECT_EQ(withNumber("# a\n[falcon]\n# b\nfirmware = \"f\"\n", "falcon", "counts_per_nm", 9000),
            "# a\n[falcon]\ncounts_per_nm = 9000\n# b\nfirmware = \"f\"\n");
  EXPECT_EQ(withNumber("[falcon]\ncounts_per_nm = 6000  # old\nfirmware = \"f\"\n", "falcon", "counts_per_nm", 9000),
            "[falcon]\ncounts_per_nm = 9000\nfirmware = \"f\"\n");
}

TEST_F(Config, AnInlineTableIsNotSpoiled) {
  for (const char* text : {"falcon = { firmware = \"f\" }\n", "falcon.firmware = \"f\"\n",
                           "falcon = { firmware = \"f\", counts_per_nm = 6000 }\n"}) {
    const std::string path = write(text);
    EXPECT_EQ(setNumber(path, "falcon", "counts_per_nm", 9000).error().error.code, ErrorCode::Unsupported) << text;
    EXPECT_EQ(loadConfig(path)->falcon_firmware, "f");
  }
}

}  // namespace
}  // namespace relievo
