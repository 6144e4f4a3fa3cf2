// SPDX-License-Identifier: Apache-2.0
// Interface of what makes a depth picture from two views: the quick matcher, or a test's.
#pragma once

#include <memory>
#include <span>

#include "hal/media/frame.h"

namespace relievo {

// Use from one thread at a time. Pictures come in order, not necessarily all of them.
class StereoMatcher {
 public:
  virtual ~StereoMatcher() = default;
  // The sizes that it can match at, in columns, the cheapest first; they change the cost, not the depth picture's size.
  [[nodiscard]] virtual std::span<const int> sizes() const noexcept = 0;
  // Sets one of `sizes`, from the next shot on.
  virtual void setSize(int cols) noexcept = 0;
  // The present size.
  [[nodiscard]] virtual int size() const noexcept = 0;
  // The next picture does not continue the last one.
  virtual void beginShot() noexcept = 0;
  // What is wrong with the present shot's views, and what is done about it; null: nothing.
  struct Caution {
    const char *what = nullptr, *done = nullptr;
  };
  [[nodiscard]] virtual Caution caution() const noexcept { return {}; }
  // 16 bits, full range, near high, with the left view's time.
  [[nodiscard]] virtual Frame depthOf(const Frame& left, const Frame& right) = 0;
};

// Null in a build without it.
[[nodiscard]] std::unique_ptr<StereoMatcher> makeQuickMatcher();

}  // namespace relievo
