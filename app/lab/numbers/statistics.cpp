// SPDX-License-Identifier: Apache-2.0
// Sums of squares, so that ticks of several runs can be put together.
#include "app/lab/numbers/statistics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace relievo {
namespace {

// Exact for small angles too, where an arc cosine is not.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

void ForceErrorSum::add(const glm::dvec3& force, bool contact, const glm::dvec3& true_force, bool true_contact) {
  if (!true_contact) return;
  ++ticks_;
  if (!contact) ++lost_;
  const glm::dvec3 felt = contact ? force : glm::dvec3(0);
  const glm::dvec3 error = felt - true_force;
  const double felt_n = glm::length(felt), true_n = glm::length(true_force);
  vector_ += glm::dot(error, error);
  magnitude_ += (felt_n - true_n) * (felt_n - true_n);
  truth_ += true_n * true_n;
  if (felt_n <= 0 || true_n <= 0) return;
  const double angle = angleBetween(felt, true_force);
  angle_ += angle * angle;
  ++touching_;
}

void ForceErrorSum::add(const ForceErrorSum& other) {
  vector_ += other.vector_;
  magnitude_ += other.magnitude_;
  angle_ += other.angle_;
  truth_ += other.truth_;
  ticks_ += other.ticks_;
  touching_ += other.touching_;
  lost_ += other.lost_;
}

ForceError ForceErrorSum::result() const {
  ForceError error{.ticks = ticks_, .lost_ticks = lost_};
  if (ticks_ == 0 || truth_ <= 0) return error;
  error.rms_n = std::sqrt(vector_ / static_cast<double>(ticks_));
  error.rms_percent = 100 * std::sqrt(vector_ / truth_);
  error.magnitude_rms_percent = 100 * std::sqrt(magnitude_ / truth_);
  if (touching_ > 0) {
    error.direction_rms_deg = std::sqrt(angle_ / static_cast<double>(touching_)) * 180 / std::numbers::pi;
  }
  return error;
}

Spread spreadOf(std::vector<double> samples) {
  Spread spread{.count = samples.size()};
  if (samples.empty()) return spread;
  const auto rank = [&](double fraction) {
    const auto at = samples.begin() + std::lround(fraction * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), at, samples.end());
    return *at;
  };
  spread.median = rank(0.5);
  spread.p99 = rank(0.99);
  spread.p999 = rank(0.999);
  return spread;
}

std::vector<double> mediansOfRounds(std::span<const double> samples, int rounds) {
  std::vector<double> medians(samples.size() / static_cast<std::size_t>(rounds)), same;
  for (std::size_t i = 0; i < medians.size(); ++i) {
    same.clear();
    for (std::size_t at = i; at < samples.size(); at += medians.size()) same.push_back(samples[at]);
    medians[i] = spreadOf(same).median;
  }
  return medians;
}

}  // namespace relievo
