// SPDX-License-Identifier: Apache-2.0
// All lines that are shown at the same time have the same depth.
#include "app/render/gl/words/words_in_scene.h"

#include <algorithm>
#include <utility>

namespace relievo {
namespace {

// The rectangle around all pictures, in shares of the view's width and height, from its middle; y up.
std::optional<WordsBox> boxOf(const TextFrame& frame, const std::vector<TextPicture>& pictures) {
  if (pictures.empty()) return std::nullopt;
  int left = frame.width, top = frame.height, right = 0, bottom = 0;
  for (const TextPicture& picture : pictures) {
    left = std::min(left, picture.x), top = std::min(top, picture.y);
    right = std::max(right, picture.x + picture.width), bottom = std::max(bottom, picture.y + picture.height);
  }
  const double width = frame.width, height = frame.height;
  return WordsBox{left / width - 0.5, 0.5 - bottom / height, right / width - 0.5, 0.5 - top / height};
}

// Moving words, or lines that follow one another at the same place, continue in depth from their last place.
bool continues(const std::optional<WordsBox>& last, const std::optional<WordsBox>& next) noexcept {
  return last && next && last->left < next->right && next->left < last->right && last->bottom < next->top &&
         next->bottom < last->top;
}

}  // namespace

Result<WordsInScene> WordsInScene::create() {
  auto overlay = Overlay::create();
  if (!overlay) return std::unexpected(overlay.error());
  WordsInScene words;
  words.overlay_ = std::move(*overlay);
  return words;
}

void WordsInScene::set(const TextFrame& frame, const std::vector<TextPicture>& pictures) {
  overlay_.set(frame, pictures);
  const auto box = boxOf(frame, pictures);
  if (!continues(box_, box)) place_.begin();
  box_ = box;
  due_ = true;
}

void WordsInScene::find(const ReliefTriangles* relief, const EyeViews& eyes, const StereoSettings& stereo) {
  if (!std::exchange(due_, false) || !box_) return;
  if (relief == nullptr) return place_.stayInScreen();
  const int width_px = eyes.views[0].area.width;
  const double width_mm = width_px / eyes.pixels_per_mm;
  const double height_mm = width_mm * stereo.stretch / eyes.aspect;
  const WordsBox box{box_->left * width_mm, box_->bottom * height_mm, box_->right * width_mm, box_->top * height_mm};
  place_.follow({relief->vertices().data(), relief->vertices().size()},
                {relief->indices().data(), 3 * relief->surfaceTriangles()}, box, stereo, width_px, eyes.pixels_per_mm,
                ahead_);
}

void WordsInScene::draw(const EyeView& view, const StereoSettings& stereo) const {
  overlay_.draw(place_.shiftPx(view.eye_x_mm, stereo) * overlay_.frame().width / view.area.width);
}

}  // namespace relievo
