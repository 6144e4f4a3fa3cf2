// SPDX-License-Identifier: Apache-2.0
// Each level's film is made from the decoded one.
#include "app/lab/detail/detail_touch.h"

#include "app/lab/detail/drawn_depth.h"
#include "app/lab/film/parallel.h"
#include "app/lab/finger/finger_paths.h"
#include "app/lab/measure/contenders.h"
#include "platform/print.h"

namespace relievo {

Outcome<std::vector<DetailTouch>> touchOfDetails(const DepthKind& depth, double pixels_per_mm, double duration_s,
                                                 const std::function<void(const std::string&)>& tell) {
  constexpr const char* kScene = "face-nodding";
  const auto face = makeTrueSurface(kScene);
  const auto path = makeFingerPath(*face, {.duration_s = duration_s});
  const auto truth = truthAlong(*face, path);
  const auto film = MemoryFilm::make(*face, {.depth = depth}, 0, duration_s);
  if (!film) return failOn(kScene, film.error());

  std::vector<DetailTouch> found;
  for (const DrawnLevel& level : kDetails) {
    tell(print("touch, %s, level %zu of %zu", depth.name, found.size() + 1, kDetails.size()));
    std::vector<DrawnDepth> drawn(film->frames().size());
    inParallel(drawn.size(), [&](std::size_t i) {
      drawn[i] = drawnDepth(film->frames()[i].field, TrueSurface::kVolume, level, pixels_per_mm);
      drawn[i].frame.pts = film->frames()[i].time;
    });
    DetailTouch touch;
    std::vector<Frame> frames;
    for (DrawnDepth& one : drawn) {
      touch.triangles += static_cast<double>(one.triangles) / static_cast<double>(drawn.size());
      frames.push_back(std::move(one.frame));
    }
    const auto felt = MemoryFilm::of(frames, {.bits = 16});
    if (!felt) return failOn(kScene, felt.error());
    const FilmViews views(*felt);
    inParallel(kDetailFeltBy.size(), [&](std::size_t m) {
      touch.errors[m] = forceErrors(playPath(views, *contender(kDetailFeltBy[m]), path, truth), kSettledS).result();
    });
    found.push_back(touch);
  }
  return found;
}

}  // namespace relievo
