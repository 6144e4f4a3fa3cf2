// SPDX-License-Identifier: Apache-2.0
// A scripted source, its decoders and a TrackReader over them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "app/media/tracks/track_reader.h"

namespace relievo::test {

using std::chrono::milliseconds;

struct Scripted {
  int stream = 0;
  int ms = 0;
  bool keyframe = true;
};

// Sound is stream 2. Packets come in the order of the script. A seek lands `late` packets after the last key frame of
// stream 0 at or before the target.
class ScriptedSource final : public MediaSource {
 public:
  explicit ScriptedSource(std::vector<Scripted> script, std::size_t late = 0)
      : script_(std::move(script)), late_(late) {}
  ~ScriptedSource() override {
    if (closing) closing();
  }
  std::function<void()> closing;
  std::size_t position = 0;
  int seeks = 0;
  std::size_t packet_bytes = 1;

 private:
  Result<Description> openSource(const std::string&) override {
    Description description;
    for (int i = 0; i < 3; ++i) {
      StreamInfo stream;
      stream.index = i;
      stream.kind = i < 2 ? StreamKind::Video : StreamKind::Audio;
      description.streams.push_back(stream);
    }
    return description;
  }
  Result<std::optional<Packet>> readPacket() override {
    if (position == script_.size()) return std::nullopt;
    const Scripted& entry = script_[position++];
    Packet packet;
    packet.stream = entry.stream;
    packet.pts = MediaTime(milliseconds(entry.ms));
    packet.keyframe = entry.keyframe;
    packet.bytes = packet_bytes;
    return packet;
  }
  Result<void> seekTo(MediaTime target) override {
    ++seeks;
    position = 0;
    for (std::size_t i = 0; i < script_.size(); ++i) {
      const bool key = script_[i].stream == 0 && script_[i].keyframe;
      if (key && MediaTime(milliseconds(script_[i].ms)) <= target) position = i;
    }
    if (target > MediaTime{}) position = std::min(position + late_, script_.size());
    return {};
  }
  void closeSource() noexcept override {}
  void interrupted() noexcept override {}

  std::vector<Scripted> script_;
  std::size_t late_;
};

// One picture per packet. Counts the pictures in use, and refuses more than the limit.
class OneToOneDecoder final : public VideoDecoder {
 public:
  explicit OneToOneDecoder(int max_held = 1000) : max_held_(max_held) {}
  [[nodiscard]] Capabilities capabilities() const noexcept override { return {"one-to-one", max_held_, false}; }

 private:
  Result<void> openDecoder(const StreamInfo&) override { return {}; }
  Result<Feed> feedPacket(const Packet& packet) override {
    if (waiting_ || held_.use_count() > max_held_) return Feed::Full;
    waiting_ = packet.pts;
    return Feed::Accepted;
  }
  Result<Progress> receiveFrame(Frame& frame) override {
    if (!waiting_) return draining_ ? Progress::EndOfStream : Progress::NeedsPackets;
    frame.pts = *waiting_;
    frame.owner = held_;
    waiting_.reset();
    return Progress::Picture;
  }
  Result<void> startDrain() override {
    draining_ = true;
    return {};
  }
  Result<void> flushDecoder() override {
    draining_ = false;
    waiting_.reset();
    return {};
  }
  void closeDecoder() noexcept override {}

  int max_held_;
  std::shared_ptr<int> held_ = std::make_shared<int>();
  std::optional<MediaTime> waiting_;
  bool draining_ = false;
};

// One sample per packet; its value is the time in ms.
class SampleDecoder final : public AudioDecoder {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "sample"; }
  std::uint64_t lose_after = 1000;

 private:
  Result<void> openDecoder(const StreamInfo&, const AudioFormat&) override { return {}; }
  Result<AudioChunk> decodePacket(const Packet& packet) override {
    if (decoded_++ == lose_after) return fail(ErrorCode::Unsupported, "no more");
    return AudioChunk{*packet.pts, {static_cast<float>(packet.pts->time_since_epoch() / milliseconds(1))}};
  }
  void flushDecoder() noexcept override {}
  void closeDecoder() noexcept override {}
  std::uint64_t decoded_ = 0;
};

struct Film {
  ScriptedSource* source = nullptr;
  std::unique_ptr<TrackReader> reader;

  explicit Film(std::vector<Scripted> script, std::size_t late = 0, int max_held = 1000) {
    auto owned = std::make_unique<ScriptedSource>(std::move(script), late);
    source = owned.get();
    reader = std::make_unique<TrackReader>(
        std::move(owned), [max_held](const StreamInfo&) { return std::make_unique<OneToOneDecoder>(max_held); });
    EXPECT_TRUE(reader->open("").has_value());
    for (int i = 0; i < 2; ++i) EXPECT_TRUE(reader->select(source->streams()[static_cast<std::size_t>(i)]).has_value());
  }
  SampleDecoder& listen() {
    auto decoder = std::make_unique<SampleDecoder>();
    SampleDecoder& ear = *decoder;
    EXPECT_TRUE(reader->listen(std::move(decoder), source->streams()[2], {}).has_value());
    return ear;
  }
  // Times in ms of all the sound read so far.
  std::vector<int> sound() {
    std::vector<int> times;
    while (const auto chunk = reader->nextSound()) times.push_back(static_cast<int>(chunk->samples[0]));
    return times;
  }
  // The next picture's time in ms, -1 for none.
  int next(std::size_t track) {
    const auto frame = reader->next(track).value();
    return frame ? static_cast<int>((*frame).pts.time_since_epoch() / milliseconds(1)) : -1;
  }
};

inline std::vector<Scripted> interleaved(int count, int gop) {
  std::vector<Scripted> script;
  for (int k = 0; k < count; ++k) {
    script.push_back({0, 40 * k, k % gop == 0});
    script.push_back({1, 40 * k, k % gop == 0});
  }
  return script;
}

}  // namespace relievo::test
