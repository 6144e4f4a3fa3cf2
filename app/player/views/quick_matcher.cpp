// SPDX-License-Identifier: Apache-2.0
#include "app/player/views/stereo_matcher.h"

#ifdef RELIEVO_STEREO_PLAY
#include "app/stereo/quick/quick_depth.h"

namespace relievo {
namespace {

class QuickMatcher final : public StereoMatcher {
 public:
  [[nodiscard]] std::span<const int> sizes() const noexcept override { return QuickDepth::kMatchedCols; }
  void setSize(int cols) noexcept override { depth_.setMatchedCols(cols); }
  [[nodiscard]] int size() const noexcept override { return depth_.matchedCols(); }
  void beginShot() noexcept override { depth_.beginShot(); }
  [[nodiscard]] Caution caution() const noexcept override {
    if (depth_.isOnePicture())
      return {"both views of this shot are the same picture", "it has no depth and is felt flat"};
    if (depth_.areSwapped())
      return {"the right eye's view comes first",
              "the relief is made the right way round; if the picture looks inside out: --swap-eyes"};
    if (depth_.isOrderUnknown())
      return {"its pictures do not show which eye's view comes first; it is taken for the left eye's",
              "if near feels far: relievo-author --depth-from stereo --swap-eyes yes"};
    return {};
  }
  [[nodiscard]] Frame depthOf(const Frame& left, const Frame& right) override { return depth_.depthOf(left, right); }

 private:
  QuickDepth depth_;
};

}  // namespace

std::unique_ptr<StereoMatcher> makeQuickMatcher() {
  return std::make_unique<QuickMatcher>();
}

}  // namespace relievo
#else
namespace relievo {

std::unique_ptr<StereoMatcher> makeQuickMatcher() {
  return nullptr;
}

}  // namespace relievo
#endif
