// SPDX-License-Identifier: Apache-2.0
// One film for each scene and kind of depth is used by all contenders.
#include "app/lab/measure/accuracy.h"

#include "app/lab/film/parallel.h"
#include "app/lab/finger/finger_paths.h"
#include "platform/print.h"

namespace relievo {

ForceErrorSum forceErrors(std::span<const PlayedTick> ticks, double from_s) {
  ForceErrorSum sum;
  for (const PlayedTick& tick : ticks) {
    if (tick.t_s < from_s) continue;
    const glm::dvec3 truth = kStiffnessNPerMm * (tick.truth.proxy_mm - tick.hip_mm);
    sum.add(tick.touch.force_n, tick.touch.contact, truth, tick.truth.contact);
  }
  return sum;
}

std::vector<std::string_view> accuracyScenes() {
  constexpr double kSlewLimitNPerS = 50;
  std::vector<std::string_view> scenes;
  for (const std::string_view name : trueSurfaceNames()) {
    const TrueSurface::Traits traits = makeTrueSurface(name)->traits();
    if (traits.smooth && traits.duration_s > 1e9 && kStiffnessNPerMm * traits.max_speed_mm_per_s < kSlewLimitNPerS) {
      scenes.push_back(name);
    }
  }
  return scenes;
}

Outcome<AccuracyTable> measureAccuracy(std::span<const Contender> contenders, const AccuracyOptions& options,
                                       const std::function<void(const std::string&)>& tell) {
  AccuracyTable table(contenders.size());
  for (auto& of_contender : table) {
    for (auto& of_depth : of_contender) of_depth.resize(options.scenes.size());
  }
  for (std::size_t s = 0; s < options.scenes.size(); ++s) {
    const auto surface = makeTrueSurface(options.scenes[s]);
    const auto path = makeFingerPath(*surface, {.duration_s = options.duration_s});
    const auto truth = truthAlong(*surface, path);
    for (std::size_t d = 0; d < kDepthKinds.size(); ++d) {
      const std::string scene(options.scenes[s]);
      tell(print("accuracy, film %zu of %zu: %s, %s", s * kDepthKinds.size() + d + 1,
                 options.scenes.size() * kDepthKinds.size(), scene.c_str(), kDepthKinds[d].name));
      const auto film = MemoryFilm::make(*surface, {.depth = kDepthKinds[d]}, 0, options.duration_s);
      if (!film) return failOn("depth of " + scene, film.error());
      const FilmViews views(*film);
      inParallel(contenders.size(), [&](std::size_t c) {
        const auto ticks = playPath(views, contenders[c], path, truth);
        table[c][d][s] = {forceErrors(ticks, kSettledS), contenders[c].parts(*film)};
      });
    }
  }
  return table;
}

}  // namespace relievo
