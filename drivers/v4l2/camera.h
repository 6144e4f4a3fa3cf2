// SPDX-License-Identifier: Apache-2.0
// One camera: the requested format, the negotiated one, and its pictures one by one.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/v4l2/camera_memory.h"
#include "drivers/v4l2/formats.h"
#include "platform/clock.h"
#include "platform/error.h"
#include "platform/unique_fd.h"

namespace relievo::v4l2 {

struct Wish {
  std::string device;
  std::optional<std::uint32_t> fourcc;
  std::uint32_t width = 0, height = 0;  // 0: the camera's current setting
  double frames_per_s = 0;              // likewise
};
// InvalidArgument, with the correct form, for anything else.
[[nodiscard]] Result<Wish> parseAddress(const std::string& url);

// A reference to a picture, or a copy if the camera has few buffers left.
struct Picture {
  std::shared_ptr<const void> owner;  // a Held, if a reference
  const std::uint8_t* data = nullptr;
  std::size_t bytes = 0;
  MonotonicTime taken;
};

// One thread, except for `interrupt` and `forgive`.
class Camera {
 public:
  Camera();

  [[nodiscard]] Result<void> open(const Wish& wish);
  void close() noexcept;
  // Valid from `open` on.
  [[nodiscard]] const Format& format() const noexcept { return *format_; }
  [[nodiscard]] const Layout& layout() const noexcept { return layout_; }
  [[nodiscard]] Duration period() const noexcept { return period_; }  // 0 if unknown
  [[nodiscard]] const std::string& card() const noexcept { return card_; }

  // The next picture. Timeout, Lost, Cancelled.
  [[nodiscard]] Result<Picture> take();
  // Returns and resets the number of pictures lost before the last one taken.
  [[nodiscard]] std::uint64_t takeLost() noexcept { return std::exchange(lost_, 0); }
  void interrupt() noexcept;
  void forgive() noexcept;

 private:
  [[nodiscard]] Result<void> identify(int device);
  [[nodiscard]] Result<void> choose(int device, const Wish& wish);
  [[nodiscard]] std::optional<std::uint32_t> bestFormat(int device) const;
  void setRate(int device, double frames_per_s);
  [[nodiscard]] Result<bool> waitUntil(MonotonicTime deadline);
  [[nodiscard]] Result<bool> takeBuffer(Picture& picture);
  [[nodiscard]] Picture pictureOf(std::uint32_t index, std::size_t bytes);

  MonotonicClock clock_;
  UniqueFd wake_;
  std::atomic<bool> interrupted_{false};
  std::shared_ptr<CameraMemory> memory_;
  const Format* format_ = nullptr;
  Layout layout_;
  Duration period_{0};
  std::string card_;
  std::optional<std::uint32_t> last_count_;
  std::optional<MonotonicTime> last_taken_;
  std::uint64_t lost_ = 0;
};

}  // namespace relievo::v4l2
