// SPDX-License-Identifier: Apache-2.0
// A network in a file model.onnx that guesses depth, run by OpenCV.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "app/estimate/depth_estimator.h"

namespace relievo {

// The interface of networks such as MiDaS 2.1 and Depth Anything. Input: one picture as 1 x 3 x height x width, red,
// green, blue from 0 to 1, minus the mean (0.485, 0.456, 0.406), divided by (0.229, 0.224, 0.225). Output: relative
// inverse depth in one channel, larger is nearer. A network of fixed size gets the whole picture scaled to it; any
// other gets the picture's shape, kLongSide long, in multiples of kPatch. The estimate has the picture's shape, too.
class DepthNetwork final : public DepthEstimator {
 public:
  static constexpr int kLongSide = 518, kPatch = 14;  // of Depth Anything

  // Opens the network for pictures of cols x rows. `input`: the size to give it; InvalidArgument if it takes another
  // alone. Failures name the file and quote OpenCV's message.
  [[nodiscard]] static Outcome<std::unique_ptr<DepthNetwork>> open(const std::string& path, int cols, int rows,
                                                                   std::optional<std::pair<int, int>> input);
  ~DepthNetwork() override;
  DepthNetwork(const DepthNetwork&) = delete;
  DepthNetwork& operator=(const DepthNetwork&) = delete;

  [[nodiscard]] Outcome<void> give(RawPicture picture) override;
  void end() override {}
  [[nodiscard]] Outcome<std::optional<DepthEstimate>> take() override;

 private:
  struct Impl;
  explicit DepthNetwork(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
  std::deque<DepthEstimate> answers_;
};

}  // namespace relievo
