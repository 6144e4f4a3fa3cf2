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

// One video track. Pictures are planar, 8 bits in a byte, more in two, and each row is followed by some bytes
// of no meaning, so that who mistakes the width for the stride is caught.
struct MockTrack {
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
  std::map<std::string, std::string> tags;
  // Value of a sample: (frame, component, column, row). Called on the decoder's thread. Default: a slope that
  // moves.
  std::function<std::uint16_t(int, int, int, int)> sample;

  [[nodiscard]] MediaTime pts(int frame) const noexcept { return MediaTime(first_pts + frame * frame_period); }
};

struct MockMediaProfile {
  std::vector<MockTrack> tracks{MockTrack{}};
  std::map<std::string, std::string> tags;
  bool live = false;  // of unknown duration, cannot seek

  // Faults. Packets are counted over all tracks since `open`.
  std::optional<ErrorCode> fail_open;
  std::uint64_t lose_after_packets = kNever;   // read answers Lost until closed
  std::uint64_t end_after_packets = kNever;    // a file that is cut off
  std::uint64_t stall_after_packets = kNever;  // one read takes `stall`, or less when interrupted
  Duration stall = std::chrono::seconds(2);
  std::uint64_t damaged_every = 0;  // every n-th packet; 0: none
};

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

// ---- display
// -------------------------------------------------------------------------------------------------------

struct MockDisplayProfile {
  Duration refresh_period = std::chrono::microseconds(16'667);  // 0: shows at once

  // Faults.
  std::optional<ErrorCode> fail_open;
  std::uint64_t failing_opens = kNever;       // how often it fails
  std::uint64_t lose_after_frames = kNever;   // every verb answers Lost until closed
  std::uint64_t close_after_frames = kNever;  // attend answers Cancelled: the viewer has closed it
};

// Shows nothing, at the pace of its refresh: `present` sleeps until the next one.
[[nodiscard]] std::unique_ptr<Display> makeMockDisplay(const MockDisplayProfile& profile, Clock& clock);

// ---- haptic device
// -------------------------------------------------------------------------------------------------

// What an observer sees of the device from outside, and the cable that it may pull. Any thread.
struct MockHapticBench {
  std::atomic<double> force_x_n{0}, force_y_n{0}, force_z_n{0};  // in the motors at this moment
  std::atomic<std::uint64_t> reads{0}, writes{0};
  std::atomic<bool> unplugged{false};  // homing and every exchange answer Lost

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
