// SPDX-License-Identifier: Apache-2.0
// Histogram of a depth picture's codes, and statistics of neighbouring codes.
#pragma once

#include <cstdint>
#include <vector>

#include "app/media/reading/known_kind.h"
#include "app/scene/codes/code_set.h"
#include "hal/media/frame.h"

namespace relievo {

class CodeCount {
 public:
  // Counts all samples of a gray or YUV picture, or of an RGB picture whose three components are equal.
  explicit CodeCount(const Frame& depth);
  // Adds a later picture of the same film, which only `reach` and `together` use.
  void addLater(const Frame& depth) { later_.emplace_back(depth); }

  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] std::uint64_t samples() const noexcept { return samples_; }
  [[nodiscard]] std::uint64_t of(std::uint32_t code) const { return of_code_[code]; }
  // The share of all samples with a code in `low` .. `high`, both included.
  [[nodiscard]] double share(std::uint32_t low, std::uint32_t high) const;
  [[nodiscard]] double share(const CodeSet& set) const;
  // The quantile `q` of the codes in `low` .. `high`; `low` if there are none.
  [[nodiscard]] std::uint32_t quantile(double q, std::uint32_t low, std::uint32_t high) const;
  struct Reach {
    std::uint32_t low = 0, high = 0;
  };
  // The codes from the quantile `outliers` to the quantile 1 - `outliers`, of those in `low` .. `high`: the widest
  // range of this picture and the later ones.
  [[nodiscard]] Reach reach(double outliers, std::uint32_t low, std::uint32_t high) const;
  // This picture and the later ones as one.
  [[nodiscard]] CodeCount together() const;
  // The greatest common divisor of the codes that occur; 0 if only code 0 occurs.
  [[nodiscard]] std::uint32_t step() const;
  // The share, among the samples whose code is neither 0 nor 65535, of those that leave at most `most` when divided.
  [[nodiscard]] double remainders(std::uint32_t divisor, std::uint32_t most) const;
  // How many different codes occur.
  [[nodiscard]] int kinds() const;
  // Likewise, of those in `low` .. `high`, both included.
  [[nodiscard]] int kinds(std::uint32_t low, std::uint32_t high) const;
  // True if code 0 occurs, a sensor's hole, and no code of 1 .. `gap` does.
  [[nodiscard]] bool hasGapAtZero(std::uint32_t gap) const;
  // The same samples, also of the later pictures, without those whose code is in `set`.
  [[nodiscard]] CodeCount without(const CodeSet& set) const;

 private:
  int bits_ = 8;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> of_code_;
  std::vector<CodeCount> later_;
};

// True for a picture of 16-bit gray whose neighbouring samples are alike only after their bytes are swapped.
[[nodiscard]] bool isSwapped(const Frame& depth);
// True for a picture of 16-bit gray whose neighbouring samples are alike only without their upper three bits.
[[nodiscard]] bool hasConfidence(const Frame& depth);
// True for bits rotated left by three: multiples of 8 up to 8.19 m, one more up to 16.38 m.
[[nodiscard]] bool isRotated(const CodeCount& count);
// True if below the distance stands the number of the person that is seen there, 1 to 6, in some of the pictures.
// Rotated codes end otherwise than in 0 beyond 8.19 m alone, and there they begin again.
[[nodiscard]] bool hasPlayers(const CodeCount& count);
// Where the two bytes of 16-bit codes lie in the red and green of an 8-bit RGB picture whose blue is constant, or the
// three bytes of 24-bit codes, the lowest in red; or a float's four bytes in RGBA. Returns AsStored unless the lower
// byte often wraps where the upper one changes by one.
[[nodiscard]] SampleOrder packedOrder(const Frame& depth);
// True if a component of the picture is the same in all samples but a hundredth.
[[nodiscard]] bool isConstant(const Frame& frame, std::size_t part);
// True if most samples with a reading have none beside, above and below: the points of a laser scanner.
[[nodiscard]] bool isScattered(const Frame& depth);

// How much neighbouring samples differ, as a share of the range of the codes: the median. Depth is smooth, infrared and
// other photos are not. 1 if the picture shows nothing, or a few codes alone: labels, confidence, a mask.
[[nodiscard]] double roughnessOf(const Frame& gray);

// True for RGB of more than 8 bits whose samples are all gray: each component is the code.
[[nodiscard]] bool hasEqualColors(const Frame& depth) noexcept;

// The order of the samples of a kind's pictures, of which `stored` is one: as stored if a reader of pictures has put a
// Kinect's raw codes in order already.
[[nodiscard]] SampleOrder orderOf(const KnownKind& kind, const Frame& stored);
// The same; if there is no kind, or the kind keeps the order of the file, the picture decides.
[[nodiscard]] SampleOrder orderOf(const KnownKind* kind, const Frame& stored);

// The picture with its 16-bit codes put in order, as gray: a copy; other pictures, those as stored and
// those of equal colours by reference. Even steps are of 12-bit gray, or of a film's luma.
// Exhausted if out of memory.
[[nodiscard]] Result<Frame> inOrder(const Frame& depth, const SampleOrder& order);

}  // namespace relievo
