// SPDX-License-Identifier: Apache-2.0
// What is read in the Haply Inverse service's messages, and what is sent to it.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "drivers/inverse3/force_message.h"
#include "drivers/inverse3/snapshot.h"
#include "drivers/inverse3/wire.h"

namespace relievo::inverse3 {
namespace {

// The examples of docs.haply.co, shortened where nothing is read.
constexpr const char* kOf34 =
    R"({"inverse3": [ {"device_id": "04BA", "config": {"type": "inverse3", "device_info": {"id": "04BA", "model": 4},
    "port": "COM13", "handedness": "right"}, "state": {"angular_position": {"a0": -69.31704, "a1": 137.62952,
    "a2": 19.832787}, "body_orientation": {"x": -0.01940918, "y": 0.7026367, "z": 0.00048828125, "w": 0.7113037},
    "cursor_position": {"x": 0.07842738, "y": -0.14836666, "z": 0.14297646}, "cursor_velocity": {"x": -0.011969013,
    "y": 0.0012009288, "z": -0.043197}, "mode": "idle"}, "status": {"calibrated": false, "in_use": false,
    "power_supply": true, "ready": true, "started": true}}], "verse_grip": [{"device_id": "61548", "state":
    {"button": true, "hall": 0}}]})";
constexpr const char* kOf35 =
    R"({"session_id": 7, "inverse3": [{"device_id": "049D", "config": {"preset": "defaults", "filters": {"force_gate":
    {"gain": 0.3}}}, "state": {"cursor_position": {"x": 0.0, "y": -0.12, "z": 0.15}, "current_cursor_position": {"x": 1,
    "y": 2, "z": 3}, "control_domain": "cartesian", "control_mode": "idle", "transform": {"position": {"x": 9, "y": 9,
    "z": 9}}}}], "wireless_verse_grip": [{"device_id": "B1", "state": {"buttons": {"a": false, "b": true, "c": true}}}]})";

TEST(Inverse3Snapshot, TheDocumentedMessagesOfBothVersionsAreRead) {
  const auto old = readSnapshot(kOf34, "");
  ASSERT_TRUE(old);
  EXPECT_FALSE(old->from_3_5);
  EXPECT_TRUE(old->known && old->powered && old->ready);
  EXPECT_EQ(old->id.text(), "04BA");
  EXPECT_EQ(old->position_m, glm::dvec3(0.07842738, -0.14836666, 0.14297646));
  EXPECT_EQ(old->buttons, 1U);
  const auto recent = readSnapshot(kOf35, "049D");
  ASSERT_TRUE(recent);
  EXPECT_TRUE(recent->from_3_5 && recent->known);
  EXPECT_EQ(recent->position_m, glm::dvec3(0, -0.12, 0.15));
  EXPECT_EQ(recent->buttons, 6U);
}

// Its last state stays in the messages: a button held then would be a clutch that is never released.
TEST(Inverse3Snapshot, AGripThatIsGoneHasNoButtonDown) {
  for (const bool connected : {true, false}) {
    const std::string text =
        R"({"inverse3":[],"wireless_verse_grip":[{"device_id":"B1","state":{"buttons":{"b":true}},)"
        R"("status":{"awake":true,"connected":)" +
        std::string(connected ? "true" : "false") + R"(}},{"state":{"buttons":{"c":true}}}]})";
    EXPECT_EQ(readSnapshot(text, "")->buttons, connected ? 6U : 4U);
  }
}

// Wired grips and wireless ones are one list; one that is gone keeps its place.
TEST(Inverse3Snapshot, OfAsManyGripsAsArmsEachArmHasTheOneAtItsPlace) {
  const std::string arms = R"("inverse3":[{"device_id":"A"},{"device_id":"B"}])";
  const std::string grips = R"("wireless_verse_grip":[{"device_id":"G","state":{"buttons":{"b":true}}},)"
                            R"({"device_id":"H","state":{"buttons":{"c":true}}}])";
  const std::string third = R"("verse_grip":[{"device_id":"I","state":{"button":true}}])";
  for (const std::string& text : {"{" + arms + "," + grips + "}", "{" + grips + "," + arms + "}"}) {
    EXPECT_EQ(readSnapshot(text, "A")->own_buttons, 2U);
    EXPECT_EQ(readSnapshot(text, "", 1)->own_buttons, 4U);
    EXPECT_EQ(readSnapshot(text, "A")->buttons, 6U);
    EXPECT_EQ(readSnapshot(text, "C")->own_buttons, 6U) << "an arm that is not listed";
  }
  EXPECT_EQ(readSnapshot("{" + arms + "," + third + "}", "B")->own_buttons, 1U) << "of both";
  EXPECT_EQ(readSnapshot("{" + arms + "," + third + "," + grips + "}", "B")->own_buttons, 7U);
}

TEST(Inverse3Snapshot, TheDeviceThatWasAskedForIsRead) {
  const std::string two =
      R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0.1,"y":0,"z":0}}},)"
      R"({"state":{"cursor_position":{"x":0.2,"y":0,"z":0}},"device_id":"B","status":{"ready":false,"power_supply":false}}]})";
  EXPECT_EQ(readSnapshot(two, "")->id.text(), "A");
  EXPECT_EQ(readSnapshot(two, "", 1)->id.text(), "B");
  EXPECT_EQ(readSnapshot(two, "", 2)->id.text(), "");
  const auto second = readSnapshot(two, "B");
  EXPECT_EQ(second->position_m->x, 0.2);
  EXPECT_FALSE(second->ready || second->powered);
  const auto none = readSnapshot(two, "C");
  EXPECT_EQ(none->id.text(), "");
  EXPECT_FALSE(none->position_m);
}

TEST(Inverse3Snapshot, APositionThatIsNoneIsNone) {
  for (const char* position :
       {R"({"x":0,"y":0})", R"({"x":0,"y":0,"z":null})", R"({"x":0,"y":0,"z":"0"})", R"({"x":0,"y":0,"z":1.001})",
        R"({"x":-1e9,"y":0,"z":0})", R"({"x":1e999,"y":0,"z":0})", "[0,0,0]", "null", "7"}) {
    const auto snapshot = readSnapshot(
        std::string(R"({"inverse3":[{"device_id":"A","state":{"cursor_position":)") + position + "}}]}", "A");
    ASSERT_TRUE(snapshot) << position;
    EXPECT_EQ(snapshot->id.text(), "A");
    EXPECT_FALSE(snapshot->position_m) << position;
  }
}

TEST(Inverse3Snapshot, WhatIsNoJsonObjectIsNoMessage) {
  const std::string deep = std::string(R"({"a":)") + std::string(40, '[') + std::string(40, ']') + "}";
  for (const std::string& text : {std::string(),
                                  std::string("null"),
                                  std::string("[]"),
                                  std::string(R"({"a":1)"),
                                  std::string(R"({"a":1}})"),
                                  std::string(R"({"a" 1})"),
                                  std::string(R"({a:1})"),
                                  std::string(R"({"a":01})"),
                                  std::string(R"({"a":1.})"),
                                  std::string(R"({"a":+1})"),
                                  std::string(R"({"a":NaN})"),
                                  std::string(R"({"a":tru})"),
                                  std::string(R"({"a":"\x"})"),
                                  std::string(R"({"a":"\u12G4"})"),
                                  std::string("{\"a\":\"\n\"}"),
                                  std::string(R"({"a":1,})"),
                                  std::string(R"({"a":[1,]})"),
                                  std::string(R"({"a":[1 2]})"),
                                  std::string("{\"a\":1}\0", 8),
                                  deep,
                                  std::string(kOf34).substr(0, 300)}) {
    EXPECT_FALSE(readSnapshot(text, "")) << text;
  }
  for (const char* text :
       {"{}", " { } ", R"({"a":[{}, [], "\u00e9\"\\", -0.5e-3, true, false, null]})", R"({"":""})"}) {
    EXPECT_TRUE(readSnapshot(text, "")) << text;
  }
}

// Every text that results from the documented messages when a byte is lost or changed.
TEST(Inverse3Snapshot, AgreesWithAnotherReaderOnDamagedMessages) {
  int good = 0;
  for (const std::string& text : {std::string(kOf34), std::string(kOf35)}) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      for (const char* instead : {"", "\"", "{", "]", ",", "0", "-", "\\", " ", "\x01"}) {
        std::string damaged = text;
        damaged.replace(at, 1, instead);
        const bool is_good = nlohmann::json::accept(damaged);
        ASSERT_EQ(readSnapshot(damaged, "").has_value(), is_good) << damaged;
        good += is_good ? 1 : 0;
      }
    }
  }
  EXPECT_GT(good, 3000);
}

TEST(Inverse3Snapshot, AServiceOfAnotherKindIsNotKnown) {
  EXPECT_FALSE(readSnapshot(R"({"devices":{}})", "")->known);
  EXPECT_TRUE(readSnapshot(R"({"inverse3":[]})", "")->known);
  EXPECT_TRUE(readSnapshot("{}", "")->known) << "it has no devices";
  EXPECT_TRUE(readSnapshot(R"({"session_id":3})", "")->known);
}

TEST(Inverse3Snapshot, ANameThatWouldHaveToBeEscapedIsNone) {
  for (const char* id :
       {R"(A\"B)", "A B", "", "\xc3\xa9", "0123456789012345678901234567890123456789012345678901234567890123"}) {
    EXPECT_EQ(DeviceId(id).text(), "") << id;
  }
  EXPECT_EQ(DeviceId("2D35-f8_0.D:1").text(), "2D35-f8_0.D:1");
}

// Read back by another library.
TEST(Inverse3ForceMessage, AForceIsWrittenInEachVersionsWords) {
  ForceMessage message;
  const auto written = [&](const glm::dvec3& force) {
    const PortBytes bytes = message.with(force);
    return nlohmann::json::parse(bytes.begin(), bytes.end());
  };
  for (const bool from_3_5 : {false, true}) {
    message.setDevice("049D", from_3_5);
    for (const glm::dvec3& force : {glm::dvec3(0), glm::dvec3(1.5, -0.25, 9.99994), glm::dvec3(-10, 10, -0.00004),
                                    glm::dvec3(0.0001, -0.0001, -12.3456)}) {
      const auto json = written(force);
      ASSERT_EQ(json["inverse3"].size(), 1U);
      EXPECT_EQ(json["inverse3"][0]["device_id"], "049D");
      const auto vector = json["inverse3"][0]["commands"]["set_cursor_force"][from_3_5 ? "vector" : "values"];
      EXPECT_NEAR(vector["x"].get<double>(), force.x, 0.51e-4);
      EXPECT_NEAR(vector["y"].get<double>(), force.y, 0.51e-4);
      EXPECT_NEAR(vector["z"].get<double>(), force.z, 0.51e-4);
    }
  }
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto wild = written({kNaN, 1e300, -std::numeric_limits<double>::infinity()});
  const auto vector = wild["inverse3"][0]["commands"]["set_cursor_force"]["vector"];
  EXPECT_EQ(vector["x"], 0.0);
  EXPECT_EQ(vector["y"], 99.0);
  EXPECT_EQ(vector["z"], 0.0);
}

TEST(Inverse3ForceMessage, TheLongestFitsAndTheHelloNamesTheProgram) {
  ForceMessage message;
  message.setDevice(std::string(63, 'A'), true);
  const PortBytes bytes = message.with({-99, -99, -99});
  EXPECT_TRUE(nlohmann::json::accept(bytes.begin(), bytes.end()));
  const auto hello = nlohmann::json::parse(helloMessage("049D"));
  EXPECT_EQ(hello["session"]["configure"]["profile"]["name"], "relievo");
  EXPECT_EQ(hello["inverse3"][0]["configure"]["preset"]["preset"], "arm_front_centered");
}

TEST(Inverse3Address, IsReadAsAHostAndItsPort) {
  EXPECT_EQ(Address().text(), "localhost:10001");
  EXPECT_EQ(Address::parse("box")->text(), "box:10001");
  EXPECT_EQ(Address::parse("192.168.1.7:81")->text(), "192.168.1.7:81");
  EXPECT_EQ(Address::parse("[::1]:81")->text(), "[::1]:81");
  EXPECT_EQ(Address::parse("[::1]")->host, "::1");
  for (const char* text : {"", ":81", "box:", "box:0", "box:65536", "box:8x", "box:81:82", "[::1", "[::1]81", "a b",
                           "ws://box", "box\r\nX: y"}) {
    EXPECT_FALSE(Address::parse(text)) << text;
  }
}

}  // namespace
}  // namespace relievo::inverse3
