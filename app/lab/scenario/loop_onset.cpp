// SPDX-License-Identifier: Apache-2.0
// A closed loop of a device and a method alone.
#include "app/lab/scenario/loop_onset.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/lab/film/made_film.h"
#include "app/lab/film/memory_feed.h"
#include "app/lab/scenario/scenario_tools.h"

namespace relievo {
namespace {

constexpr double kPushNPerKhz = 1, kOffMm = 0.2;
constexpr double kSeconds = 2;

// With dry friction or an encoder, an oscillation is a swing larger than two steps of the encoder; without them, a
// swing that is larger than at the start or does not decay.
bool swings(const Swing& swing, const DeviceProfile& profile) {
  if (profile.encoder_step_mm > 0) return swing.last_mm > 2 * profile.encoder_step_mm;
  return swing.last_mm > 2.2 * kOffMm || (swing.last_mm > 1e-3 && swing.last_mm >= swing.before_mm);
}

}  // namespace

Swing swingOnWall(const Challenger& challenger, const DeviceProfile& profile, double stiffness) {
  static const auto film = makeFilm(scenario::plane(20, 0, 0), {}, 0.1);
  const auto method = challenger.make(stiffness, film);
  MemoryFeed feed(film);
  SurfaceWindow window;
  // Stiffer walls are stable at higher rates: the finger rests in them as deep as at 1 kHz, and does not leave them.
  const double push_n = kPushNPerKhz * profile.rate_hz / 1000;
  const glm::dvec3 above(0.1, 0.1, 20.5), rest(0.1, 0.1, 20 - push_n / stiffness);
  // Comes in from outside, as every method requires.
  static_cast<void>(feed.update({}, 0, 0, window));
  static_cast<void>(method->update(above, window, {}));
  HandLoop hand(profile, rest + glm::dvec3(0, 0, kOffMm));
  std::array<glm::dvec2, 4> extremes;  // low and high of each quarter
  extremes.fill({1e9, -1e9});
  const auto ticks = static_cast<int>(std::lround(kSeconds * profile.rate_hz));
  for (int tick = 0; tick < ticks; ++tick) {
    const MediaTime now = mediaTime((tick + 1) / profile.rate_hz);
    static_cast<void>(feed.update(now, 0, 0, window));
    const Touch touch = method->update(hand.encoded(), window, now);
    hand.tick(touch.force_n, rest, {0, 0, -push_n});
    method->upkeep(window, now);
    glm::dvec2& extreme = extremes[static_cast<std::size_t>(static_cast<std::int64_t>(tick) * 4 / ticks)];
    extreme = {std::min(extreme.x, hand.position().z), std::max(extreme.y, hand.position().z)};
  }
  return {extremes[2].y - extremes[2].x, extremes[3].y - extremes[3].x};
}

std::optional<double> loopOnset(const Challenger& challenger, const DeviceProfile& profile, double most) {
  if (!swings(swingOnWall(challenger, profile, most), profile)) return std::nullopt;
  double rests = 0.02 * most, cycles = most;
  while (cycles - rests > 0.01 * cycles) {
    const double middle = 0.5 * (rests + cycles);
    (swings(swingOnWall(challenger, profile, middle), profile) ? cycles : rests) = middle;
  }
  return 0.5 * (rests + cycles);
}

}  // namespace relievo
