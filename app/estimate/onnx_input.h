// SPDX-License-Identifier: Apache-2.0
// Finds the size of the pictures that an ONNX network takes, which OpenCV does not report.
#pragma once

#include <cstdint>
#include <span>

#include "platform/error.h"

namespace relievo {

// 0: the network takes any size in this direction.
struct OnnxInput {
  int cols = 0, rows = 0;
};

// Returns the size of a model's single input, of shape 1 x 3 x rows x cols. Corrupt if it is no ONNX model, Unsupported
// if it has no such input or takes more than one.
[[nodiscard]] Result<OnnxInput> onnxInputOf(std::span<const std::uint8_t> model);

}  // namespace relievo
