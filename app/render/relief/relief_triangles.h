// SPDX-License-Identifier: Apache-2.0
// The relief as few textured triangles: an irregular network that is cut at silhouettes, with the background extended
// behind them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "app/render/relief/cut_cells.h"
#include "app/render/relief/height_lattice.h"
#include "app/render/relief/output_array.h"
#include "app/render/relief/silhouette.h"
#include "app/render/relief/textured_vertex.h"
#include "app/render/relief/triangle_network.h"
#include "app/scene/display_volume.h"
#include "app/scene/height_field.h"

namespace relievo {

struct ReliefDetail {
  int most_across = 1024;  // cells per row
  double error_mm = 0.5;   // error bound of a height
  ViewSpan view;
  bool operator==(const ReliefDetail&) const = default;

  // `most_across` for a picture that a view shows `pixels` wide. Outlines lie half way between vertices, so this keeps
  // them within half a pixel of their true place, whatever the size of the depth picture. Since most triangles lie
  // along outlines, a permitted error that grows by `factor` also widens the vertices' pitch, up to twice.
  [[nodiscard]] static int cellsFor(double pixels, double factor = 1) noexcept;
};

// Pure arithmetic for one thread; memory is kept from frame to frame.
class ReliefTriangles {
 public:
  // Returns false if the triangles are the same as the last picture's: nothing was made then.
  bool build(const HeightField& field, const DisplayVolume& volume, const ReliefDetail& detail);

  [[nodiscard]] const OutputArray<TexturedVertex>& vertices() const noexcept { return vertices_; }
  // Three indices per triangle, counterclockwise for the viewer: first the surface, then the frame that joins it to the
  // picture's rectangle in the screen plane, then the silhouettes, last a floor below everything, so that a gaze past
  // all of them meets the picture's own colours.
  [[nodiscard]] const OutputArray<std::uint32_t>& indices() const noexcept { return indices_; }
  [[nodiscard]] std::size_t surfaceTriangles() const noexcept { return network_.triangles().size(); }
  // Samples of the last picture that were examined, including unchanged ones.
  [[nodiscard]] std::size_t samples() const noexcept { return lattice_.size(); }
  [[nodiscard]] std::size_t cutCells() const noexcept { return cuts_.cells().size(); }

 private:
  void addFrame(const DisplayVolume& volume, float screen_z_mm);
  void addFloor(const DisplayVolume& volume, float screen_z_mm);

  void make(const DisplayVolume& volume, const ReliefDetail& detail);

  DisplayVolume made_volume_;
  std::optional<ReliefDetail> made_;
  HeightLattice lattice_;
  CutCells cuts_;
  TriangleNetwork network_;
  OutputArray<TexturedVertex> vertices_;
  OutputArray<std::uint32_t> indices_;
};

}  // namespace relievo
