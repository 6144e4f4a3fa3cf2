// SPDX-License-Identifier: Apache-2.0
// Runs an ONNX network: by ONNX Runtime if the build has it, else by OpenCV, which supports fewer operations: 4.6 and
// 4.10 refuse Depth Anything and DPT as PyTorch 2.11 exports them, or end the program by a signal.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "platform/failure.h"

namespace relievo {

// One plane after the other, each row by row.
struct NetworkPlanes {
  int cols = 0, rows = 0;
  std::vector<float> values;
};

// Use from one thread. Failures name the file and quote the library in one line.
class NetworkEngine {
 public:
  virtual ~NetworkEngine() = default;

  // The first output for this input of 1 x planes x rows x cols.
  [[nodiscard]] virtual Outcome<NetworkPlanes> run(NetworkPlanes input) = 0;
};

// `path` is only for messages.
[[nodiscard]] Outcome<std::unique_ptr<NetworkEngine>> openNetwork(const std::string& path,
                                                                  std::span<const std::uint8_t> model);

// A network's output of 1 x rows x cols or 1 x 1 x rows x cols; empty if its shape is another.
[[nodiscard]] NetworkPlanes planesOfOutput(std::span<const std::int64_t> shape, const float* values);

// The library's message, shortened to one line.
[[nodiscard]] std::string inOneLine(const std::string& words);

}  // namespace relievo
