// SPDX-License-Identifier: Apache-2.0
// Recordings in the current and older formats, paths of a finger, and files that are no recordings.
#include "drivers/replay/replay.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace relievo {
namespace {

using testing::HasSubstr;

constexpr const char* kDevice =
    "t_s,hip_x_mm,hip_y_mm,hip_z_mm,device_x_mm,device_y_mm,device_z_mm,buttons,device_present,workspace_min_x_mm,"
    "workspace_min_y_mm,workspace_min_z_mm,workspace_max_x_mm,workspace_max_y_mm,workspace_max_z_mm,peak_force_n,"
    "continuous_force_n,max_stiffness_n_per_mm,rate_hz\n";

Recording parsed(const std::string& csv) {
  auto recording = Recording::parse(csv, "file");
  EXPECT_TRUE(recording) << recording.error().thing << " " << recording.error().error.message;
  return recording ? *recording : Recording{};
}

TEST(Recording, IsTheDeviceThatWasRecorded) {
  const Recording recording = parsed(std::string(kDevice) +
                                     "0,9,9,9,0.30000000000000004,-2e-7,3,5,1,-50,-40,75,50,60,175,8,2.7,0.64,2000\r\n"
                                     "0.0005,9,9,9,4,5,6,0,1,,,,,,,,,,\n");
  ASSERT_EQ(recording.ticks.size(), 2u);
  EXPECT_EQ(recording.ticks[0].position_mm, glm::dvec3(0.1 + 0.2, -2e-7, 3));
  EXPECT_EQ(recording.ticks[0].buttons, 5u);
  EXPECT_EQ(recording.ticks[1].position_mm, glm::dvec3(4, 5, 6));
  const HapticCapabilities& device = recording.capabilities;
  EXPECT_EQ(device.workspace_min_mm, glm::dvec3(-50, -40, 75));
  EXPECT_EQ(device.workspace_max_mm, glm::dvec3(50, 60, 175));
  EXPECT_EQ(device.peak_force_n, 8);
  EXPECT_EQ(device.continuous_force_n, 2.7);
  EXPECT_EQ(device.max_stiffness_n_per_mm, 0.64);
  EXPECT_EQ(device.rate_hz, 2000);
}

// As of a mouse over the window.
TEST(Recording, ADeviceWithoutAWorkspaceIsInTheScene) {
  const Recording recording = parsed(std::string(kDevice) + "0,9,9,9,1,2,3,2,1,,,,,,,8,8,1,1000\n");
  EXPECT_EQ(recording.ticks[0].position_mm, glm::dvec3(1, 2, 3));
  EXPECT_EQ(recording.ticks[0].buttons, 2u);
  EXPECT_TRUE(recording.capabilities.in_scene);
  EXPECT_EQ(recording.capabilities.peak_force_n, 8);
  EXPECT_FALSE(parsed(std::string(kDevice) + "0,9,9,9,1,2,3,2,1,-1,-1,-1,1,1,1,8,8,1,1000\n").capabilities.in_scene);
}

TEST(Recording, WithoutTheDeviceItIsThePathInTheScene) {
  for (const std::string head : {"t_s,hip_x_mm,hip_y_mm,hip_z_mm,proxy_x_mm\n", "t_s,x_mm,y_mm,z_mm,note\n",
                                 "t_s,hip_x_mm,hip_y_mm,hip_z_mm,device_x_mm\n"}) {
    const Recording recording = parsed(head + "0,1,2,3,\n0.00025,4,5,6,\n0.0005,4,5,6,\n");
    EXPECT_EQ(recording.ticks[1].position_mm, glm::dvec3(4, 5, 6));
    EXPECT_TRUE(recording.capabilities.in_scene);
    EXPECT_GT(recording.capabilities.workspace_max_mm.x, 500);
    EXPECT_EQ(recording.capabilities.rate_hz, 4000);
  }
}

TEST(Recording, ADeviceThatCannotBeIsNotTaken) {
  for (const char* device : {"8,2,1,inf", "8,2,1,1e300", "8,2,1,0.5", "inf,2,1,1000", "8,inf,1,1000", "8,2,inf,1000"}) {
    const Recording recording = parsed(std::string(kDevice) + "0,9,9,9,1,2,3,0,1,-1,-1,-1,1,1,1," + device + "\n");
    EXPECT_EQ(recording.ticks[0].position_mm, glm::dvec3(9)) << device;
    EXPECT_EQ(recording.capabilities.rate_hz, 1000) << device;
    EXPECT_EQ(recording.capabilities.peak_force_n, 8.5) << device;
  }
}

TEST(Recording, APathHasAColumnOrderOfItsOwn) {
  EXPECT_EQ(parsed("z_mm,x_mm,y_mm\n3,1,2\n").ticks[0].position_mm, glm::dvec3(1, 2, 3));
  EXPECT_EQ(parsed("z_mm,x_mm,y_mm\n3,1,2\n").capabilities.rate_hz, 1000) << "no time, no rate";
}

struct Wrong {
  std::string csv;
  const char* where;
  const char* what;
};
TEST(Recording, AWrongFileIsRefusedByItsLine) {
  const std::string first = "0,9,9,9,1,2,3,0,1,-1,-1,-1,1,1,1,8,2,1,1000\n";
  for (const Wrong& wrong : {
           Wrong{"", "file:1", "is no recording"},
           Wrong{"0,0,0,0\n", "file:1", "is no recording"},
           Wrong{"t_s,x_mm,z_mm\n0,0,0\n", "file:1", "is no recording"},
           Wrong{"t_s,device_x_mm,device_y_mm,device_z_mm\n0,0,0,0\n", "file:1", "is no recording"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n", "file:2", "has no rows"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,0,0\n", "file:3", "cells"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,0,0,0,0\n", "file:3", "cells"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,0,no,0\n", "file:3", "position"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n0,0,nan,0\n", "file:2", "position"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n0,0,,0\n", "file:2", "position"},
           Wrong{"t_s,x_mm,y_mm,z_mm\n0,0,0,0\n\n", "file:3", "cells"},
           Wrong{kDevice + first + "0,9,9,9,1,2,3,-1,1,,,,,,,,,,\n", "file:3", "buttons"},
           Wrong{kDevice + first + "0,9,9,9,1,2,3,,1,,,,,,,,,,\n", "file:3", "buttons"},
           Wrong{kDevice + first + "0,9,9,9,1,2", "file:3", "cells"},
       }) {
    const auto recording = Recording::parse(wrong.csv, "file");
    ASSERT_FALSE(recording) << wrong.csv;
    EXPECT_EQ(recording.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_EQ(recording.error().thing, wrong.where) << wrong.csv;
    EXPECT_THAT(recording.error().error.message, HasSubstr(wrong.what)) << wrong.csv;
  }
}

TEST(Recording, AMissingFileIsNotFound) {
  EXPECT_EQ(Recording::load("/nonexistent/touch.csv").error().error.code, ErrorCode::NotFound);
}

TEST(Replay, AnswersTickByTickAndStaysAtTheEnd) {
  const auto device = makeReplay(parsed("t_s,x_mm,y_mm,z_mm\n0,1,0,0\n0.001,2,0,0\n0.002,3,0,0\n"));
  for (int opening = 0; opening < 2; ++opening) {
    ASSERT_TRUE(device->open() && device->home() && device->start());
    for (const double x : {1.0, 2.0}) {
      EXPECT_EQ(device->read()->position_mm.x, x);
      EXPECT_TRUE(device->write({0, 0, 5}));
    }
    device->stop();
    ASSERT_TRUE(device->start());
    for (const double x : {3.0, 3.0, 3.0}) EXPECT_EQ(device->read()->position_mm.x, x) << "the position stays";
    device->close();
  }
}

TEST(Replay, WhereTheDeviceDidNotAnswerItDoesNot) {
  const auto device = makeReplay(
      parsed(kDevice + std::string("0,0,0,0,1,2,3,0,1,-1,-1,-1,1,1,1,8,2,1,1000\n0,0,0,0,0,0,0,0,0,,,,,,,,,,\n"
                                   "0,0,0,0,1,2,4,0,1,,,,,,,,,,\n")));
  ASSERT_TRUE(device->open() && device->home() && device->start());
  EXPECT_TRUE(device->read());
  EXPECT_EQ(device->read().error().code, ErrorCode::Io);
  EXPECT_EQ(device->state(), HapticDevice::State::Running);
  EXPECT_EQ(device->read()->position_mm.z, 4);
}

// At 1 kHz: 0, 3 and 9 mm, then a tick without an answer, then 1 mm.
std::vector<double> replayedAt(double rate_hz, int reads) {
  const auto device =
      makeReplay(parsed(std::string(kDevice) + "0,9,9,9,0,0,0,1,1,-50,-40,-75,50,60,175,8,2.7,0.64,1000\n"
                                               "0.001,9,9,9,3,0,0,2,1,,,,,,,,,,\n0.002,9,9,9,9,0,0,3,1,,,,,,,,,,\n"
                                               "0.003,9,9,9,0,0,0,0,0,,,,,,,,,,\n0.004,9,9,9,1,0,0,4,1,,,,,,,,,,\n"));
  EXPECT_TRUE(device->setRate(rate_hz));
  EXPECT_TRUE(device->open() && device->home() && device->start());
  std::vector<double> places;
  for (int i = 0; i < reads; ++i) {
    const auto sample = device->read();
    places.push_back(sample ? sample->position_mm.x : -1);
  }
  return places;
}

TEST(Replay, AtAnotherRateTakesAsLongAndGoesInBetween) {
  using testing::ElementsAre;
  EXPECT_THAT(replayedAt(1000, 6), ElementsAre(0, 3, 9, -1, 1, 1));
  EXPECT_THAT(replayedAt(500, 4), ElementsAre(0, 9, 1, 1));
  EXPECT_THAT(replayedAt(4000, 18), ElementsAre(0, 0.75, 1.5, 2.25, 3, 4.5, 6, 7.5, 9, 9, 9, 9, -1, -1, -1, -1, 1, 1));
}

// A path of 25 places a second, and one of 16000.
TEST(Replay, APathTakesAsLongAsItTook) {
  const auto read = [](const std::string& csv, int times) {
    const auto device = makeReplay(parsed(csv));
    EXPECT_TRUE(device->open() && device->home() && device->start());
    for (int i = 1; i < times; ++i) EXPECT_TRUE(device->read());
    return std::pair(device->capabilities().rate_hz, device->read()->position_mm.x);
  };
  EXPECT_EQ(read("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.04,20,0,0\n0.08,40,0,0\n", 6), std::pair(500.0, 5.0));
  EXPECT_EQ(read("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0.0000625,1,0,0\n0.000125,2,0,0\n", 2), std::pair(8000.0, 2.0));
}

TEST(Replay, KeepsTheRecordedStiffnessAtEveryRate) {
  const auto device = makeReplay(parsed("x_mm,y_mm,z_mm\n1,2,3\n"));
  const double own = device->capabilities().max_stiffness_n_per_mm;
  for (const double hz : {500.0, 8000.0}) {
    ASSERT_EQ(device->setRate(hz).value(), hz);
    EXPECT_EQ(device->capabilities().max_stiffness_n_per_mm, own) << "it has no motors that could swing";
  }
}

}  // namespace
}  // namespace relievo
