// SPDX-License-Identifier: Apache-2.0
// Plain rounds without outlier removal, since the tail is of interest.
#include "app/lab/measure/tick_timing.h"

#include <algorithm>
#include <cstdint>

#include "app/lab/rival/smoothed_film.h"

namespace relievo {
namespace {

constexpr int kColdBlurs = 5;

class Samples {
 public:
  void add(const PlayedTick& tick, Duration clock) {
    update_us_.push_back(microseconds(tick.update - clock));
    upkeep_us_.push_back(microseconds(tick.upkeep - 2 * clock));  // two intervals
    whole_us_.push_back(update_us_.back() + upkeep_us_.back());
  }
  [[nodiscard]] TickTimes times(int rounds) const {
    const auto own = [rounds](const std::vector<double>& us) { return spreadOf(mediansOfRounds(us, rounds)); };
    return {.update = spreadOf(update_us_),
            .upkeep = spreadOf(upkeep_us_),
            .whole = spreadOf(whole_us_),
            .own_update = own(update_us_),
            .own_upkeep = own(upkeep_us_),
            .own_whole = own(whole_us_)};
  }

 private:
  static double microseconds(Duration d) { return std::max(0.0, toSeconds(d) * 1e6); }
  std::vector<double> update_us_, upkeep_us_, whole_us_;
};

std::vector<TickTimes> timesOf(const std::vector<Samples>& samples, int rounds) {
  std::vector<TickTimes> times;
  times.reserve(samples.size());
  for (const Samples& s : samples) times.push_back(s.times(rounds));
  return times;
}

double ticksOfAFrame(const TimedPath& timed) {
  const auto frames = timed.film.raw().frames();
  const double period_s = toSeconds(frames.back().time - frames.front().time) /
                          static_cast<double>(std::max<std::size_t>(frames.size(), 2) - 1);
  const double tick_s = (timed.path.back().t_s - timed.path.front().t_s) /
                        static_cast<double>(std::max<std::size_t>(timed.path.size(), 2) - 1);
  return period_s / tick_s;
}

void addBlur(std::vector<TickTimes>& times, std::span<const Contender* const> contenders, double blur_ms,
             const TimedPath& timed) {
  for (std::size_t m = 0; m < times.size(); ++m) {
    if (!contenders[m]->smoothed) continue;
    times[m].frame_ms = blur_ms;
    times[m].frame_us_per_tick = 1e3 * blur_ms / ticksOfAFrame(timed);
  }
}

// Larger than the caches of common machines, except the last level of the largest servers.
class CacheSweep {
 public:
  void operator()() {
    for (std::uint64_t& word : words_) ++word;
  }

 private:
  std::vector<std::uint64_t> words_ = std::vector<std::uint64_t>(std::size_t{96} * 1024 * 1024 / sizeof(std::uint64_t));
};

}  // namespace

Duration clockCost() {
  const MonotonicClock clock;
  std::vector<double> costs(100001);
  for (double& cost : costs) {
    const MonotonicTime begin = clock.now();
    cost = static_cast<double>((clock.now() - begin).count());
  }
  return Duration(static_cast<Duration::rep>(spreadOf(std::move(costs)).median));
}

std::vector<TickTimes> timeTicks(std::span<const Contender* const> contenders, const TimedPath& timed, int rounds) {
  const Duration clock = clockCost();
  std::vector<Samples> samples(contenders.size());
  std::vector<std::unique_ptr<TouchMethod>> methods;
  for (const Contender* c : contenders) methods.push_back(c->make(timed.film.raw()));
  FrameStopwatch blur(timed.film.raw(), timed.film.sigmaMm());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      FilmRun run(timed.film.of(*contenders[m]), *methods[m]);
      for (std::size_t i = 0; i < timed.path.size(); ++i) {
        const PlayedTick tick = run.tick(timed.path[i]);
        if (i >= timed.skipped_ticks) samples[m].add(tick, clock);
      }
    }
    blur.timeOne();
  }
  std::vector<TickTimes> times = timesOf(samples, rounds);
  addBlur(times, contenders, blur.leastMs(), timed);
  return times;
}

std::vector<TickTimes> timeColdTicks(std::span<const Contender* const> contenders, const TimedPath& timed,
                                     std::size_t ticks) {
  const Duration clock = clockCost();
  CacheSweep sweep;
  std::vector<Samples> samples(contenders.size());
  std::vector<std::unique_ptr<TouchMethod>> methods;
  std::vector<FilmRun> runs;
  for (const Contender* c : contenders) methods.push_back(c->make(timed.film.raw()));
  runs.reserve(methods.size());
  for (std::size_t m = 0; m < methods.size(); ++m) runs.emplace_back(timed.film.of(*contenders[m]), *methods[m]);
  const std::size_t end = std::min(timed.path.size(), timed.skipped_ticks + ticks);
  for (std::size_t i = 0; i < end; ++i) {
    for (std::size_t m = 0; m < runs.size(); ++m) {
      if (i >= timed.skipped_ticks) sweep();
      const PlayedTick tick = runs[m].tick(timed.path[i]);
      if (i >= timed.skipped_ticks) samples[m].add(tick, clock);
    }
  }
  FrameStopwatch blur(timed.film.raw(), timed.film.sigmaMm());
  for (int frame = 0; frame < kColdBlurs; ++frame) {
    sweep();
    blur.timeOne();
  }
  std::vector<TickTimes> times = timesOf(samples, 1);
  addBlur(times, contenders, blur.leastMs(), timed);
  return times;
}

}  // namespace relievo
