// SPDX-License-Identifier: Apache-2.0
// Making triangles is most of the work of a picture, so it is measured by itself.
#include "app/render/relief/made_relief.h"

namespace relievo {

bool MadeRelief::make(const HeightField& field, const DisplayVolume& volume, const ReliefDetail& wanted) {
  if (made_for_ == wanted) return false;
  const MonotonicTime start = clock_.now();
  const bool is_new = triangles_.build(field, volume, wanted);
  making_.add(clock_.now() - start);
  made_for_ = wanted;
  return is_new;
}

}  // namespace relievo
