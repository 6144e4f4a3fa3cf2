// SPDX-License-Identifier: Apache-2.0
// Virtual devices: every interface of the HAL with a profile, fault switches and nothing behind it but the
// clock given.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/audio_decoder.h"
#include "hal/audio_output.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media_source.h"
#include "hal/video_decoder.h"
#include "platform/clock.h"

namespace relievo {

// Every clock below must outlive what is made with it. On a ManualClock a mock runs in simulated time: where
// a real device would block, the mock sleeps on the clock given, which moves a ManualClock along.
//
// A count that begins a fault (lose_after_.., ..) is how many go well before it; kNever switches the fault
// off.
inline constexpr std::uint64_t kNever = ~std::uint64_t{0};

// ---- film
// ----------------------------------------------------------------------------------------------------------

// One track. Pictures are planar, 8 bits in a byte, more in two, and each row is followed by some bytes
// of no meaning, so that who mistakes the width for the stride is caught. Of sound a frame is a packet of one period.
struct MockTrack {
  StreamKind kind = StreamKind::Video;
  int width = 160;
  int height = 108;
  ColorModel model = ColorModel::Gray;
  ColorRange range = ColorRange::Full;
  int bits = 8;                                // 8 to 16
  int chroma_shift_x = 1, chroma_shift_y = 1;  // of Yuv
  int frames = 300;
  Duration frame_period = std::chrono::microseconds(33'333);
  Duration first_pts{0};
  int keyframe_interval = 1;  // a seek lands on a multiple of it
  std::vector<int> missing;   // frames that the container has lost
  Duration late{0};           // its packets come so much later in the film than their times
  std::map<std::string, std::string> tags;
  // Value of a sound's sample: (seconds, channel). Called on the decoder's thread. Default: 440 Hz.
  std::function<float(double, int)> sound;
  // Value of a picture's sample: (frame, component, column, row). Called on the decoder's thread. Default: a slope that
  // moves.
  std::function<std::uint16_t(int, int, int, int)> sample;

  [[nodiscard]] MediaTime pts(int frame) const noexcept { return MediaTime(first_pts + frame * frame_period); }
};

struct MockMediaProfile {
  std::vector<MockTrack> tracks{MockTrack{}};
  std::map<std::string, std::string> tags;
  bool live = false;    // of unknown duration, cannot seek
  bool remote = false;  // comes over a network, as MediaSource::remote says
  std::optional<Duration> sender_start;
  Duration longest_gap{0};  // of its times (ContinuousTime)

  // Faults. Packets are counted over all tracks since `open`.
  std::optional<ErrorCode> fail_open;
  std::uint64_t lose_after_packets = kNever;   // read answers Lost until closed
  std::uint64_t end_after_packets = kNever;    // a file that is cut off
  std::uint64_t stall_after_packets = kNever;  // one read takes `stall`, or less when interrupted
  Duration stall = std::chrono::seconds(2);
  std::uint64_t damaged_every = 0;            // every n-th packet; 0: none
  std::uint64_t jump_after_packets = kNever;  // from there on the container's times are so much later, or earlier
  Duration jump{0};
  Duration wrap{0};  // they are counted up to this and begin again at 0; 0: they are not
};

// Three seconds of a ball that rolls to and fro on a wall, in colour and depth.
[[nodiscard]] MockMediaProfile mockFilm();
// Whether it is a stream of a mock source.
[[nodiscard]] bool isMock(const StreamInfo& stream) noexcept;

// Ignores what the url says. Its packets are understood by the mock decoder alone (codec "mock").
[[nodiscard]] std::unique_ptr<MediaSource> makeMockSource(MockMediaProfile profile, Clock& clock);
// The film of the url that is opened; NotFound where there is none.
[[nodiscard]] std::unique_ptr<MediaSource> makeMockSources(std::map<std::string, MockMediaProfile> films, Clock& clock);

struct MockDecoderProfile {
  std::size_t queue_packets = 4;  // taken and not yet received; then Full
  int reorder_frames = 0;         // pictures that it holds back until more packets come
  int max_held_frames = 8;        // with so many outside it makes no further one

  // Faults.
  std::uint64_t lose_after_packets = kNever;  // feed answers Lost until closed
};

// Decodes a mock source's packets, and Unsupported for any other stream.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeMockDecoder(MockDecoderProfile profile = {});

// Likewise for sound: every channel, at the rate that is asked for.
[[nodiscard]] std::unique_ptr<AudioDecoder> makeMockAudioDecoder();

// ---- display
// -------------------------------------------------------------------------------------------------------

struct MockDisplayProfile {
  Duration refresh_period = std::chrono::microseconds(16'667);  // 0: shows at once

  // Faults.
  std::optional<ErrorCode> fail_open;
  std::uint64_t failing_opens = kNever;       // how often it fails
  std::uint64_t lose_after_frames = kNever;   // every verb answers Lost until closed
  std::uint64_t close_after_frames = kNever;  // attend answers Cancelled: the viewer has closed it
  std::function<void()> shown;                // called as each picture comes onto the screen
};

// The cable. Any thread.
struct MockDisplayBench {
  std::atomic<bool> unplugged{false};  // no screen: an open one is Lost, `open` answers NotFound
};

// Shows nothing, at the pace of its refresh: `present` sleeps until the next one.
[[nodiscard]] std::unique_ptr<Display> makeMockDisplay(const MockDisplayProfile& profile, Clock& clock,
                                                       std::shared_ptr<MockDisplayBench> bench = nullptr);

// ---- sound
// ---------------------------------------------------------------------------------------------------------

// What an observer hears. On the thread that uses the device.
struct MockAudioBench {
  // The first channel's sample that is in the air at a moment since the device was last asked; nothing in a silence.
  std::function<std::optional<float>(MonotonicTime)> heard;
  bool unplugged = false;  // every verb answers Lost until closed
};

// A sink that plays nothing, at the pace of the clock given.
struct MockAudioProfile {
  const char* name = "null";
  std::optional<AudioFormat> format;  // what it runs at, whatever is wished for
  Duration buffer = std::chrono::milliseconds(500);
  double drift_ppm = 0;       // how much faster its crystal is than the clock
  Duration latency{0};        // from the buffer to the ear: known to it, and in its positions
  Duration start_latency{0};  // from the first frame's writing until it begins: seen in its positions alone
  Duration jitter{0};         // its positions are off by up to this, either way

  // Faults.
  std::optional<ErrorCode> fail_open;
  std::uint64_t failing_opens = kNever;      // how often it fails
  std::uint64_t lose_after_frames = kNever;  // heard since `open`: Lost until closed
  bool paced = true;                         // false: takes all at once and says that it was heard
};

[[nodiscard]] std::unique_ptr<AudioOutput> makeMockAudio(MockAudioProfile profile, const Clock& clock,
                                                         std::shared_ptr<MockAudioBench> bench = nullptr);

// ---- haptic device
// -------------------------------------------------------------------------------------------------

// What an observer sees of the device from outside, and the cable that it may pull. Any thread.
struct MockHapticBench {
  std::atomic<double> force_x_n{0}, force_y_n{0}, force_z_n{0};  // in the motors at this moment
  std::atomic<std::uint64_t> reads{0}, writes{0};
  std::atomic<bool> unplugged{false};  // homing and every exchange answer Lost
  std::atomic<bool> glitch{false};     // the next read answers Io, once

  [[nodiscard]] glm::dvec3 force() const noexcept { return {force_x_n.load(), force_y_n.load(), force_z_n.load()}; }
};

struct MockHapticProfile {
  HapticCapabilities capabilities{.name = "mock",
                                  .workspace_min_mm = {-100, -80, -40},
                                  .workspace_max_mm = {100, 80, 80},
                                  .peak_force_n = 10,
                                  .continuous_force_n = 5,
                                  .max_stiffness_n_per_mm = 2,
                                  .rate_hz = 1000};
  // Where the finger is, whatever the force: `path_mm`, one position a read, the last one held; or, when that
  // is empty, `position_mm` of the seconds since `start`, which must be real-time safe. Neither: at rest in
  // the middle.
  std::vector<glm::dvec3> path_mm;
  std::function<glm::dvec3(double)> position_mm;
  std::uint32_t buttons = 0;

  // Faults. Ticks are reads since `open`.
  std::optional<ErrorCode> fail_open;
  std::uint64_t fail_homing_after = kNever;   // Timeout from then on; counted over all openings
  std::uint64_t lose_after_ticks = kNever;    // Lost until closed
  std::uint64_t glitch_after_ticks = kNever;  // one read answers Io
  bool refuses_force = false;                 // every write answers Io, the force stays zero
};

// Without a bench nobody watches.
[[nodiscard]] std::unique_ptr<HapticDevice> makeMockHaptic(MockHapticProfile profile, const Clock& clock,
                                                           std::shared_ptr<MockHapticBench> bench = nullptr);

}  // namespace relievo
