// SPDX-License-Identifier: Apache-2.0
// Control points of a smooth surface: from means of blocks of depth samples, read only near the finger.
#pragma once

#include <array>
#include <cstdint>

#include "app/depth_window/surface_window.h"
#include "app/haptics/method/float4.h"
#include "app/haptics/method/frame_weights.h"
#include "platform/realtime.h"

namespace relievo {

// The 4 x 4 control points of a cubic or quadratic patch: row j, element i.
using Patch = std::array<Float4, 4>;

// Control point (i, j) is at the centre of the block of block_cols x block_rows samples that begins at sample (i
// block_cols, j block_rows). Each frame has its own heights. A mean over a curved patch lies below the patch's top, and
// so does a B-spline on such means; a point's height therefore is the mean of its block minus `bend` times the second
// differences to the four blocks around it, so that the surface is exact to the third order (de Boor and Fix 1973,
// quasi-interpolants). An edge is no curvature, and to correct for it would give it a lip: a second difference that
// only a radius under kSharpestMm explains counts less, and one twice as large not at all. A block is a hole if less
// than half of it, and of its neighbourhood, has a reading. Holes and everything outside the picture are pits one
// volume depth below the far plane: free space with the same rounded rim as any other edge.
//
// Nothing is built in advance: a block is read when it is first needed and kept in a toroidal cache of 16 x 16 points
// while its frame is in the window. 19 KiB, fixed.
class ControlGrid {
 public:
  static constexpr int kFrames = SurfaceWindow::kCapacity;
  static_assert(kFrames == 8, "a byte holds a bit for each frame, and two Float4 hold their weights and heights");
  static constexpr int kSide = 16;
  static constexpr std::size_t kPoints = static_cast<std::size_t>(kSide) * kSide;
  using Heights = std::array<std::array<float, kFrames>, kPoints>;  // of each point, by slot

  // `samples`: approximate number read per block, across and down (SampledBlock). `bend`: 5/24 keeps the curvature
  // under a cubic B-spline, 1/6 under a quadratic one (half the variance of block and spline); 0 uses the means
  // unchanged.
  ControlGrid(double pitch_mm, int most_samples, float bend) noexcept
      : pitch_wanted_mm_(pitch_mm), most_samples_(most_samples), bend_(bend) {}
  static constexpr double kSharpestMm = 5, kMostBendMm = 3;

  // Discards everything, for a picture of another shape.
  void setPicture(const HeightField& field) RELIEVO_RT;
  // Slot `slot` of the cache now holds another frame: discards its heights.
  void forgetFrame(int slot) RELIEVO_RT;

  // From scene mm to control point units: point i is at a = i.
  [[nodiscard]] double a(double x_mm) const RELIEVO_RT { return a_origin_ + a_per_mm_ * x_mm; }
  [[nodiscard]] double b(double y_mm) const RELIEVO_RT { return b_origin_ + b_per_mm_ * y_mm; }
  [[nodiscard]] double aPerMm() const RELIEVO_RT { return a_per_mm_; }
  [[nodiscard]] double bPerMm() const RELIEVO_RT { return b_per_mm_; }
  [[nodiscard]] int blockCols() const RELIEVO_RT { return block_.width; }
  [[nodiscard]] int blockRows() const RELIEVO_RT { return block_.height; }

  // The height of a point at a hole.
  [[nodiscard]] float pitMm() const RELIEVO_RT { return pit_mm_; }

  using Weights = std::array<float, kFrames>;  // by slot
  // The weighted frames of one moment, by cache slot.
  struct Frames {
    const SurfaceWindow* window = nullptr;
    std::array<std::uint8_t, kFrames> frame_of_slot{};
    std::uint32_t wanted = 0;  // one bit per slot with a weight
    alignas(16) Weights weight{};
  };
  // The control points (i0 .. i0+3, j0 .. j0+3), weighted over the frames.
  void patch(int i0, int j0, const Frames& frames, Patch& out) RELIEVO_RT;
  // Reads what `patch` needs.
  void readPatch(int i0, int j0, const Frames& frames) RELIEVO_RT;
  // True if the last patch was of this place and these frames, and is still valid.
  [[nodiscard]] bool wasPatch(int i0, int j0, std::uint32_t wanted) const RELIEVO_RT {
    return patch_ == Place{i0, j0, wanted};
  }
  // The same points by several sets of weights of the same frames at once; holes count as level.
  template <std::size_t kSets>
  void weighted(int i0, int j0, const std::array<const Weights*, kSets>& weights,
                const std::array<Patch*, kSets>& out) const RELIEVO_RT {
    for (int j = 0; j < 4; ++j) {
      const auto heights = [&](int i) RELIEVO_RT { return height_[slotOf(i0 + i, j0 + j)].data(); };
      const float *const a = heights(0), *const b = heights(1), *const c = heights(2), *const d = heights(3);
      for (std::size_t set = 0; set < kSets; ++set) {
        const Float4 low = load4(weights[set]->data()), high = load4(weights[set]->data() + 4);
        const auto sum = [&](const float* of) RELIEVO_RT { return load4(of) * low + load4(of + 4) * high; };
        (*out[set])[static_cast<std::size_t>(j)] = sums(sum(a), sum(b), sum(c), sum(d));
      }
    }
  }
  [[nodiscard]] bool patchHasHoles() const RELIEVO_RT { return patch_holes_; }
  // The mean of a point's block in one frame, which is read if it was not; NaN at a hole.
  [[nodiscard]] float mean(int i, int j, const Frames& one) RELIEVO_RT;
  // Reads blocks around a place, of frames that will get a weight soon; stops once it has read `most` of them, or one
  // block of every frame. Reads none so far away that they would evict the last patch. True if all of them have been
  // read.
  bool readAhead(int i0, int j0, const Frames& frames, int most) RELIEVO_RT;
  // The frames, one bit per slot, of which a whole patch or place has been read.
  [[nodiscard]] std::uint32_t slotsRead() const RELIEVO_RT { return slots_read_; }
  // Prefetches everything except the points.
  void prefetch() const RELIEVO_RT;
  // Total so far, counted per frame.
  [[nodiscard]] std::uint64_t blocksRead() const RELIEVO_RT { return blocks_read_; }

 private:
  struct Place {
    int i = 0, j = 0;
    std::uint32_t slots = 0;  // of the frames
    bool operator==(const Place&) const = default;
  };
  [[nodiscard]] static std::size_t slotOf(int i, int j) RELIEVO_RT {
    return static_cast<std::size_t>(j & (kSide - 1)) * kSide + static_cast<std::size_t>(i & (kSide - 1));
  }
  // The control points (i0 .. i1-1, j0 .. j1-1).
  struct Points {
    int i0, j0, i1, j1;
  };
  // Reads the missing frames of a point's block.
  void fill(int i, int j, const Frames& frames) RELIEVO_RT;
  // Reads what points lack, and the blocks around them that their heights need.
  void complete(const Points& points, const Frames& frames) RELIEVO_RT;
  void keepCurvature(int i, int j, std::uint32_t missing) RELIEVO_RT;
  [[nodiscard]] std::uint32_t slotsMissing(int i, int j, const Frames& frames) const RELIEVO_RT;
  [[nodiscard]] bool isComplete(int i, int j, const Frames& frames) const RELIEVO_RT;
  // Of adjacent points in a row, those between the first and the last that lack a frame.
  struct Lacking {
    int j = 0, begin = 0, end = 0;
  };
  [[nodiscard]] Lacking prefetchRow(int i0, int i1, int j, const Frames& frames) const RELIEVO_RT;
  void read(std::size_t point, const Frames& frames, std::uint32_t missing) RELIEVO_RT;
  [[nodiscard]] double bridged(const HeightField& field, int c, int r, const SampledBlock& block) const RELIEVO_RT;
  [[nodiscard]] float withHoles(std::size_t point, const Frames& frames) const RELIEVO_RT;

  double pitch_wanted_mm_;
  int most_samples_;
  float bend_;
  float most_bend_mm_ = 0;  // largest second difference that counts in full
  int cols_ = 0, rows_ = 0;
  SampledBlock block_;
  double a_per_mm_ = 1, a_origin_ = 0, b_per_mm_ = -1, b_origin_ = 0;
  float pit_mm_ = -40;
  // The last patch, all of whose points are valid, and the last place of `readAhead`. Their `slots` are 0 once
  // something was discarded or replaced.
  Place patch_, ahead_;
  bool patch_holes_ = false;
  std::uint32_t slots_read_ = 0;
  std::uint64_t blocks_read_ = 0;
  // One element per point. Bits, means and heights by slot; those of a hole are 0.
  std::array<std::int32_t, kPoints> i_{}, j_{};
  std::array<std::uint8_t, kPoints> filled_{}, hole_{}, complete_{};
  alignas(16) Heights mean_{}, height_{};
};

// The cache slot of each frame of the window.
struct FrameSlots {
  const SurfaceWindow* window = nullptr;
  std::array<std::uint8_t, ControlGrid::kFrames> of_frame{};
  std::array<std::uint8_t, ControlGrid::kFrames> frame{};
  std::uint32_t in_use = 0;  // one bit per slot
};

struct WeighedFrames {
  FrameMoment moment;
  TimeLaw law = TimeLaw::Hold;
  ControlGrid::Frames frames;
  alignas(16) ControlGrid::Weights added{};  // weights of what TimeLaw::Adapted may add
  alignas(16) ControlGrid::Weights later{};  // at a later moment, without what is added

  // `at_later`: a moment at which the present frame is the same.
  void weigh(TimeLaw by, const FrameSlots& slots, const FrameMoment& at, const FrameMoment& at_later) RELIEVO_RT;
};

}  // namespace relievo
