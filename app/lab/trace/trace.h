// SPDX-License-Identifier: Apache-2.0
// Runs a finger's path through a depth film, tick by tick, on virtual time, and records the proxy and the force.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/haptics/baseline/methods.h"
#include "app/lab/trace/depth_film.h"
#include "platform/failure.h"

namespace relievo {

enum class TraceGuard : std::uint8_t {
  Own,        // the method's own
  Off,        // none: stiffness x (proxy - HIP)
  Threshold,  // the paper's force-jump threshold (IV-C)
  Full,       // the method's own, then the safety limits of the haptic task
};

struct TraceOptions {
  DepthFilmOptions film;
  std::string hip_path;
  std::string out_path;
  std::string method = kDefaultMethod;
  std::optional<double> stiffness_n_per_mm;  // nullopt: the material's, else 0.5
  std::optional<SpaceLaw> space;
  std::optional<TimeLaw> time;
  TraceGuard guard = TraceGuard::Own;
};

struct TraceSummary {
  std::size_t ticks = 0, contact_ticks = 0;
  double max_force_n = 0;
  std::string parts;                // parts that the method used
  std::string plan;                 // `relievo` with its own parts: the plan for this film and its reason
  std::vector<std::string> doubts;  // why the depth may be read wrongly
};

// InvalidArgument for options that cannot be combined; the failure names both.
[[nodiscard]] Outcome<void> checkParts(const TraceOptions& options);

// Writes OUT.csv, whole or not at all: one row per row of the path, columns t_s, hip_x_mm .. hip_z_mm, proxy_x_mm ..
// proxy_z_mm, force_x_n .. force_z_n, contact, update_ns (the method's `update`, by the monotonic clock).
[[nodiscard]] Outcome<TraceSummary> runTrace(const TraceOptions& options, const PairReader::Backends& backends);

}  // namespace relievo
