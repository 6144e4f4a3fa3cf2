// SPDX-License-Identifier: Apache-2.0
// Names of the interpolation laws.
#include "app/depth_window/parts.h"

namespace relievo {

const char* name(TimeLaw law) noexcept {
  switch (law) {
    case TimeLaw::Hold:
      return "hold";
    case TimeLaw::Linear:
      return "linear";
    case TimeLaw::BSpline:
      return "bspline";
    case TimeLaw::Fitted:
      return "fitted";
    case TimeLaw::Adapted:
      return "adapted";
    case TimeLaw::Mean:
      return "mean";
  }
  return "";
}

}  // namespace relievo
