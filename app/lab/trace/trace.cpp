// SPDX-License-Identifier: Apache-2.0
// The loop of the haptic task without a device, a thread or fades.
#include "app/lab/trace/trace.h"

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <span>

#include "app/depth_window/touch_plan.h"
#include "app/haptics/task/safety.h"
#include "app/lab/finger/hip_path.h"
#include "platform/atomic_file.h"
#include "platform/clock.h"

namespace relievo {
namespace {

constexpr double kUsualStiffness = 0.5;  // N/mm
constexpr const char* kOutHeader =
    "t_s,hip_x_mm,hip_y_mm,hip_z_mm,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,contact,update_ns\n";

std::optional<bool> jumpThreshold(TraceGuard guard) {
  if (guard == TraceGuard::Off) return false;
  if (guard == TraceGuard::Threshold) return true;
  return std::nullopt;
}

// "bspline in space, levels of 0.28 and 0.72 mm, linear and fitted in time", "triangles in space, hold in time".
std::string describe(const MethodParts& parts) {
  const std::string space = std::string(name(parts.space)) + " in space, ";
  return space + (parts.scale ? relievo::describe(*parts.scale) : std::string(name(parts.time)) + " in time");
}

void writeRow(AtomicFile& out, const HipTick& tick, const Touch& touch, const glm::dvec3& force, Duration took) {
  char row[400];
  const int length =
      std::snprintf(row, sizeof row, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%d,%lld\n", tick.t_s,
                    tick.hip_mm.x, tick.hip_mm.y, tick.hip_mm.z, touch.proxy_mm.x, touch.proxy_mm.y, touch.proxy_mm.z,
                    force.x, force.y, force.z, touch.contact ? 1 : 0, static_cast<long long>(took.count()));
  out.write({row, static_cast<std::size_t>(length)});
}

}  // namespace

Outcome<void> checkParts(const TraceOptions& options) {
  const std::optional<SpaceLaw> space = options.space;
  const std::optional<TimeLaw> time = options.time;
  const auto go = [&](std::optional<SpaceLaw> s, std::optional<TimeLaw> t) {
    return partsOf(options.method, {.space = s, .time = t}).has_value();
  };
  const auto refuse = [](const std::string& one, const std::string& other, const char* what_goes) {
    return failOn(one + " with " + other, {ErrorCode::InvalidArgument, 0, what_goes});
  };
  const std::string method = "--method " + options.method;
  if (space && !go(space, {})) {
    return refuse(std::string("--space ") + name(*space), method,
                  "they cannot be combined; only relievo has quadratic and bspline, the others use triangles");
  }
  if (time && !go({}, time)) {
    return refuse(std::string("--time ") + name(*time), method,
                  "they cannot be combined; only relievo has bspline, fitted, adapted and mean, proxy-blend uses hold, "
                  "the others hold or linear");
  }
  const Material& material = options.film.source.material;
  const auto parts = partsOf(options.method, {.space = space, .time = time});
  if ((material.friction || material.texture) && parts && !parts->scale) {
    return refuse("--material " + materialText(material), method + (space ? " on triangles" : ""),
                  "they cannot be combined; only relievo on a smooth surface has friction and texture");
  }
  if (!go(space, time)) {
    return refuse(std::string("--time ") + name(*time), std::string("--space ") + name(*space),
                  "they cannot be combined; triangles need hold or linear");
  }
  return {};
}

Outcome<TraceSummary> runTrace(const TraceOptions& options, const PairReader::Backends& backends) {
  const auto path = readHipPath(options.hip_path);
  if (!path) return std::unexpected(path.error());
  DepthFilm film(backends, options.film);
  if (const auto opened = film.open(); !opened) return std::unexpected(opened.error());
  auto out = AtomicFile::create(options.out_path);
  if (!out) return failOn(options.out_path, out.error());
  out->write(kOutHeader);

  const auto first = film.windowAt(0);
  if (!first) return std::unexpected(first.error());
  const TouchPlan plan = planFilm(std::span((*first)->frames).first(static_cast<std::size_t>((*first)->count)));
  const Material& material = film.material();
  const double stiffness = options.stiffness_n_per_mm.value_or(material.stiffness_n_per_mm.value_or(kUsualStiffness));
  MethodConfig config{.stiffness_n_per_mm = stiffness,
                      .space = options.space,
                      .time = options.time,
                      .jump_threshold = jumpThreshold(options.guard),
                      .friction = material.friction.value_or(Friction{}),
                      .texture = material.texture.value_or(Texture{}),
                      .scale = plan.scale};
  // At the path's own rate, since methods depend on the tick's length.
  if (path->size() > 1) config.tick_s = (path->back().t_s - path->front().t_s) / static_cast<double>(path->size() - 1);
  const auto parts = partsOf(options.method, config);
  if (!parts)
    return failOn("--method " + options.method, {ErrorCode::InvalidArgument, 0, "unknown method; see --help"});
  const auto method = makeMethod(options.method, config);
  SafetyFilter safety({}, stiffness);
  const MonotonicClock clock;
  TraceSummary summary;
  summary.parts = describe(*parts);
  summary.doubts = film.doubts();
  if (parts->scale && !options.space && !options.time) summary.plan = plan.reason;
  const HipTick* before = nullptr;
  for (const HipTick& tick : *path) {
    const auto window = film.windowAt(tick.t_s);
    if (!window) return std::unexpected(window.error());
    const MonotonicTime begin = clock.now();
    const Touch touch = method->update(tick.hip_mm, **window, mediaTime(tick.t_s));
    const Duration took = clock.now() - begin;
    method->upkeep(**window, mediaTime(tick.t_s));

    glm::dvec3 force = touch.force_n;
    if (options.guard == TraceGuard::Full) {
      force = safety.apply(force, tick.hip_mm, before != nullptr ? tick.t_s - before->t_s : 0.0);
    }
    writeRow(*out, tick, touch, force, took);
    ++summary.ticks;
    summary.contact_ticks += touch.contact ? 1 : 0;
    summary.max_force_n = std::max(summary.max_force_n, glm::length(force));
    before = &tick;
  }
  if (const auto committed = out->commit(); !committed) return failOn(options.out_path, committed.error());
  return summary;
}

}  // namespace relievo
