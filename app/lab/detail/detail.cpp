// SPDX-License-Identifier: Apache-2.0
// First draws and keeps the reference pictures; then all levels, on a display of the size that is shown.
#include "app/lab/detail/detail.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "app/lab/detail/detail_tables.h"
#include "app/lab/detail/detail_touch.h"
#include "app/lab/detail/drawing_stage.h"
#include "app/lab/detail/silhouette_film.h"
#include "app/lab/film/coded_depth.h"
#include "app/lab/film/parallel.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr int kWidth = 1280, kHeight = 720;
constexpr int kFiner = 3, kFinerTruth = 2;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr DrawnLevel kAllSamples{.grid_step = 1};

struct Plan {
  int pictures = 4, apart = 10;  // frames of the film between two of them
  int rounds = 3;                // in which each is drawn and timed
  double touch_s = 3;

  static Plan of(bool quick) {
    if (!quick) return {};
    return {.pictures = 1, .rounds = 1, .touch_s = 0.8};
  }
};

// One picture of the film, and what it should look like.
struct Shot {
  Frame color, depth;
  DrawnPicture mesh, truth;
  std::vector<std::uint8_t> whole, away;  // the pixels that count
};

class Detail {
 public:
  explicit Detail(const MeasureOptions& options) : options_(options), plan_(Plan::of(options.quick)) {
    const auto volume = DisplayVolume::forPicture(SilhouetteFilm::kCols, SilhouetteFilm::kRows);
    eyes_ = eyeViews({.layout = StereoLayout::SideBySide}, volume, kWidth, kHeight);
  }

  Outcome<std::vector<ChartWords>> run() {
    for (const DepthKind* depth : kDrawnDepths) {
      if (options_.quick && depth->crf) continue;
      if (auto done = addPictures(*depth); !done) return std::unexpected(done.error());
      if (auto done = addTouch(*depth); !done) return std::unexpected(done.error());
    }
    if (auto done = writeDetail(figures_, options_.out + "/detail.csv"); !done) return std::unexpected(done.error());
    return std::vector{detailWords(figures_)};
  }

 private:
  Outcome<void> addPictures(const DepthKind& depth) {
    options_.tell(print("pictures, %s: making the film", depth.name));
    auto shots = makeShots(depth);
    if (!shots) return std::unexpected(shots.error());
    if (auto done = drawReferences(*shots, depth); !done) return done;
    auto stage = DrawingStage::open(*options_.display, kWidth, kHeight);
    if (!stage) return std::unexpected(stage.error());
    std::vector<DetailFigures> figures;
    figures.reserve(kDetails.size());
    for (const DrawnLevel& level : kDetails) figures.push_back({.depth = &depth, .level = level});
    for (const Shot& shot : *shots) {
      options_.tell(
          print("pictures, %s: %zu of %zu", depth.name, &shot - shots->data() + std::size_t{1}, shots->size()));
      for (std::size_t i = 0; i < figures.size(); ++i) {
        if (auto done = draw(**stage, shot, figures[i]); !done) return done;
      }
    }
    figures_.insert(figures_.end(), figures.begin(), figures.end());
    return {};
  }

  Outcome<std::vector<Shot>> makeShots(const DepthKind& depth) const {
    std::vector<Shot> shots(plan_.pictures);
    std::vector<Frame> depths((plan_.pictures - 1) * plan_.apart + 1);
    inParallel(depths.size(), [&](std::size_t i) { depths[i] = SilhouetteFilm::depth(static_cast<int>(i)); });
    inParallel(shots.size(),
               [&](std::size_t i) { shots[i].color = SilhouetteFilm::color(static_cast<int>(i) * plan_.apart); });
    if (depth.crf) {
      auto coded = codeDepth(depths, *depth.crf);
      if (!coded) return failOn(print("depth, %s", depth.name), coded.error());
      depths = std::move(coded->frames);
    }
    for (std::size_t i = 0; i < shots.size(); ++i) shots[i].depth = depths[i * plan_.apart];
    return shots;
  }

  Outcome<void> drawReferences(std::vector<Shot>& shots, const DepthKind& depth) const {
    auto stage = DrawingStage::open(*options_.display, kFiner * kWidth, kFiner * kHeight);
    if (!stage) return std::unexpected(stage.error());
    for (std::size_t i = 0; i < shots.size(); ++i) {
      options_.tell(print("pictures, %s: %zu of %zu, at their finest", depth.name, i + 1, shots.size()));
      Shot& shot = shots[i];
      const auto drawn = (*stage)->show(shot.color, shot.depth, kAllSamples);
      if (!drawn) return std::unexpected(drawn.error());
      shot.mesh = averagedDown((*stage)->picture(), kFiner);
      const int index = static_cast<int>(i) * plan_.apart;
      shot.truth = SilhouetteFilm::seen(index, eyes_, kWidth, kHeight, kFinerTruth);
      const Frame marks = SilhouetteFilm::marks(SilhouetteFilm::depth(index), kNearSilhouetteSamples);
      const auto marked = (*stage)->show(marks, shot.depth, kAllSamples);
      if (!marked) return std::unexpected(marked.error());
      const DrawnPicture counted = averagedDown((*stage)->picture(), kFiner);
      for (std::size_t p = 0; p < counted.rgba.size(); p += 4) {
        shot.whole.push_back(counted.rgba[p] == 255 ? 1 : 0);
        shot.away.push_back(counted.rgba[p + 1] == 255 ? 1 : 0);
      }
    }
    return {};
  }

  Outcome<void> draw(DrawingStage& stage, const Shot& shot, DetailFigures& figures) const {
    double frame_ms = kNever, draw_ms = kNever;
    for (int round = 0; round < plan_.rounds; ++round) {
      const auto shown = stage.show(shot.color, shot.depth, figures.level);
      if (!shown) return std::unexpected(shown.error());
      const auto again = stage.again();
      if (!again) return std::unexpected(again.error());
      frame_ms = std::min(frame_ms, toSeconds(*shown) * 1e3);
      draw_ms = std::min(draw_ms, toSeconds(*again) * 1e3);
    }
    const double share = 1.0 / plan_.pictures;
    figures.frame_ms += share * frame_ms;
    figures.draw_ms += share * draw_ms;
    figures.triangles += share * static_cast<double>(stage.triangles());
    const DrawnPicture picture = stage.picture();
    const PictureDifference from_mesh = differenceOf(picture, shot.mesh);
    figures.away.add(from_mesh, shot.away);
    figures.whole.add(from_mesh, shot.whole);
    figures.truth.add(differenceOf(picture, shot.truth), shot.whole);
    return {};
  }

  // The rows of this kind are the last ones.
  Outcome<void> addTouch(const DepthKind& depth) {
    const auto touch = touchOfDetails(depth, eyes_.pixels_per_mm, plan_.touch_s, options_.tell);
    if (!touch) return std::unexpected(touch.error());
    for (std::size_t i = 0; i < touch->size(); ++i) {
      DetailFigures& row = figures_[figures_.size() - touch->size() + i];
      row.touch = (*touch)[i].errors;
      row.touch_triangles = (*touch)[i].triangles;
    }
    return {};
  }

  const MeasureOptions& options_;
  Plan plan_;
  EyeViews eyes_;
  std::vector<DetailFigures> figures_;
};

}  // namespace

Outcome<std::vector<ChartWords>> measureDetail(const MeasureOptions& options) {
  return Detail(options).run();
}

}  // namespace relievo
