// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace relievo {

// A point of the scene frame, mm, and its texture coordinate: 0 to 1, v from the top.
struct TexturedVertex {
  float x, y, z;
  float u, v;
};

}  // namespace relievo
