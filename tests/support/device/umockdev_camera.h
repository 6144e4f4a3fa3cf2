// SPDX-License-Identifier: Apache-2.0
// A simulated camera: a node of /dev that answers the requests of <linux/videodev2.h>, and whose pictures contain their
// number. Only under `umockdev-wrapper`.
#pragma once

#include <umockdev.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "platform/clock.h"
#include "tests/support/device/request_loop.h"

namespace relievo::test {

struct CameraKind {
  std::vector<std::uint32_t> formats;  // fourccs; it is set to the first
  std::uint32_t width = 64, height = 48;
  std::uint32_t row_padding = 0;  // bytes
  Duration period = std::chrono::nanoseconds(33'333'333);
  std::uint32_t buffers = 16;  // at most
  // True: in real time. False: a picture whenever one is requested, each a period later.
  bool paced = false;
  // Paced: how long after its time a picture can be had.
  std::function<Duration(std::uint32_t)> delay = [](std::uint32_t) { return Duration(0); };
  // Two bytes at (number, byte column / 2, row); of every format alike.
  std::function<std::uint16_t(std::uint32_t, int, int)> sample = [](std::uint32_t number, int c, int r) {
    return static_cast<std::uint16_t>(number + 64 * static_cast<std::uint32_t>(r) + static_cast<std::uint32_t>(c));
  };
};

class UmockdevCamera {
 public:
  // Creates the node /dev/videoN.
  UmockdevCamera(UMockdevTestbed* bed, int number, CameraKind kind);
  ~UmockdevCamera();
  UmockdevCamera(const UmockdevCamera&) = delete;
  UmockdevCamera& operator=(const UmockdevCamera&) = delete;

  // A fault of the picture with a given number.
  enum class Fault : std::uint8_t { Dropped, Damaged, Short, BackInTime };
  void fault(std::uint32_t number, Fault fault);
  void silence();
  void unplug();
  void plug();

  // The number of pictures taken, including lost ones.
  [[nodiscard]] std::uint32_t taken();
  // Of those, the number lost for lack of a buffer.
  [[nodiscard]] std::uint32_t starved();
  // The number of unsupported requests.
  [[nodiscard]] int unknownRequests();

 private:
  struct Filled {
    std::uint32_t index, number, flags, bytes;
    MonotonicTime time;
  };
  void answer(UMockdevIoctlClient* client);
  [[nodiscard]] int answerTo(unsigned long request, void* argument);
  [[nodiscard]] int setFormat(void* argument);
  [[nodiscard]] int takeBuffer(void* argument);
  void takePicture(MonotonicTime time);
  [[nodiscard]] std::uint32_t rowBytes() const { return 2 * kind_.width + kind_.row_padding; }
  [[nodiscard]] std::uint32_t pictureBytes() const { return rowBytes() * kind_.height; }
  [[nodiscard]] std::uint32_t bufferBytes() const { return (pictureBytes() + 4095) / 4096 * 4096; }  // whole pages

  UMockdevTestbed* bed_;
  std::string name_, node_, device_;
  const CameraKind kind_;
  MonotonicClock clock_;

  std::mutex lock_;  // guards all members below
  std::uint8_t* memory_ = nullptr;
  std::uint32_t format_ = 0;
  std::deque<std::uint32_t> empty_;
  std::deque<Filled> filled_;
  std::vector<std::pair<std::uint32_t, Fault>> faults_;
  bool streaming_ = false, plugged_ = false, silent_ = false;
  std::uint32_t next_number_ = 0, starved_ = 0;
  MonotonicTime next_time_;
  int unknown_ = 0;
  RequestLoop requests_;
};

}  // namespace relievo::test
