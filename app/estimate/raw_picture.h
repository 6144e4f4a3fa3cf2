// SPDX-License-Identifier: Apache-2.0
// A film's picture as estimators of depth take it.
#pragma once

#include "app/estimate/depth_estimator.h"
#include "hal/media/frame.h"

namespace relievo {

// Converts any colour picture, by its own matrix and range; gray gets three equal components.
[[nodiscard]] RawPicture rawOf(const Frame& frame);

}  // namespace relievo
