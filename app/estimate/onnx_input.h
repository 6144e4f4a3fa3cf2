// SPDX-License-Identifier: Apache-2.0
// The size of the pictures that an ONNX network takes, which OpenCV does not tell.
#pragma once

#include <cstdint>
#include <span>

#include "platform/error.h"

namespace relievo {

// 0: the network takes any size in this direction.
struct OnnxInput {
  int cols = 0, rows = 0;
};

// Of a model's one input of the shape 1 x 3 x rows x cols. Corrupt if it is no ONNX model, Unsupported if it has no
// such input or takes more than one.
[[nodiscard]] Result<OnnxInput> onnxInputOf(std::span<const std::uint8_t> model);

}  // namespace relievo
