// SPDX-License-Identifier: Apache-2.0
// One line per tick; a thousand a second are some 300 kB.
#include "app/player/touch/recorder.h"

#include <array>
#include <charconv>
#include <string_view>

namespace relievo {
namespace {

constexpr const char* kHeader =
    "t_s,hip_x_mm,hip_y_mm,hip_z_mm,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,contact,media_s,"
    "device_x_mm,device_y_mm,device_z_mm,buttons,device_present,workspace_min_x_mm,workspace_min_y_mm,"
    "workspace_min_z_mm,workspace_max_x_mm,workspace_max_y_mm,workspace_max_z_mm,peak_force_n,continuous_force_n,"
    "max_stiffness_n_per_mm,rate_hz\n";

// Cells with commas between. A double takes 24 characters at most.
class Line {
 public:
  template <class Number>
  Line& operator<<(Number number) noexcept {
    comma();
    end_ = std::to_chars(end_, text_.data() + text_.size(), number).ptr;
    return *this;
  }
  Line& operator<<(const glm::dvec3& v) noexcept { return *this << v.x << v.y << v.z; }
  void skip() noexcept { comma(); }
  [[nodiscard]] std::string_view finish() noexcept {
    *end_++ = '\n';
    return {text_.data(), end_};
  }

 private:
  void comma() noexcept {
    if (!first_) *end_++ = ',';
    first_ = false;
  }
  static constexpr std::size_t kCells = 27, kLongestCell = 25;
  std::array<char, kCells * kLongestCell + 1> text_;
  char* end_ = text_.data();
  bool first_ = true;
};

// A division gives whole microseconds exactly; a multiplication by 1e-9 would not.
double secondsOf(Duration d) noexcept {
  return static_cast<double>(d.count()) / 1e9;
}

}  // namespace

Result<Recorder> Recorder::create(const std::string& path) {
  auto file = AtomicFile::create(path);
  if (!file) return std::unexpected(file.error());
  file->write(kHeader);
  return Recorder(std::move(*file));
}

void Recorder::add(const FingerState& tick) {
  if (!first_) first_ = tick.time;
  Line line;
  line << secondsOf(tick.time - *first_) << tick.hip_mm << tick.proxy_mm << tick.force_n << (tick.contact ? 1 : 0)
       << secondsOf(tick.media_time.time_since_epoch()) << tick.device_mm << tick.buttons
       << (tick.device_present ? 1 : 0);
  if (device_) {
    if (device_->in_scene) {
      for (int i = 0; i < 6; ++i) line.skip();
    } else {
      line << device_->workspace_min_mm << device_->workspace_max_mm;
    }
    line << device_->peak_force_n << device_->continuous_force_n << device_->max_stiffness_n_per_mm << device_->rate_hz;
    device_.reset();
  } else {
    for (int i = 0; i < 10; ++i) line.skip();
  }
  file_.write(line.finish());
}

}  // namespace relievo
