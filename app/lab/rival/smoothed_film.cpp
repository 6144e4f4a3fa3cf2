// SPDX-License-Identifier: Apache-2.0
// Smoothed heights are stored as gray frames, so that every method can read them.
#include "app/lab/rival/smoothed_film.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <thread>

#include "app/lab/film/parallel.h"
#include "platform/clock.h"
#include "platform/memory/huge_pages.h"

namespace relievo {
namespace {

struct SmoothedPictures {
  std::vector<Frame> pictures;
  DepthCalibration calibration{.bits = 16};
};

SmoothedPictures smoothAll(std::span<const TimedSurface> frames, double sigma_mm, DepthSmoother::Order order) {
  SmoothedPictures done;
  done.pictures.resize(frames.size());
  std::atomic<bool> hole = false;
  const std::size_t parts = std::max(1U, std::thread::hardware_concurrency());
  inParallel(parts, [&](std::size_t part) {
    if (frames.empty()) return;
    DepthSmoother smoother(frames.front().field, sigma_mm, order);
    for (std::size_t i = part; i < frames.size(); i += parts) {
      if (frames[i].repeats && i > 0) continue;
      const auto codes = std::make_shared<std::vector<std::uint16_t>>();
      const std::size_t count = static_cast<std::size_t>(smoother.cols()) * static_cast<std::size_t>(smoother.rows());
      codes->reserve(count);
      askForHugePages(codes->data(), 2 * count);  // the rivals' pictures get the same kind of memory as the film's
      codes->resize(count);
      if (smoother.smooth(frames[i].field, *codes)) hole = true;
      done.pictures[i] = grayFrame(codes, smoother.cols(), smoother.rows());
      done.pictures[i].pts = frames[i].time;
    }
  });
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!frames[i].repeats) continue;
    done.pictures[i] = done.pictures[i - 1];
    done.pictures[i].pts = frames[i].time;
  }
  if (hole) done.calibration.invalid = DepthSmoother::kHole;
  return done;
}

DisplayVolume volumeOf(const HeightField& field) {
  return {field.cols() / field.grid().u_per_mm, -field.rows() / field.grid().v_per_mm, field.depthMm()};
}

class OnSmoothedDepth final : public TouchMethod {
 public:
  OnSmoothedDepth(std::unique_ptr<TouchMethod> method, std::span<const TimedSurface> film, double sigma_mm)
      : method_(std::move(method)) {
    const SmoothedPictures smoothed = smoothAll(film, sigma_mm, DepthSmoother::Order::First);
    for (std::size_t i = 0; i < film.size(); ++i) {
      TimedSurface frame = film[i];
      const Frame& picture = smoothed.pictures[i];
      if (const auto field = HeightField::make(picture, smoothed.calibration, volumeOf(film[i].field))) {
        frame.field = *field;
        frame.owner = picture.owner;
      }
      film_.push_back(std::move(frame));
    }
  }

  [[nodiscard]] Touch update(const glm::dvec3& hip_mm, const SurfaceWindow& window, MediaTime now) RELIEVO_RT override {
    window_.count = window.count;
    window_.epoch = window.epoch;
    window_.clock = window.clock;
    window_.ended = window.ended;
    for (std::size_t i = 0; i < static_cast<std::size_t>(window.count); ++i) {
      TimedSurface& frame = window_.frames[i];  // without an owner: `film_` keeps the samples
      frame.time = window.frames[i].time;
      frame.shot = window.frames[i].shot;
      frame.repeats = window.frames[i].repeats;
      frame.field = smoothedAt(frame.time);
    }
    return method_->update(hip_mm, window_, now);
  }
  void upkeep(const SurfaceWindow& /*window*/, MediaTime now) RELIEVO_RT override { method_->upkeep(window_, now); }
  void reset() RELIEVO_RT override { method_->reset(); }

 private:
  // The film's last frame at or before this time.
  [[nodiscard]] const HeightField& smoothedAt(MediaTime time) const RELIEVO_RT {
    std::size_t i = film_.size() - 1;
    while (i > 0 && film_[i].time > time) --i;
    return film_[i].field;
  }

  std::unique_ptr<TouchMethod> method_;
  std::vector<TimedSurface> film_;
  SurfaceWindow window_;
};

}  // namespace

double blurWidthMm(const ClipMeasure& clip) {
  constexpr double kLeastMm = 0.14, kMostMm = 2.5, kFlattening = 0.012, kNoise = 0.282, kSteps = 2 * 7.09, kCoded = 2;
  const double steps_mm = (isCoded(clip) ? kCoded : 1) * clip.quantum_mm;
  const auto error = [&](double w) {
    return std::hypot(kNoise * clip.noise_mm * clip.sample_mm / (w * w), steps_mm / (kSteps * w), kFlattening * w * w);
  };
  double width = kLeastMm, wider = width * 1.02;
  while (wider <= kMostMm && error(wider) < error(width)) {
    width = wider;
    wider *= 1.02;
  }
  return width;
}

MemoryFilm smoothedFilm(const MemoryFilm& film, double sigma_mm, DepthSmoother::Order order) {
  const SmoothedPictures smoothed = smoothAll(film.frames(), sigma_mm, order);
  return *MemoryFilm::of(smoothed.pictures, smoothed.calibration);  // gray pictures are always readable
}

std::unique_ptr<TouchMethod> onSmoothedDepth(std::unique_ptr<TouchMethod> method, std::span<const TimedSurface> film,
                                             double sigma_mm) {
  return std::make_unique<OnSmoothedDepth>(std::move(method), film, sigma_mm);
}

FrameStopwatch::FrameStopwatch(const MemoryFilm& film, double sigma_mm)
    : frames_(film.frames()),
      smoother_(frames_.front().field, sigma_mm),
      codes_(static_cast<std::size_t>(smoother_.cols()) * static_cast<std::size_t>(smoother_.rows())) {}

void FrameStopwatch::timeOne() {
  const MonotonicClock clock;
  const MonotonicTime begin = clock.now();
  static_cast<void>(smoother_.smooth(frames_[count_++ % frames_.size()].field, codes_));
  least_ms_ = std::min(least_ms_, 1e3 * toSeconds(clock.now() - begin));
}

}  // namespace relievo
