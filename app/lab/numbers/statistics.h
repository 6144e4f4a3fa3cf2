// SPDX-License-Identifier: Apache-2.0
// Statistics over many ticks: the error of a force, and the spread of times.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace relievo {

struct ForceError {
  double rms_n = 0;              // of the force vectors' difference
  double rms_percent = 0;        // the same, relative to the true force's rms
  double direction_rms_deg = 0;  // over the ticks in which both forces are nonzero
  double magnitude_rms_percent = 0;
  std::size_t ticks = 0, lost_ticks = 0;  // lost: true contact, but none by the method

  // True if contact is lost in more than a hundredth of the ticks: the error is then that of a missing force.
  [[nodiscard]] bool contactLost() const { return lost_ticks > ticks / 100; }
};

// A tick without true contact does not count.
class ForceErrorSum {
 public:
  // A method without contact gives no force.
  void add(const glm::dvec3& force, bool contact, const glm::dvec3& true_force, bool true_contact);
  void add(const ForceErrorSum& other);
  [[nodiscard]] ForceError result() const;

 private:
  double vector_ = 0, magnitude_ = 0, angle_ = 0, truth_ = 0;  // sums of squares: N^2, rad^2
  std::size_t ticks_ = 0, touching_ = 0, lost_ = 0;
};

struct Spread {
  double median = 0, p99 = 0, p999 = 0;
  std::size_t count = 0;
};

// By rank, without interpolation; zeros for no samples.
[[nodiscard]] Spread spreadOf(std::vector<double> samples);

// `samples`: one round after the other, all of the same length. For each place in a round the median over the rounds.
[[nodiscard]] std::vector<double> mediansOfRounds(std::span<const double> samples, int rounds);

}  // namespace relievo
