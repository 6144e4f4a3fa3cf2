// SPDX-License-Identifier: Apache-2.0
// Situations in which touch methods are known to fail, each a short film and a finger, with a verdict.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "app/haptics/method/method.h"
#include "app/lab/scenario/judge.h"
#include "app/scene/material.h"

namespace relievo {

// A method to be judged: makes a fresh instance for a film.
struct Challenger {
  std::string name;
  std::function<std::unique_ptr<TouchMethod>(double stiffness_n_per_mm, std::span<const TimedSurface> film)> make;
  double stiffness_n_per_mm = 0.5;  // the task's stiffness, also passed to `make`; `stiff-wall` uses its own
};
// A method as the player makes it: `relievo` with the widths that its plan picks when the film begins; `god-object`,
// and `god-object-smoothed` on frames blurred by the width that suits the film best (blurWidthMm).
[[nodiscard]] Challenger challengerNamed(const std::string& method);
// `relievo` on a film with this material.
[[nodiscard]] Challenger challengerMadeOf(const Material& material);

// The method runs in the haptic task itself, with all its limits, on virtual time: the same verdict at every run.
struct Scenario {
  const char* name;
  const char* about;
  Verdict (*judge)(const Challenger& challenger, bool quick);
};

// In the order of the map.
[[nodiscard]] std::span<const Scenario> scenarios();

namespace scenario {

// The scene is still or moves steadily; the finger is rigid.
Verdict riseFree(const Challenger& challenger, bool quick);
Verdict riseContact(const Challenger& challenger, bool quick);
Verdict riseFast(const Challenger& challenger, bool quick);
Verdict sweepEdge(const Challenger& challenger, bool quick);
Verdict strokeStep(const Challenger& challenger, bool quick);
Verdict thin(const Challenger& challenger, bool quick);
Verdict noise(const Challenger& challenger, bool quick);
Verdict fastHip(const Challenger& challenger, bool quick);
// Closed paths.
Verdict energyLoop(const Challenger& challenger, bool quick);
// The film is not one steady shot, or does not come as it should.
Verdict cutUp(const Challenger& challenger, bool quick);
Verdict cutDown(const Challenger& challenger, bool quick);
Verdict holdVideo(const Challenger& challenger, bool quick);
Verdict frameDrop(const Challenger& challenger, bool quick);
Verdict underrun(const Challenger& challenger, bool quick);
Verdict seek(const Challenger& challenger, bool quick);
Verdict pause(const Challenger& challenger, bool quick);
Verdict packetLoss(const Challenger& challenger, bool quick);
// The machine or the device is the trouble.
Verdict stiffWall(const Challenger& challenger, bool quick);
Verdict jitter(const Challenger& challenger, bool quick);
Verdict deviceGlitch(const Challenger& challenger, bool quick);
// What ordinary recordings do: written down before any method was run on it.
Verdict flicker(const Challenger& challenger, bool quick);
Verdict dropout(const Challenger& challenger, bool quick);
Verdict passBefore(const Challenger& challenger, bool quick);
Verdict coarseSteps(const Challenger& challenger, bool quick);
Verdict cameraMove(const Challenger& challenger, bool quick);

}  // namespace scenario
}  // namespace relievo
