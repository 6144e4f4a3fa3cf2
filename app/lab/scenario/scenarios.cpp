// SPDX-License-Identifier: Apache-2.0
// The list of scenarios.
#include "app/lab/scenario/scenarios.h"

#include <array>

#include "app/depth_window/touch_plan.h"
#include "app/haptics/baseline/methods.h"
#include "app/lab/film/memory_feed.h"
#include "app/lab/rival/smoothed_film.h"

namespace relievo {
namespace {

constexpr std::array<Scenario, 25> kScenarios{{
    {"rise-free", "a surface rises to a free finger and past it, 60 mm/s", scenario::riseFree},
    {"rise-contact", "a dome slides and rises under a pressed finger, 60 mm/s", scenario::riseContact},
    {"rise-fast", "a surface rises past a free finger at 3 m/s", scenario::riseFast},
    {"sweep-edge", "a block sweeps sideways over a free finger, 200 mm/s", scenario::sweepEdge},
    {"cut-up", "a cut raises the scene by 18 mm under a pressed finger", scenario::cutUp},
    {"cut-down", "a cut lowers the scene by 9 mm under a pressed finger", scenario::cutDown},
    {"hold-video", "a finger held still on a scene that begins to nod, 15 frames/s", scenario::holdVideo},
    {"stroke-step", "a finger strokes over a step of 15 mm and comes back at its wall", scenario::strokeStep},
    {"thin", "a finger pushes sideways at ridges 3 pixels thin", scenario::thin},
    {"noise", "noise of 1 % of the depth on every pixel and frame", scenario::noise},
    {"fast-hip", "a finger goes through a ridge and into a floor at 5 m/s", scenario::fastHip},
    {"stiff-wall", "a hand presses into a crease, at 80 % of the stiffest that the device holds", scenario::stiffWall},
    {"jitter", "1 to 20 ticks are missed, again and again, while scene and finger move", scenario::jitter},
    {"frame-drop", "frames are missing or late by up to 80 ms", scenario::frameDrop},
    {"underrun", "no frame comes for half a second, the scene moves on", scenario::underrun},
    {"seek", "the film jumps, and its frames come 100 ms later", scenario::seek},
    {"pause", "the film is paused, steps back by a frame, and goes on", scenario::pause},
    {"packet-loss", "blocks of the depth are wrong, now and then", scenario::packetLoss},
    {"energy-loop", "closed paths on a still scene: what they give", scenario::energyLoop},
    {"device-glitch", "the encoders jump, exchanges fail", scenario::deviceGlitch},
    // The figures and limits of these were written down before any method was run on them. Those above were written
    // beside `relievo`, and made harder until a method of the literature failed.
    {"flicker", "each frame is scaled and shifted at random, as by a depth estimator", scenario::flicker},
    {"dropout", "holes of 4 mm open and close at a resting finger", scenario::dropout},
    {"pass-before", "a hand passes before the dome that a finger rests on", scenario::passBefore},
    {"coarse-steps", "a slow stroke up a shallow slope in 6 bits", scenario::coarseSteps},
    {"camera-move", "the camera pans and zooms, at a frame rate that changes", scenario::cameraMove},
}};

}  // namespace

Challenger challengerNamed(const std::string& method) {
  return {method, [method](double stiffness, std::span<const TimedSurface> film) {
            const TouchPlan plan = planFilm(film);
            if (!method.starts_with("god-object")) {
              return makeMethod(method, {.stiffness_n_per_mm = stiffness, .scale = plan.scale});
            }
            auto proxy = makeMethod("relievo", {.stiffness_n_per_mm = stiffness, .space = SpaceLaw::Triangles});
            return method == "god-object" ? std::move(proxy)
                                          : onSmoothedDepth(std::move(proxy), film, blurWidthMm(plan.measure));
          }};
}

Challenger challengerMadeOf(const Material& material) {
  Challenger challenger{materialText(material), [material](double stiffness, std::span<const TimedSurface> film) {
                          return makeMethod("relievo", {.stiffness_n_per_mm = stiffness,
                                                        .friction = material.friction.value_or(Friction{}),
                                                        .texture = material.texture.value_or(Texture{}),
                                                        .scale = planFilm(film).scale});
                        }};
  if (material.stiffness_n_per_mm) challenger.stiffness_n_per_mm = *material.stiffness_n_per_mm;
  return challenger;
}

std::span<const Scenario> scenarios() {
  return kScenarios;
}

}  // namespace relievo
