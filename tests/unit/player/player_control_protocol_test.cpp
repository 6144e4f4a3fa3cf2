// SPDX-License-Identifier: Apache-2.0
// Lines of the control socket: what is asked, and the one answer to everything else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "app/player/control/control_protocol.h"

namespace relievo {
namespace {

using nlohmann::json;
using testing::HasSubstr;

template <class T>
const T& asked(const ControlLine& line) {
  EXPECT_TRUE(line.asked) << (line.asked ? "" : line.asked.error());
  static const T none{};
  return line.asked && std::holds_alternative<T>(*line.asked) ? std::get<T>(*line.asked) : none;
}

TEST(ControlProtocol, TakesTheWordsOfTheKeys) {
  EXPECT_EQ(asked<PlayerCommand>(parseControlLine(R"({"do": "seek +10"})")), (PlayerCommand{PlayerVerb::SeekBy, 10}));
  EXPECT_EQ(asked<PlayerCommand>(parseControlLine(R"({"do":"open http://a/b c.mkv","id":1})")),
            (PlayerCommand{PlayerVerb::Open, 0, "http://a/b c.mkv"}));
  EXPECT_EQ(asked<PlayerCommand>(parseControlLine(R"({"do":"quit"})")).verb, PlayerVerb::Quit);
}

TEST(ControlProtocol, TakesWhatOnlyAProgramAsks) {
  EXPECT_TRUE(std::holds_alternative<StatusRequest>(*parseControlLine(R"({"do":"status"})").asked));
  EXPECT_TRUE(asked<MetricsRequest>(parseControlLine(R"({"do":"metrics on"})")).on);
  EXPECT_TRUE(std::holds_alternative<MetricsRequest>(*parseControlLine(R"({"do":"metrics off"})").asked));
  EXPECT_FALSE(std::get<MetricsRequest>(*parseControlLine(R"({"do":"metrics off"})").asked).on);
  const FaultRequest fault = asked<FaultRequest>(parseControlLine(R"({"do":"fault haptic unplug"})"));
  EXPECT_EQ(fault.device, "haptic");
  EXPECT_EQ(fault.fault, "unplug");
}

TEST(ControlProtocol, AnIdComesBackAsItWas) {
  EXPECT_EQ(okLine(parseControlLine(R"({"do":"pause","id":-7})").id), R"({"id":-7,"ok":true})");
  EXPECT_EQ(okLine(parseControlLine(R"({"do":"pause","id":"a\"b"})").id), R"({"id":"a\"b","ok":true})");
  EXPECT_EQ(okLine(parseControlLine(R"({"do":"pause"})").id), R"({"ok":true})");
  const ControlLine wrong = parseControlLine(R"({"do":"dance","id":18446744073709551615})");
  ASSERT_FALSE(wrong.asked);
  EXPECT_THAT(errorLine(wrong.id, wrong.asked.error()), HasSubstr(R"("id":18446744073709551615,"ok":false,"error":)"));
}

TEST(ControlProtocol, WhatIsNoRequestSaysWhyAndWhatOneIs) {
  const std::string deep = R"({"do":)" + std::string(2000, '[') + std::string(2000, ']') + "}";
  const std::string deeper(4096, '[');
  const std::string long_id = R"({"do":"pause","id":")" + std::string(65, 'x') + "\"}";
  for (const std::string& line :
       {std::string(), std::string("pause"), std::string("{"), std::string("[]"), std::string("null"),
        std::string("{}"), std::string(R"({"do":3})"), std::string(R"({"do":"pause","twice":1})"),
        std::string(R"({"do":"pause"}{"do":"pause"})"), std::string(R"({"do":"pause","id":1.5})"),
        std::string(R"({"do":"pause","id":null})"), std::string(R"({"do":"fault haptic"})"),
        std::string(R"({"do":"metrics"})"), std::string(R"({"do":"open"})"), std::string("{\"do\":\"pau\xffse\"}"),
        std::string("\0{\"do\":\"pause\"}", 15), deep, deeper, long_id}) {
    const ControlLine read = parseControlLine(line);
    ASSERT_FALSE(read.asked) << line;
    const json answer = json::parse(errorLine(read.id, read.asked.error()), nullptr, false);
    ASSERT_TRUE(answer.is_object()) << line;
    EXPECT_EQ(answer["ok"], false);
    EXPECT_FALSE(answer["error"].get<std::string>().empty());
  }
  EXPECT_THAT(parseControlLine(R"({"do":"dance"})").asked.error(), HasSubstr("seek +S|-S|S|P%"));
  const ControlLine cut =
      parseControlLine(R"({"do":"open a.mkv\u0000b"})");  // a file's name would end at the zero byte
  ASSERT_FALSE(cut.asked);
  EXPECT_THAT(cut.asked.error(), HasSubstr("zero byte"));
}

TEST(ControlProtocol, EachAnswerIsOneLineOfJsonWhateverIsInIt) {
  ScreenFacts facts;
  facts.state = PlayerState::Paused;
  facts.position_s = std::numeric_limits<double>::quiet_NaN();
  PlayReport report;
  report.display = "a\nb";
  report.haptic.update.p99 = 4200;
  report.haptic.ticks = 12;
  for (const std::string& line :
       {okLine("3"), errorLine("", "a\nb"), statusLine("3", facts, "a\xff\n.mkv"), stateLine(PlayerState::Ended, 1.25),
        faultLine({1.5, "a\xff\"", "b\n"}), metricsLine(report)}) {
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_TRUE(json::parse(line, nullptr, false).is_object()) << line;
  }
  const json status = json::parse(statusLine("3", facts, "f.mkv"));
  EXPECT_EQ(status["state"], "paused");
  EXPECT_EQ(status["position_s"], 0.0);
  EXPECT_TRUE(status["duration_s"].is_null());
  EXPECT_EQ(json::parse(stateLine(PlayerState::Ended, 1.25)),
            (json{{"event", "state"}, {"state", "ended"}, {"time_s", 1.25}}));
  const json metrics = json::parse(metricsLine(report));
  EXPECT_EQ(metrics["event"], "metrics");
  EXPECT_EQ(metrics["haptic"]["update_ns"]["p99"], 4200);
  EXPECT_EQ(metrics["haptic"]["ticks"], 12);
}

}  // namespace
}  // namespace relievo
