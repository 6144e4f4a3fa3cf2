// SPDX-License-Identifier: Apache-2.0
// The back ends' names on the command line: each makes its back end, any other is rejected with the list.
#include "drivers/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "drivers/ffmpeg/ffmpeg.h"
#include "hal/media/media_names.h"

namespace relievo::drivers {
namespace {

class Registry : public testing::Test {
 protected:
  static std::string fileWith(const char* name, const char* text) {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << text;
    return path;
  }
  ManualClock clock_;
};

TEST_F(Registry, MakesEachByItsName) {
  EXPECT_STREQ(makeDisplay("offscreen").value()->capabilities().name, "offscreen");
  EXPECT_STREQ(makeDisplay("offscreen:/tmp/a:b.y4m").value()->capabilities().name, "offscreen");
  EXPECT_STREQ(makeDisplay("kms").value()->capabilities().name, "kms");
  EXPECT_EQ(makeDisplay("kms:/dev/null").value()->open({}).error().code, ErrorCode::Unsupported);
  EXPECT_STREQ(makeDisplay("window").value()->capabilities().name, "window");
  EXPECT_STREQ(makeDisplay("mock").value()->capabilities().name, "mock");
  EXPECT_STREQ(makeHapticDevice("falcon", clock_).value()->capabilities().name, "Novint Falcon");
  EXPECT_STREQ(makeHapticDevice("falcon:image.bin", clock_).value()->capabilities().name, "Novint Falcon");
  EXPECT_STREQ(makeHapticDevice("polhem", clock_).value()->capabilities().name, "Polhem");
  EXPECT_STREQ(makeHapticDevice("inverse3", clock_).value()->capabilities().name, "Haply Inverse3");
  EXPECT_STREQ(makeHapticDevice("inverse3:box:81", clock_).value()->capabilities().name, "Haply Inverse3");
  EXPECT_STREQ(makeHapticDevice("sim", clock_).value()->capabilities().name, "sim");
  EXPECT_STREQ(makeHapticDevice("mock", clock_).value()->capabilities().name, "mock");
  EXPECT_STREQ(makeAudioOutput("alsa", clock_).value()->capabilities().name, "alsa");
  EXPECT_STREQ(makeAudioOutput("alsa:hdmi:CARD=0", clock_).value()->capabilities().name, "alsa");
  EXPECT_STREQ(makeAudioOutput("null", clock_).value()->capabilities().name, "null");
  EXPECT_STREQ(makeAudioDecoder()->name(), "ffmpeg");
  EXPECT_NE(makeMediaSource("film.mkv"), nullptr);
  EXPECT_STREQ(makeVideoDecoder({})->capabilities().name, "ffmpeg");
  EXPECT_EQ(makeMediaSource("v4l2:/nonexistent")->open("v4l2:/nonexistent").error().code, ErrorCode::NotFound);
}

TEST_F(Registry, ADecoderMayBeNamed) {
  EXPECT_STREQ(decoderMaker("").value()({})->capabilities().name, "ffmpeg");
  EXPECT_STREQ(decoderMaker("ffmpeg").value()({})->capabilities().name, "ffmpeg");
  EXPECT_STREQ(decoderMaker("v4l2").value()({})->capabilities().name, "v4l2-m2m");
#ifdef RELIEVO_GSTREAMER
  EXPECT_STREQ(decoderMaker("gstreamer").value()({})->capabilities().name, "gstreamer");
  EXPECT_STREQ(decoderMaker("gstreamer:avdec_h264").value()({})->capabilities().name, "gstreamer");
#else
  EXPECT_THAT(decoderMaker("gstreamer").error().error.message, testing::HasSubstr("built without GStreamer"));
#endif
  EXPECT_EQ(decoderMaker("gstreamer:").error().error.code, ErrorCode::InvalidArgument);
  EXPECT_THAT(decoderMaker("vdpau").error().error.message, testing::HasSubstr(kDecoderNames));
}

// Hardware would decode the first of them alone.
TEST_F(Registry, TwoViewsInTwoLayersAreLeftToFfmpeg) {
  StreamInfo stream{.codec = "hevc"};
  for (const char* layers : {"1", "2"}) {
    stream.tags[kLayersTag] = layers;
    const bool both = stream.tags[kLayersTag] == "2" && ffmpegDecodesBothViews();
    EXPECT_STREQ(decoderMaker("v4l2").value()(stream)->capabilities().name, both ? "ffmpeg" : "v4l2-m2m");
  }
}

TEST_F(Registry, AServiceIsAtAHostAndAPort) {
  for (const char* name : {"inverse3:box:", "inverse3:box:0", "inverse3:a b", "inverse3:box:1:2"}) {
    const auto device = makeHapticDevice(name, clock_);
    ASSERT_FALSE(device) << name;
    EXPECT_EQ(device.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_THAT(device.error().error.message, testing::HasSubstr("HOST:PORT"));
  }
}

TEST_F(Registry, NoneIsNoDeviceAndNoError) {
  EXPECT_EQ(makeHapticDevice("none", clock_).value(), nullptr);
  EXPECT_EQ(makeRemoteInput("none", clock_).value(), nullptr);
  EXPECT_EQ(makeAudioOutput("none", clock_).value(), nullptr);
}

TEST_F(Registry, KnowsTheFilesThatANameSpeaksOf) {
  const std::string hand = fileWith("registry_hand.csv", "t_s,x_mm,y_mm,z_mm\n0,30,-12,6\n");
  for (const std::string& sim : {"sim:" + hand, "sim:tense," + hand, "sim:" + hand + ",falcon"}) {
    EXPECT_EQ(filesNamedBy(sim).read, hand) << sim;
    EXPECT_EQ(filesNamedBy(sim).written, "");
  }
  for (const char* word : {"falcon", "polhem", "replay", "script"}) {
    EXPECT_EQ(filesNamedBy(std::string(word) + ":/tmp/a:b").read, "/tmp/a:b") << word;
  }
  EXPECT_EQ(filesNamedBy("offscreen:a@b.y4m").written, "a@b.y4m");
  EXPECT_EQ(filesNamedBy("offscreen:a@b.y4m@25").written, "a@b.y4m");
  EXPECT_EQ(filesNamedBy("offscreen:a.y4m").read, "");
  for (const char* name : {"", "offscreen", "sim", "sim:tense", "sim:tens", "kms:/dev/dri/card0", "pointer:window",
                           "alsa:hdmi:CARD=0", "replay", "mock", "none"}) {
    EXPECT_EQ(filesNamedBy(name).read + filesNamedBy(name).written, "") << name;
  }
}

TEST_F(Registry, RefusesOtherNamesAndListsTheRightOnes) {
  for (const char* name : {"", "ofscreen", "offscreen:", "window:", "kms:", "mock:1", "none"}) {
    const auto display = makeDisplay(name);
    ASSERT_FALSE(display) << name;
    EXPECT_EQ(display.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_EQ(display.error().thing, std::string("--display ") + name);
    EXPECT_THAT(display.error().error.message, testing::HasSubstr(kDisplayNames));
  }
  for (const char* name :
       {"", "falcon:", "polhem:", "inverse3:", "sim:", "mock:x", "none:", "SIM", "replay", "replay:"}) {
    const auto device = makeHapticDevice(name, clock_);
    ASSERT_FALSE(device) << name;
    EXPECT_EQ(device.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_THAT(device.error().error.message, testing::HasSubstr(kHapticNames));
  }
  for (const char* name : {"", "keys:1", "window:1", "script", "script:"}) {
    const auto remote = makeRemoteInput(name, clock_);
    ASSERT_FALSE(remote) << name;
    EXPECT_EQ(remote.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_THAT(remote.error().error.message, testing::HasSubstr(kRemoteNames));
  }
  for (const char* name : {"", "alsa:", "pulse", "null:1"}) {
    const auto audio = makeAudioOutput(name, clock_);
    ASSERT_FALSE(audio) << name;
    EXPECT_EQ(audio.error().error.code, ErrorCode::InvalidArgument);
    EXPECT_THAT(audio.error().error.message, testing::HasSubstr(kAudioNames));
  }
}

TEST_F(Registry, AScriptThatIsNotThereIsNotFound) {
  EXPECT_EQ(makeHapticDevice("sim:/nonexistent.csv", clock_).error().error.code, ErrorCode::NotFound);
  EXPECT_EQ(makeRemoteInput("script:/nonexistent.txt", clock_).error().error.code, ErrorCode::NotFound);
}

TEST_F(Registry, APolhemIsAsItsDescriptionSays) {
  const auto device = makeHapticDevice("polhem:" RELIEVO_SOURCE_DIR "/drivers/polhem/polhem-1.json", clock_);
  ASSERT_TRUE(device);
  EXPECT_EQ((*device)->capabilities().max_stiffness_n_per_mm, 0.8);
  const auto closed = makeHapticDevice("polhem:" + fileWith("registry_arm.json", "{\"variant\": 3}"), clock_);
  EXPECT_EQ(closed.error().error.code, ErrorCode::Unsupported);
  EXPECT_EQ(makeHapticDevice("polhem:/nonexistent.json", clock_).error().error.code, ErrorCode::NotFound);
}

TEST_F(Registry, TheSimulatedHandFollowsItsScript) {
  const std::string script = fileWith("registry_hand.csv", "t_s,x_mm,y_mm,z_mm\n0,30,-12,6\n");
  const auto device = makeHapticDevice("sim:" + script, clock_).value();
  ASSERT_TRUE(device->open() && device->home() && device->start());
  EXPECT_EQ(device->read()->position_mm, glm::dvec3(30, -12, 6));
}

TEST_F(Registry, TheSimulatedDeviceIsTheOneThatIsNamed) {
  EXPECT_STREQ(makeHapticDevice("sim:falcon,tense", clock_).value()->capabilities().name, "sim falcon");
  EXPECT_EQ(makeHapticDevice("sim:flacon", clock_).error().error.code, ErrorCode::InvalidArgument);
}

TEST_F(Registry, EachWordOfTheSimulatedDeviceIsListed) {
  for (const char* word : {"phantom", "falcon", "polhem", "stroking", "resting", "tapping", "tense", "shaking"}) {
    EXPECT_TRUE(makeHapticDevice(std::string("sim:") + word, clock_)) << word;
    EXPECT_THAT(kHapticNames, testing::HasSubstr(word));
  }
}

TEST_F(Registry, AMouseIsThePointerByItselfOrByItsPath) {
  EXPECT_STREQ(makeHapticDevice("pointer", clock_).value()->capabilities().name, "pointer");
  const auto device = makeHapticDevice("pointer:/nonexistent/event0", clock_).value();
  EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
  EXPECT_FALSE(makeHapticDevice("pointer:", clock_));
  EXPECT_STREQ(makeHapticDevice("pointer:window", clock_).value()->capabilities().name, "pointer");
  EXPECT_STREQ(makeHapticDevice("pointer:window", clock_).value()->open().error().message,
               "there is no window to point in; add --display window");
}

TEST_F(Registry, AGamepadIsTheFirstOneOrTheOneOfThatPath) {
  EXPECT_STREQ(makeHapticDevice("gamepad", clock_).value()->capabilities().name, "gamepad");
  const auto device = makeHapticDevice("gamepad:/nonexistent/event0", clock_).value();
  EXPECT_EQ(device->open().error().code, ErrorCode::NotFound);
  EXPECT_FALSE(makeHapticDevice("gamepad:", clock_));
  const auto null = makeHapticDevice("gamepad:/dev/null", clock_).value();
  EXPECT_EQ(null->open().error().code, ErrorCode::Unsupported);
}

TEST_F(Registry, ARecordingIsPlayedAgain) {
  const std::string file = fileWith("registry_touch.csv", "t_s,x_mm,y_mm,z_mm\n0,30,-12,6\n");
  const auto device = makeHapticDevice("replay:" + file, clock_).value();
  ASSERT_TRUE(device->open() && device->home() && device->start());
  EXPECT_EQ(device->read()->position_mm, glm::dvec3(30, -12, 6));
  EXPECT_EQ(makeHapticDevice("replay:/nonexistent.csv", clock_).error().error.code, ErrorCode::NotFound);
}

TEST_F(Registry, AWindowsKeysAreARemote) {
  EXPECT_NE(makeRemoteInput("window", clock_).value(), nullptr);
}

TEST_F(Registry, TheScriptedRemotePressesItsKeys) {
  const auto remote = makeRemoteInput("script:" + fileWith("registry_keys.txt", "0 PLAY\n"), clock_).value();
  ASSERT_TRUE(remote->open());
  EXPECT_TRUE(remote->poll(clock_.now()).value());
}

}  // namespace
}  // namespace relievo::drivers
