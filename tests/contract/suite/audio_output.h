// SPDX-License-Identifier: Apache-2.0
// The contract of every sound output: states, whole frames, room, and positions that advance at its rate. List the back
// ends in a test of your own: INSTANTIATE_TEST_SUITE_P(Backends, AudioOutputContract, testing::Values(..),
// test::kBackendName).
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>

#include "hal/audio_output.h"
#include "platform/clock.h"
#include "tests/contract/suite/backend_name.h"

namespace relievo {
namespace test {

// An output whose card plays by the test's clock, and a switch that pulls the card out or puts it back.
struct AudioOutputRig {
  std::unique_ptr<AudioOutput> audio;
  std::function<void(bool)> unplug;
};

struct AudioOutputBackend {
  const char* name;
  std::function<AudioOutputRig(ManualClock&)> make;
};
inline void PrintTo(const AudioOutputBackend& backend, std::ostream* out) {
  *out << backend.name;
}

// Of a static library the linker takes only what is referenced. This reference brings the suite's cases into every
// program that includes this header.
[[nodiscard]] bool audioOutputCases();
inline const bool kAudioOutputCases = audioOutputCases();

}  // namespace test

class AudioOutputContract : public testing::TestWithParam<test::AudioOutputBackend> {
 protected:
  using State = AudioOutput::State;

  void SetUp() override { output_ = GetParam().make(clock_); }
  [[nodiscard]] AudioOutput& audio() const { return *output_.audio; }
  // Writes sound of that length and returns how many frames were taken.
  std::int64_t write(Duration length);
  [[nodiscard]] std::optional<AudioPosition> position() const;

  ManualClock clock_{MonotonicTime(std::chrono::hours(1))};
  test::AudioOutputRig output_;
};

}  // namespace relievo
