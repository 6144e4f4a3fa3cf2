// SPDX-License-Identifier: Apache-2.0
// Sets up the real-time side before it starts; at the end, ends the force first.
#include "app/player/touch/haptic_session.h"

#include <malloc.h>

#include <algorithm>
#include <span>
#include <utility>

#include "app/depth_window/touch_plan.h"
#include "app/haptics/method/relievo_method.h"

namespace relievo {
namespace {

// The same track for a hand that feels `scale` times the scene's values.
HeldScale inScene(HeldScale places, double scale) {
  if (places.stiffness_n_per_mm) *places.stiffness_n_per_mm /= scale;
  places.most_n_per_mm /= scale;
  places.most_ripple_n /= scale;
  return places;
}

HapticSummary::Times times(const Histogram& histogram) noexcept {
  return {histogram.quantile(0.5).count(), histogram.quantile(0.99).count(), histogram.quantile(0.999).count(),
          histogram.max().count()};
}

}  // namespace

HapticSession::HapticSession(HapticDevice* device, Clock& clock, Ticking ticking) noexcept
    : device_(device), clock_(clock), ticking_(ticking), thread_(clock) {
  if (device_ != nullptr) keeper_.emplace(*device_, clock_, ticking_ == Ticking::Thread);
}

HapticSession::~HapticSession() {
  stop();
}

void HapticSession::begin() {
  if (keeper_) keeper_->begin();
}

std::optional<DeviceKeeper::News> HapticSession::poll() {
  if (!keeper_) return std::nullopt;
  const auto news = keeper_->poll();
  if (news && news->kind == DeviceKeeper::News::Kind::Ready) {
    capabilities_ = device_->capabilities();
    period_ = fromSeconds(1.0 / std::clamp(capabilities_.rate_hz, 100.0, 8000.0));
    opened_ = true;
  }
  return news;
}

Result<void> HapticSession::setScene(const DisplayVolume& volume, const Material& material,
                                     const Material& material_scale, const LookAhead& ahead,
                                     const SurfaceWindow& first) {
  const SafetyLimits limits;
  const double most = capabilities_.max_stiffness_n_per_mm;
  const double most_n = std::min(limits.force_n, capabilities_.peak_force_n);
  HeldMaterial held = heldBy(material, kUsualStiffnessNPerMm, most, most_n);
  reduced_material_ = std::move(held.reduced);
  if (auto more = reducedScale(material_scale, most); !more.empty()) {
    reduced_material_ += (reduced_material_.empty() ? "" : "; ") + more;
  }
  // The hand feels the scene's values times the mapping's scale.
  const double scale = WorkspaceMapping(capabilities_, volume).scale();
  const double own = held.stiffness_n_per_mm / scale;
  const HeldScale places = inScene(scaleHeldBy(material_scale, material, most, most_n), scale);
  // The limits use one stiffness, the highest.
  const double stiffness =
      places.stiffness_n_per_mm ? std::max(own, std::min(*places.stiffness_n_per_mm, places.most_n_per_mm)) : own;
  TouchPlan plan = planFilm(std::span(first.frames).first(static_cast<std::size_t>(first.count)), ahead);
  plan_ = std::move(plan.reason);
  auto method = std::make_unique<RelievoMethod>(RelievoMethod::Config{.stiffness_n_per_mm = own,
                                                                      .scale = plan.scale,
                                                                      .friction = held.friction,
                                                                      .texture = held.texture,
                                                                      .places = places,
                                                                      .tick_s = toSeconds(period_)});
  if (task_ == nullptr) {
    auto arena = FixedArena::create(sizeof(HapticTask) + alignof(HapticTask) + 256);
    if (!arena) return std::unexpected(arena.error());
    arena_.emplace(std::move(*arena));
    task_ = arena_->make<HapticTask>(*device_, *method, clock_, volume, limits, stiffness);
    if (task_ == nullptr) return fail(ErrorCode::Exhausted, "the real-time arena is too small for the haptic task");
  } else {
    task_->changeScene(*method, volume, limits, stiffness);
  }
  method_ = std::move(method);

  // The method is an object of its own on the heap; the code is what the ticks run. Both are locked if
  // the process may lock memory: a page that is touched but not locked is lost only when memory runs short.
  memory_locked_ = arena_->locked();
  const bool locked = memory_locked_ && lockAndTouch(method_.get(), ::malloc_usable_size(method_.get())).has_value() &&
                      lockAndTouchCode().has_value();
  if (!locked) missing_memory_ = "memory not locked; raise LimitMEMLOCK (ulimit -l) or grant CAP_IPC_LOCK";
  return {};
}

Result<void> HapticSession::start(const DisplayVolume& volume, const Material& material, const Material& material_scale,
                                  const LookAhead& ahead, const SurfaceFeeder& first) {
  if (!waiting()) return fail(ErrorCode::InvalidState, "the haptic task needs a device that is homed and stopped");
  SurfaceWindow window;
  first.fill(window);
  if (!new_scene_) {
    task_->deviceIsBack();
  } else if (auto set = setScene(volume, material, material_scale, ahead, window); !set) {
    stop();  // not the device's doing: another try would fail as well
    return set;
  }
  new_scene_ = false;
  task_->windowToFill() = std::move(window);
  task_->publishWindow();
  auto running = run();
  if (!running) {
    halt();
    begin();
  }
  return running;
}

Result<void> HapticSession::run() {
  if (auto started = device_->start(); !started) return started;
  running_ = true;
  if (ticking_ == Ticking::ByHand) {
    next_tick_ = clock_.now();
    return {};
  }
  CyclicConfig config;
  config.name = "relievo-haptic";
  config.period = period_;
  const auto scheduler = thread_.start(config, *task_);
  if (!scheduler) return std::unexpected(scheduler.error());
  if (*scheduler == Scheduler::Other) {
    missing_scheduler_ = "no permission for SCHED_FIFO; grant CAP_SYS_NICE or raise LimitRTPRIO (ulimit -r)";
  }
  return {};
}

void HapticSession::halt() noexcept {
  thread_.stop();
  if (device_ != nullptr) device_->close();
  if (task_ != nullptr) task_->forgetWindows();
  running_ = false;
  opened_ = false;
}

void HapticSession::rest() noexcept {
  if (running_) {
    thread_.stop();
    device_->stop();
    task_->forgetWindows();
    running_ = false;
  }
  new_scene_ = true;
}

void HapticSession::stop() noexcept {
  if (keeper_) keeper_->stop();
  halt();
}

void HapticSession::publish(const SurfaceFeeder& surface) noexcept {
  if (!running_) return;
  surface.fill(task_->windowToFill());
  task_->publishWindow();
}

const FingerState* HapticSession::finger() noexcept {
  if (!running_) return nullptr;
  static_cast<void>(task_->refreshFinger());
  return task_->finger().device_present ? &task_->finger() : nullptr;
}

std::optional<FingerState> HapticSession::nextTick() noexcept {
  return task_ == nullptr ? std::nullopt : task_->nextTick();
}

std::optional<HapticFault> HapticSession::nextFault() {
  auto fault = task_ == nullptr ? std::nullopt : task_->nextFault();
  if (fault && fault->kind == HapticFault::Kind::DeviceLost && running_) {
    halt();
    begin();
  }
  return fault;
}

void HapticSession::printLog() noexcept {
  if (task_ != nullptr) task_->printLog();
}

MonotonicTime HapticSession::nextTickByHand() const noexcept {
  return running_ && ticking_ == Ticking::ByHand ? next_tick_ : MonotonicTime::max();
}

void HapticSession::tickByHand() noexcept {
  clock_.sleepUntil(next_tick_);
  static_cast<void>(task_->loop({.index = tick_index_++, .scheduled = next_tick_, .woken = clock_.now()}));
  next_tick_ += period_;
}

HapticSummary HapticSession::summary() const {
  HapticSummary s;
  s.scheduler = "none";
  if (task_ == nullptr) return s;
  const CyclicStatistics& cyclic = thread_.statistics();
  const HapticCounters& counters = task_->counters();
  s.device = capabilities_.name;
  s.scheduler = ticking_ == Ticking::ByHand                  ? "simulated time"
                : cyclic.scheduler.load() == Scheduler::Fifo ? "SCHED_FIFO"
                                                             : "SCHED_OTHER";
  s.memory_locked = memory_locked_;
  s.memory = {.task = arena_->capacity(),
              .method = ::malloc_usable_size(method_.get()),
              .stack = cyclic.stack_bytes,
              .counters = cyclic.other_bytes,
              .stack_used = cyclic.stack_used_bytes};
  s.rate_hz = 1.0 / toSeconds(period_);
  s.ticks = counters.ticks;
  s.contact_ticks = counters.contact_ticks;
  s.overruns = cyclic.overruns;
  s.allocations = cyclic.allocations;
  s.page_faults = cyclic.page_faults;
  s.update = times(counters.update);
  s.wakeup = times(cyclic.wakeup);
  if (const Histogram* const told = device_->contactDelays()) s.contact_told = times(*told);
  cyclic.wakeup.forEachBucket(
      [&](Duration time, std::uint64_t ticks) { s.wakeup_histogram.push_back({time.count(), ticks}); });
  s.max_force_n = counters.max_force_n;
  s.max_scene_slew_n_per_s = counters.max_scene_slew_n_per_s;
  s.plan = plan_;
  s.scene_mj = counters.scene_energy_mj;
  s.artefact_mj = counters.artefact_energy_mj;
  return s;
}

}  // namespace relievo
