// SPDX-License-Identifier: Apache-2.0
// The haptic task itself on virtual time, with a device that says what it is told and a film in memory.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/haptics/task/haptic_task.h"
#include "app/lab/film/memory_feed.h"
#include "app/scene/display_volume.h"

namespace relievo {

struct StageTick {
  double t_s = 0;        // of the machine, from the beginning
  double elapsed_s = 0;  // since the tick before
  MediaTime media;
  glm::dvec3 hip_mm{0};    // as the device says
  Touch asked;             // by the method
  glm::dvec3 sent_n{0};    // after the limits; of a failed exchange: what the device holds
  bool exchanged = false;  // the device answered
};

class TouchStage {
 public:
  static constexpr double kTickS = 0.001;
  struct Options {
    DisplayVolume volume;
    double stiffness_n_per_mm = 0.5;
    double peak_force_n = 10;
    SafetyLimits limits;
  };

  // `method` outlives it, and is reset.
  TouchStage(TouchMethod& method, const Options& options);
  ~TouchStage();

  // The film stands at `media` now and runs at `rate`; `window`: its frames, when they are others than before.
  void show(MediaTime media, double rate, const SurfaceWindow* window);
  // The next tick, `ticks` after the last one. No position: the exchange fails.
  StageTick tick(const std::optional<glm::dvec3>& hip_mm, int ticks = 1);
  [[nodiscard]] double now() const { return now_s_; }

 private:
  class Handle;
  class Overheard;
  std::unique_ptr<Overheard> method_;
  std::unique_ptr<Handle> handle_;
  ManualClock clock_;
  std::unique_ptr<HapticTask> task_;
  SurfaceWindow window_;
  MonotonicTime started_;
  std::uint64_t index_ = 0;
  double now_s_ = 0;
};

// A whole play of a film under a finger.
struct Play {
  std::span<const TimedSurface> film;
  double duration_s = 1;
  double stiffness_n_per_mm = 0.5;
  double peak_force_n = 10;
  // Where the device says that the finger is, given the force that it holds; nothing: the exchange fails.
  std::function<std::optional<glm::dvec3>(double t_s, const glm::dvec3& held_n)> finger;
  // Which moment of the film is felt at the machine's time; by default the film plays from 0 on.
  struct Moment {
    double media_s = 0;
    double rate = 1;
    std::uint32_t epoch = 0;
  };
  std::function<Moment(double t_s)> clock = [](double t) { return Moment{.media_s = t}; };
  MemoryFeed::Supply supply;
  std::function<int(double t_s)> ticks_to_next = [](double) { return 1; };  // more than 1: ticks are missed
};
[[nodiscard]] std::vector<StageTick> playThrough(TouchMethod& method, const Play& play);

}  // namespace relievo
