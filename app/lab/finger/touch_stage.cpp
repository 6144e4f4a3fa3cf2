// SPDX-License-Identifier: Apache-2.0
// Everything between film and finger is the player's own code, except the device.
#include "app/lab/finger/touch_stage.h"

#include "app/lab/film/made_film.h"

namespace relievo {

// Its workspace's centre is that of the volume, and its ends are far away: device millimetres are scene millimetres.
class TouchStage::Handle final : public HapticDevice {
 public:
  explicit Handle(const Options& options) : options_(options) {}
  std::optional<glm::dvec3> position;
  glm::dvec3 held{0};

  [[nodiscard]] HapticCapabilities capabilities() const noexcept override {
    const glm::dvec3 centre_mm(0, 0, 0.5 * options_.volume.depth_mm);
    return {.name = "stage",
            .workspace_min_mm = centre_mm - 1000.0,
            .workspace_max_mm = centre_mm + 1000.0,
            .peak_force_n = options_.peak_force_n,
            .continuous_force_n = options_.peak_force_n,
            .max_stiffness_n_per_mm = options_.stiffness_n_per_mm};
  }

 private:
  Result<void> openDevice() override { return {}; }
  Result<void> homeDevice() override { return {}; }
  Result<void> startDevice() override { return {}; }
  Result<HapticSample> readSample() RELIEVO_RT override {
    if (!position) return fail(ErrorCode::Io, "the scenario lets this read fail");
    return HapticSample{.position_mm = *position};
  }
  Result<void> writeForce(const glm::dvec3& force_n) RELIEVO_RT override {
    held = force_n;
    return {};
  }
  void stopDevice() noexcept override { held = glm::dvec3(0); }
  void closeDevice() noexcept override {}

  Options options_;
};

class TouchStage::Overheard final : public TouchMethod {
 public:
  explicit Overheard(TouchMethod& method) : method_(method) {}
  Touch last;

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override {
    return last = method_.update(hip_mm, window, now);
  }
  void upkeep(const SurfaceWindow& window, MediaTime now) RELIEVO_RT override { method_.upkeep(window, now); }
  void reset() RELIEVO_RT override { method_.reset(); }

 private:
  TouchMethod& method_;
};

TouchStage::TouchStage(TouchMethod& method, const Options& options)
    : method_(std::make_unique<Overheard>(method)),
      handle_(std::make_unique<Handle>(options)),
      clock_(MonotonicTime{} + std::chrono::seconds(1)),
      started_(clock_.now()) {
  method.reset();
  // The simulated handle cannot fail here.
  static_cast<void>(handle_->open() && handle_->home() && handle_->start());
  task_ = std::make_unique<HapticTask>(*handle_, *method_, clock_, options.volume, options.limits,
                                       options.stiffness_n_per_mm);
}

TouchStage::~TouchStage() = default;

void TouchStage::show(MediaTime media, double rate, const SurfaceWindow* window) {
  const ClockSample& clock = window_.clock;
  const bool on_time = clock.rate == rate && std::chrono::abs(clock.at(clock_.now()) - media) < Duration(1000);
  if (on_time && window == nullptr) return;
  const ClockSample before = clock;
  if (window != nullptr) window_ = *window;
  window_.clock = on_time ? before : ClockSample{.media = media, .monotonic = clock_.now(), .rate = rate};
  task_->windowToFill() = window_;
  task_->publishWindow();
}

StageTick TouchStage::tick(const std::optional<glm::dvec3>& hip_mm, int ticks) {
  const Duration elapsed = ticks * fromSeconds(kTickS);
  handle_->position = hip_mm;
  method_->last = {};
  const MonotonicTime woken = clock_.now();
  static_cast<void>(task_->loop({index_, woken, woken}));
  index_ += static_cast<std::uint64_t>(ticks);
  const StageTick done{.t_s = now_s_,
                       .media = window_.clock.at(woken),
                       .hip_mm = hip_mm.value_or(glm::dvec3(0)),
                       .asked = method_->last,
                       .sent_n = handle_->held,
                       .exchanged = hip_mm.has_value()};
  clock_.advance(elapsed);
  now_s_ = toSeconds(clock_.now() - started_);
  return done;
}

std::vector<StageTick> playThrough(TouchMethod& method, const Play& play) {
  TouchStage stage(method, {.volume = MadeFormat::kVolume,
                            .stiffness_n_per_mm = play.stiffness_n_per_mm,
                            .peak_force_n = play.peak_force_n});
  MemoryFeed feed(play.film, play.supply);
  SurfaceWindow window;
  std::vector<StageTick> ticks;
  glm::dvec3 held(0);
  while (stage.now() < play.duration_s) {
    const double t = stage.now();
    const Play::Moment moment = play.clock(t);
    const MediaTime media = mediaTime(moment.media_s);
    const bool other = feed.update(media, t, moment.epoch, window);
    stage.show(media, moment.rate, other ? &window : nullptr);
    ticks.push_back(stage.tick(play.finger(t, held), play.ticks_to_next(t)));
    ticks.back().elapsed_s = ticks.size() > 1 ? t - ticks[ticks.size() - 2].t_s : 0;
    held = ticks.back().sent_n;
  }
  return ticks;
}

}  // namespace relievo
