// SPDX-License-Identifier: Apache-2.0
// A player among virtual devices in simulated time: the same film, hand and keys give the same run to the last bit.
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/player/player.h"
#include "drivers/mock/mock.h"
#include "drivers/mock/scripted_remote.h"
#include "platform/clock.h"
#include "platform/log.h"

namespace relievo {

class PlayerBench {
 public:
  static constexpr Duration kPeriod = std::chrono::milliseconds(40);

  PlayerBench() { setLogLevel(LogLevel::Error); }

  static MockTrack colorTrack(int frames) {
    return {.width = 32, .height = 24, .model = ColorModel::Yuv, .frames = frames, .frame_period = kPeriod};
  }
  // A plane whose height encodes the frame's number: code 100 + frame % 10. So the force shows which frame is felt.
  static MockTrack depthTrack(int frames) {
    MockTrack track{.width = 32, .height = 24, .frames = frames, .frame_period = kPeriod};
    track.sample = [](int frame, int, int, int) { return static_cast<std::uint16_t>(100 + frame % 10); };
    return track;
  }
  // As long as `frames` pictures. The value of each sample is its own time, in thousands of seconds.
  static MockTrack soundTrack(int frames) {
    MockTrack track{.kind = StreamKind::Audio, .frames = 2 * frames, .frame_period = kPeriod / 2};
    track.sound = [](double seconds, int) { return static_cast<float>(seconds * 1e-3); };
    return track;
  }
  static MockMediaProfile film(int frames) { return {.tracks = {colorTrack(frames), depthTrack(frames)}}; }

  // Sources by their urls; "film" is what is played.
  std::map<std::string, MockMediaProfile> sources{{"film", film(100)}};
  std::vector<MockMediaProfile> found_again;  // what is opened after the first film and its depth; then the last again
  std::map<std::string, std::string> texts;   // lists of films
  decltype(PairReader::Backends::read_text) read_text;  // real ones
  MockDisplayProfile display{.refresh_period = Duration(0)};
  MockHapticProfile haptic;
  std::function<std::unique_ptr<HapticDevice>(Clock&)> make_haptic;  // another device in place of the mock
  std::function<std::unique_ptr<HapticDevice>(Clock&)> make_second;  // of a second finger
  std::function<std::unique_ptr<MediaSource>()> make_source;         // of real films, with a decoder for them
  std::function<std::unique_ptr<VideoDecoder>()> make_decoder = [] { return makeMockDecoder({.max_held_frames = 32}); };
  decltype(PairReader::Backends::make_audio_decoder) make_audio_decoder = makeMockAudioDecoder;
  std::vector<ScriptedKey> keys;
  PlayerConfig config{.source = {.url = "film"}, .own_threads = false};
  bool with_haptic = true;
  std::function<std::unique_ptr<AudioOutput>(Clock&)> make_output;  // in place of the mock
  std::function<std::unique_ptr<RemoteInput>(Clock&)> make_remote;  // in place of the script
  std::optional<MockAudioProfile> audio;                            // nothing: a film without an output for its sound
  std::atomic<bool> stop{false};
  std::shared_ptr<MockHapticBench> hand = std::make_shared<MockHapticBench>();
  std::shared_ptr<MockDisplayBench> cable = std::make_shared<MockDisplayBench>();
  std::shared_ptr<MockAudioBench> ear = std::make_shared<MockAudioBench>();
  ManualClock clock;

  void press(double at_s, std::uint16_t key, double held_s = 0.05) {
    keys.push_back({fromSeconds(at_s), key, fromSeconds(held_s)});
  }

  Outcome<void> run() { return runOn(clock); }

  Outcome<void> runOn(Clock& time) {
    const auto screen = makeMockDisplay(display, time, cable);
    const auto device = make_haptic ? make_haptic(time) : makeMockHaptic(haptic, time, hand);
    const auto second = make_second ? make_second(time) : nullptr;
    const auto remote = make_remote ? make_remote(time) : makeScriptedRemote(keys, time);
    const auto output = make_output ? make_output(time) : audio ? makeMockAudio(*audio, time, ear) : nullptr;
    Player player(config, {.clock = time,
                           .display = *screen,
                           .haptic = with_haptic ? device.get() : nullptr,
                           .remote = remote.get(),
                           .audio = output.get(),
                           .recorder = recorder,
                           .second_finger = {second.get(), second_recorder},
                           .control = control,
                           .backends = backends(time)});
    auto played = player.run(stop);
    force_left = hand->force();
    report = player.report();
    return played;
  }

  Recorder* recorder = nullptr;
  Recorder* second_recorder = nullptr;
  PlayerControl* control = nullptr;
  PlayReport report;
  glm::dvec3 force_left{1e9};  // in the motors when `run` returned

  [[nodiscard]] std::string states() const {
    std::string text;
    for (const PlayerState state : report.states) text += std::string(text.empty() ? "" : " ") + name(state);
    return text;
  }
  [[nodiscard]] std::uint64_t faults(const std::string& part) const {
    std::uint64_t count = 0;
    for (const FaultEntry& fault : report.faults) count += fault.what.find(part) == std::string::npos ? 0 : fault.count;
    return count;
  }

 private:
  [[nodiscard]] PairReader::Backends backends(Clock& time) {
    return {.make_source =
                [this, &time, made = std::make_shared<std::size_t>(0)](const std::string&) {
                  if (make_source) return make_source();
                  const std::size_t first = config.source.depth_url.empty() ? 1 : 2;
                  const std::size_t number = (*made)++;
                  if (found_again.empty() || number < first) return makeMockSources(sources, time);
                  return makeMockSource(found_again[std::min(number - first, found_again.size() - 1)], time);
                },
            .make_decoder = [this](const StreamInfo&) { return make_decoder(); },
            .read_text = [this](const std::string& url, std::size_t most,
                                const std::atomic<bool>& cancelled) -> Result<std::string> {
              if (read_text) return read_text(url, most, cancelled);
              const auto text = texts.find(url);
              if (text == texts.end()) return fail(ErrorCode::NotFound, "no such text");
              return text->second;
            },
            .make_audio_decoder = make_audio_decoder};
  }
};

}  // namespace relievo
