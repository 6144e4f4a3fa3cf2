// SPDX-License-Identifier: Apache-2.0
// The second view of a picture that is one of two.
#pragma once

#include <string>

namespace relievo {

// The picture of the other eye in the same folder, by its name: "right.png" for "left.png", "a_R.jpg" for "a_L.jpg",
// "im1.png" for "im0.png" without an "im2.png"; and the other way round. Empty if there is none, or if `picture` is no
// file.
[[nodiscard]] std::string otherViewBeside(const std::string& picture);

}  // namespace relievo
