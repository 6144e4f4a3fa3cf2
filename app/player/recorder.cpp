// SPDX-License-Identifier: Apache-2.0
// One line per tick; a thousand a second are some 100 kB.
#include "app/player/recorder.h"

#include <algorithm>
#include <cstdio>

namespace relievo {

Result<Recorder> Recorder::create(const std::string& path) {
  auto file = AtomicFile::create(path);
  if (!file) return std::unexpected(file.error());
  file->write(
      "t_s,hip_x_mm,hip_y_mm,hip_z_mm,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,contact,media_"
      "s\n");
  return Recorder(std::move(*file));
}

void Recorder::add(const FingerState& tick) noexcept {
  if (!first_) first_ = tick.time;
  char line[320];
  const glm::dvec3& h = tick.hip_mm;
  const glm::dvec3& p = tick.proxy_mm;
  const glm::dvec3& f = tick.force_n;
  const int length = std::snprintf(line, sizeof line, "%.6f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.6f,%.6f,%.6f,%d,%.6f\n",
                                   toSeconds(tick.time - *first_), h.x, h.y, h.z, p.x, p.y, p.z, f.x, f.y, f.z,
                                   tick.contact ? 1 : 0, toSeconds(tick.media_time));
  if (length > 0) file_.write({line, std::min(static_cast<std::size_t>(length), sizeof line - 1)});
}

}  // namespace relievo
