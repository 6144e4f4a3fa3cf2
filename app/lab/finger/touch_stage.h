// SPDX-License-Identifier: Apache-2.0
// Runs the haptic task itself on virtual time, with a device whose position the caller sets, and a film in memory.
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
  double t_s = 0;        // machine time from the beginning
  double elapsed_s = 0;  // since the tick before
  MediaTime media;
  glm::dvec3 hip_mm{0};    // as the device reports it
  Touch asked;             // by the method
  glm::dvec3 sent_n{0};    // after the limits; after a failed exchange: the force that the device holds
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

  // `method` must outlive it, and is reset.
  TouchStage(TouchMethod& method, const Options& options);
  ~TouchStage();

  // From now on the film is at `media` and runs at `rate`. `window`: its new frames; null: unchanged.
  void show(MediaTime media, double rate, const SurfaceWindow* window);
  // Runs the next tick, `ticks` after the last one. Without a position the exchange fails.
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

// A whole run of a film under a finger.
struct Play {
  std::span<const TimedSurface> film;
  double duration_s = 1;
  double stiffness_n_per_mm = 0.5;
  double peak_force_n = 10;
  // The finger's position that the device reports, given the force that it applies; nullopt: the exchange fails.
  std::function<std::optional<glm::dvec3>(double t_s, const glm::dvec3& held_n)> finger;
  // The film's position at a machine time; by default the film plays from 0 on.
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
