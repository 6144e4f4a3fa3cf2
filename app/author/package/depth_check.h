// SPDX-License-Identifier: Apache-2.0
// Measures how far a film's relief is from its source's, while the film is written, from what its packets decode to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/author/package/picture.h"
#include "app/coding/packet_decoder.h"
#include "app/scene/depth_calibration.h"
#include "hal/media/frame.h"

namespace relievo {

// What a finger feels of a height that is wrong, with the player's usual stiffness, in a box of the usual depth: an
// upper bound, because touch averages over several samples.
[[nodiscard]] double newtonsOf(double height_mm) noexcept;

// The force errors of one step, from the source to the film.
class StepErrors {
 public:
  // Heights in mm; NaN: a hole.
  void add(float before, float after);
  // The error that a share of the samples does not exceed, in N; samples that are a hole before or after do not count.
  [[nodiscard]] double quantile(double share) const;
  // The share of the samples that are a hole either before or after, but not both.
  [[nodiscard]] double moved() const;
  [[nodiscard]] bool empty() const noexcept { return samples_ == 0; }

 private:
  std::vector<std::uint64_t> of_millinewton_;
  std::uint64_t samples_ = 0, moved_ = 0;
};

// Shares of the samples of a relief.
class ReliefShares {
 public:
  void add(float height_mm);
  [[nodiscard]] double holes() const;
  [[nodiscard]] double ends() const;  // nearest and farthest

 private:
  std::uint64_t samples_ = 0, holes_ = 0, ends_ = 0;
};

struct DepthLoss {
  StepErrors enhancing, rounding, coding;
  StepErrors all;  // from the source to the film
  ReliefShares source, film;
};

// About 20,000 samples of each picture are compared. The depth's thread calls `read` and `write`, in this order for
// each picture, though `write` may come some pictures later; the encoder's thread calls the others.
class DepthCheck {
 public:
  // `enhanced`: what the depth means after enhancement; nullopt: there is none. `film`: see DepthCoder::outcome.
  DepthCheck(const DepthCalibration& source, const std::optional<DepthCalibration>& enhanced,
             const DepthCalibration& film);

  // The source's next picture.
  void read(const Frame& depth);
  // The next picture as it is written. `depth`: enhanced, or the source's own.
  void write(const Frame& depth, const DepthPicture& codes);

  [[nodiscard]] Result<void> open(const AVCodecContext& encoder) { return decoder_.open(encoder); }
  // Null: no more packets come. Io if the film cannot be decoded.
  [[nodiscard]] Result<void> decode(const AVPacket* packet);
  // After all calls.
  [[nodiscard]] const DepthLoss& loss() const noexcept { return loss_; }

 private:
  using Heights = std::vector<float>;
  struct Picture {
    Heights source, coded;
  };
  [[nodiscard]] bool compare(const AVFrame& decoded);

  DepthCalibration source_;
  std::optional<DepthCalibration> enhanced_;
  Heights of_code_;            // of the film's codes
  std::deque<Heights> read_;   // not written yet; the depth's thread
  std::mutex mutex_;           // guards the next
  std::deque<Picture> coded_;  // not decoded yet
  PacketDecoder decoder_;
  DepthLoss loss_;
};

// Why a film is too far from its source, by the step that did it, as an error's message; null: it is not.
[[nodiscard]] const char* whyTooFar(const DepthLoss& loss) noexcept;
// For the table.
[[nodiscard]] std::string toText(const DepthLoss& loss);

}  // namespace relievo
