// SPDX-License-Identifier: Apache-2.0
// A film's picture as estimators of depth take it.
#pragma once

#include "app/estimate/depth_estimator.h"
#include "hal/media/frame.h"

namespace relievo {

// Any colour picture, by its own matrix and range; gray has three equal parts.
[[nodiscard]] RawPicture rawOf(const Frame& frame);

}  // namespace relievo
