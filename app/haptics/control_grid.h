// SPDX-License-Identifier: Apache-2.0
// Control points of a smooth surface: means of blocks of depth samples, read from the frames where the finger is.
#pragma once

#include <array>
#include <cstdint>

#include "app/haptics/frame_weights.h"
#include "app/haptics/surface_window.h"
#include "platform/realtime.h"

namespace relievo {

// Four floats that are worked on at once, on any machine (a vector extension of GCC and clang).
using Float4 = float __attribute__((vector_size(16)));
// The 4 x 4 control points that a cubic or quadratic patch hangs from: row j, element i.
using Patch = std::array<Float4, 4>;

// Control point (i, j) stands at the centre of the block of block_cols x block_rows samples that begins at sample
// (i block_cols, j block_rows). Its height is the mean of the block's samples, in each frame by itself; a block of
// which less than half has a reading is a hole, and a hole, like all that lies outside the picture, is a pit one volume
// depth below the far plane: free space with the same rounded rim as any other edge.
//
// Nothing is built: a block is read when it is first asked for and kept in a toroidal cache of 16 x 16 points for as
// long as its frame is in the window. 10 KiB, fixed.
class ControlGrid {
 public:
  static constexpr int kFrames = SurfaceWindow::kCapacity;
  // Samples read of a block, across and down, at most: a wider block is read at so many places, evenly spread.
  ControlGrid(double pitch_mm, int most_samples) noexcept : pitch_wanted_mm_(pitch_mm), most_samples_(most_samples) {}

  // A picture of another shape: forgets everything.
  void setPicture(const HeightField& field) RELIEVO_RT;
  void forget() RELIEVO_RT;
  // Frame `slot` of the cache is another frame from now on.
  void forgetFrame(int slot) RELIEVO_RT;

  // Grid units of control points: point i stands at a = i.
  [[nodiscard]] double a(double x_mm) const RELIEVO_RT { return a_origin_ + a_per_mm_ * x_mm; }
  [[nodiscard]] double b(double y_mm) const RELIEVO_RT { return b_origin_ + b_per_mm_ * y_mm; }
  [[nodiscard]] double aPerMm() const RELIEVO_RT { return a_per_mm_; }
  [[nodiscard]] double bPerMm() const RELIEVO_RT { return b_per_mm_; }
  [[nodiscard]] int blockCols() const RELIEVO_RT { return block_cols_; }
  [[nodiscard]] int blockRows() const RELIEVO_RT { return block_rows_; }

  struct Frames {
    const SurfaceWindow* window = nullptr;
    std::array<std::uint8_t, kFrames> slot{};  // of each frame of the window, in the cache
    std::uint32_t wanted = 0;                  // slots that must be there
    std::array<std::int8_t, kFrames> frame_of_slot{};
    alignas(16) std::array<float, kFrames> weight{};  // by slot
  };
  // The control points (i0 .. i0+3, j0 .. j0+3) at the moment that `frames` weighs out.
  void patch(int i0, int j0, const Frames& frames, Patch& out) RELIEVO_RT;
  // Reads what is missing of a point; true when there was something to read.
  bool fill(int i, int j, const Frames& frames, std::uint32_t wanted) RELIEVO_RT;

 private:
  static constexpr int kSide = 16;
  struct Point {
    alignas(16) std::array<float, kFrames> height{};  // by slot; 0 at a hole
    std::int32_t i = 0, j = 0;
    std::uint16_t filled = 0, hole = 0;  // bit per slot
  };
  [[nodiscard]] Point& at(int i, int j, const Frames& frames) RELIEVO_RT;
  void read(Point& point, const Frames& frames, std::uint32_t missing) RELIEVO_RT;
  [[nodiscard]] float withHoles(const Point& point, const Frames& frames) const RELIEVO_RT;

  double pitch_wanted_mm_;
  int most_samples_;
  int cols_ = 0, rows_ = 0;
  int block_cols_ = 1, block_rows_ = 1;
  double a_per_mm_ = 1, a_origin_ = 0, b_per_mm_ = -1, b_origin_ = 0;
  float pit_mm_ = -40;
  std::array<Point, kSide * kSide> points_{};
};

}  // namespace relievo
