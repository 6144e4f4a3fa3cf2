// SPDX-License-Identifier: Apache-2.0
// Virtual devices: a mock of every interface of the HAL, with a profile and fault switches, driven only by a clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/audio_output.h"
#include "hal/display.h"
#include "hal/haptic_device.h"
#include "hal/media/audio_decoder.h"
#include "hal/media/media_source.h"
#include "hal/media/video_decoder.h"
#include "platform/clock.h"

namespace relievo {

// Every clock below must outlive the objects made with it. On a ManualClock a mock runs in simulated time: where a real
// device would block, the mock sleeps on its clock, which advances a ManualClock.
//
// The number of a fault (lose_after_.., ..) is how many succeed before it; kNever disables the fault.
inline constexpr std::uint64_t kNever = ~std::uint64_t{0};

// ---- film
// ----------------------------------------------------------------------------------------------------------

// One track. Pictures are planar, 8 bits in a byte, more in two. Each row is followed by some padding, so that code
// that mistakes the width for the stride is caught. For sound, a frame is a packet of one period.
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
  std::vector<int> missing;   // frames that the container lacks
  Duration late{0};           // its packets are placed this much later in the film than their times
  std::map<std::string, std::string> tags;
  // Value of a sound sample: (seconds, channel). Called on the decoder's thread. Default: 440 Hz.
  std::function<float(double, int)> sound;
  // Value of a picture's sample: (frame, component, column, row). Called on the decoder's thread. Default: a moving
  // slope.
  std::function<std::uint16_t(int, int, int, int)> sample;

  [[nodiscard]] MediaTime pts(int frame) const noexcept { return MediaTime(first_pts + frame * frame_period); }
};

struct MockMediaProfile {
  std::vector<MockTrack> tracks{MockTrack{}};
  std::map<std::string, std::string> tags;
  bool live = false;    // unknown duration, cannot seek
  bool remote = false;  // see MediaSource::remote
  std::optional<Duration> sender_start;
  Duration longest_gap{0};  // see ContinuousTime

  // Faults. Packets are counted over all tracks since `open`.
  std::optional<ErrorCode> fail_open;
  std::uint64_t lose_after_packets = kNever;   // read answers Lost until closed
  std::uint64_t end_after_packets = kNever;    // a truncated file
  std::uint64_t stall_after_packets = kNever;  // one read takes `stall`, or less when interrupted
  Duration stall = std::chrono::seconds(2);
  std::uint64_t damaged_every = 0;            // every n-th packet; 0: none
  std::uint64_t jump_after_packets = kNever;  // `jump` is added to the container's times from there on
  Duration jump{0};
  Duration wrap{0};  // the container's times restart at 0 when they reach this; 0: never
};

// Three seconds of a ball that rolls back and forth on a wall, in colour and depth.
[[nodiscard]] MockMediaProfile mockFilm();
// True for a stream of a mock source.
[[nodiscard]] bool isMock(const StreamInfo& stream) noexcept;

// Ignores the URL. Only the mock decoder understands its packets (codec "mock").
[[nodiscard]] std::unique_ptr<MediaSource> makeMockSource(MockMediaProfile profile, Clock& clock);
// Opens the film of the given URL; NotFound if there is none.
[[nodiscard]] std::unique_ptr<MediaSource> makeMockSources(std::map<std::string, MockMediaProfile> films, Clock& clock);

struct MockDecoderProfile {
  std::size_t queue_packets = 4;  // packets accepted and not yet received; beyond that Full
  int reorder_frames = 0;         // pictures that it holds back until more packets come
  int max_held_frames = 8;        // it makes no further picture while this many are held
  int referenced_every = 1;       // only pictures whose number is a multiple of it are referred to by others

  // Faults.
  std::uint64_t lose_after_packets = kNever;  // feed answers Lost until closed
};

// Decodes a mock source's packets; Unsupported for any other stream.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeMockDecoder(MockDecoderProfile profile = {});

// The same for sound: any number of channels, at the requested rate.
[[nodiscard]] std::unique_ptr<AudioDecoder> makeMockAudioDecoder();

// ---- display
// -------------------------------------------------------------------------------------------------------

struct MockDisplayProfile {
  Duration refresh_period = std::chrono::microseconds(16'667);  // 0: shows at once

  StereoSignals stereo;  // that the screen takes

  // Faults.
  std::optional<ErrorCode> fail_open;
  std::uint64_t failing_opens = kNever;       // how often `open` fails
  std::uint64_t lose_after_frames = kNever;   // every call returns Lost until closed
  std::uint64_t close_after_frames = kNever;  // attend returns Cancelled, as if the viewer closed the window
  std::function<void()> shown;                // called when each picture reaches the screen
  // For a window: returns the files that the viewer has dropped on it since the last call.
  std::function<std::vector<std::string>()> dropped;
  std::function<void(const AnnouncedFilm&)> announced;
  std::function<void(FullScreen)> filled;
};

// The cable. Any thread.
struct MockDisplayBench {
  std::atomic<bool> unplugged{false};  // no screen: an open one is Lost, `open` returns NotFound
};

// Shows nothing, at the pace of its refresh: `present` sleeps until the next one.
[[nodiscard]] std::unique_ptr<Display> makeMockDisplay(const MockDisplayProfile& profile, Clock& clock,
                                                       std::shared_ptr<MockDisplayBench> bench = nullptr);

// ---- sound
// ---------------------------------------------------------------------------------------------------------

// For a test: what can be heard, and the cable. On the thread that uses the device.
struct MockAudioBench {
  // The sample of the first channel that a listener hears at a time; nullopt for silence. The time must not be before
  // the last call of the device.
  std::function<std::optional<float>(MonotonicTime)> heard;
  bool unplugged = false;  // every call returns Lost until closed
};

// A silent sink in real time, by its clock.
struct MockAudioProfile {
  const char* name = "null";
  std::optional<AudioFormat> format;  // the actual format, whatever is requested
  Duration buffer = std::chrono::milliseconds(500);
  double drift_ppm = 0;       // how much faster its crystal is than the clock
  Duration latency{0};        // from the buffer to the ear; included in its positions
  Duration start_latency{0};  // from the first write until playback begins; visible only in its positions
  Duration jitter{0};         // the largest error of its positions, either way

  // Faults.
  std::optional<ErrorCode> fail_open;
  std::uint64_t failing_opens = kNever;      // how often `open` fails
  std::uint64_t lose_after_frames = kNever;  // frames heard since `open`; then Lost until closed
  bool paced = true;                         // false: takes all at once and reports it as heard
};

[[nodiscard]] std::unique_ptr<AudioOutput> makeMockAudio(MockAudioProfile profile, const Clock& clock,
                                                         std::shared_ptr<MockAudioBench> bench = nullptr);

// ---- haptic device
// -------------------------------------------------------------------------------------------------

// For a test: the device's motors and its cable. Any thread.
struct MockHapticBench {
  std::atomic<double> force_x_n{0}, force_y_n{0}, force_z_n{0};  // the motors' current force
  std::atomic<std::uint64_t> reads{0}, writes{0};
  std::atomic<bool> unplugged{false};  // homing, reads and writes return Lost
  std::atomic<bool> glitch{false};     // the next read returns Io, once

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
  double most_rate_hz = kMostRateHz;
  // Where the finger is; no force moves it. Each read takes the next position of `path_mm` and stays at the last one.
  // If `path_mm` is empty, `position_mm` gives the position from the seconds since `start`; it must be real-time safe.
  // If both are empty, the finger rests in the middle.
  std::vector<glm::dvec3> path_mm;
  std::function<glm::dvec3(double)> position_mm;
  std::uint32_t buttons = 0;

  // Faults. Ticks are reads since `open`.
  std::optional<ErrorCode> fail_open;
  std::uint64_t fail_homing_after = kNever;   // then Timeout; counted since construction
  std::uint64_t lose_after_ticks = kNever;    // Lost until closed
  std::uint64_t glitch_after_ticks = kNever;  // one read returns Io
  bool refuses_force = false;                 // every write returns Io, the force stays zero
};

// `bench`: may be null.
[[nodiscard]] std::unique_ptr<HapticDevice> makeMockHaptic(MockHapticProfile profile, const Clock& clock,
                                                           std::shared_ptr<MockHapticBench> bench = nullptr);

}  // namespace relievo
