// SPDX-License-Identifier: Apache-2.0
// One decoding element with an input for packets and an output for pictures. Its threads are GStreamer's own; no call
// here waits for an element that hangs.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "drivers/gstreamer/coding.h"
#include "hal/media/media_time.h"
#include "platform/error.h"

namespace relievo::gstreamer {

// Buffers that an element is asked for in addition to its own need, so that its reader may hold pictures.
inline constexpr int kPicturesWaiting = 4, kPicturesHeld = 8;

class Pipeline {
 public:
  // Starts the decoder of that factory. Io if it does not start.
  [[nodiscard]] static Result<std::unique_ptr<Pipeline>> make(const Coding& coding, GstElementFactory& decoder,
                                                              CapsPtr caps);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void push(BufferPtr packet);
  void end();
  // The next picture; null if none came in that time.
  [[nodiscard]] SamplePtr pull(Duration longest);
  // All pictures before the end were pulled.
  [[nodiscard]] bool ended() const;
  // How many packets no element has taken yet.
  [[nodiscard]] std::size_t waiting() const;
  // The first failure since the start.
  [[nodiscard]] std::optional<Error> failure();
  // Afterwards only destruction is allowed. False if the element hangs.
  bool stop();
  // Call if the element hangs: destruction then does not wait for it.
  void abandon() noexcept { hangs_ = true; }

 private:
  Pipeline() = default;
  [[nodiscard]] bool build(const Coding& coding, GstElementFactory& decoder);
  [[nodiscard]] bool run();

  ElementPtr pipeline_;
  GstElement* source_ = nullptr;  // the pipeline's, as is the sink
  GstElement* sink_ = nullptr;
  CapsPtr caps_;
  BusPtr bus_;
  std::optional<Error> failure_;
  bool draining_ = false;
  bool hangs_ = false;
  bool left_behind_ = false;  // a thread waits for the element
};

}  // namespace relievo::gstreamer
