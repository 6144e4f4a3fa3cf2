// SPDX-License-Identifier: Apache-2.0
// relievo-lab: the engineer's measurements.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "app/lab/trace.h"
#include "drivers/registry.h"

namespace relievo {
namespace {

constexpr int kDone = 0, kFailed = 1, kWrongUse = 2;

int complain(const std::string& thing, const Error& error, int exit_code) {
  const std::string why = error.os_error != 0 ? std::string(" (") + std::strerror(error.os_error) + ")" : "";
  std::fprintf(stderr, "relievo-lab: %s: %s%s\n", thing.c_str(), error.message, why.c_str());
  return exit_code;
}

// "160x108x40", millimetres.
std::optional<DisplayVolume> parseVolume(const std::string& text) {
  DisplayVolume v;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lfx%lfx%lf%c", &v.width_mm, &v.height_mm, &v.depth_mm, &rest) != 3)
    return std::nullopt;
  if (!(v.width_mm > 0 && v.height_mm > 0 && v.depth_mm > 0 && v.width_mm < 1e5 && v.height_mm < 1e5 &&
        v.depth_mm < 1e5)) {
    return std::nullopt;
  }
  return v;
}

struct TraceArguments {
  TraceOptions options;
  std::string volume, calibration;
};

void addTrace(CLI::App& app, TraceArguments& a) {
  app.footer(
      "Example: a finger's path through a 16-bit depth film, by the paper's method\n"
      "  relievo-lab trace --depth plane.mkv --hip finger.csv --out force.csv --method modified-proxy-graph --guard "
      "off\n"
      "HIP.csv has the header t_s,x_mm,y_mm,z_mm and one row per tick, in the scene frame: x right, y up, z toward "
      "the\n"
      "viewer, origin at the centre of the far plane. Time 0 is the first frame's time.");
  SourceOptions& source = a.options.film.source;
  app.add_option("--depth", source.url, "depth film: whatever FFmpeg opens, 8 to 16 bits")
      ->required()
      ->type_name("SRC");
  app.add_option("--packing", source.packing,
                 "where the depth lies in SRC: auto, tracks, sbs (right half), tb (lower half)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Packing>{{"auto", Packing::Auto},
                                                                         {"tracks", Packing::Tracks},
                                                                         {"sbs", Packing::SideBySide},
                                                                         {"tb", Packing::TopBottom}}));
  app.add_option("--depth-code", source.depth_code, "what carries the depth: luma, hue")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, DepthCode>{{"luma", DepthCode::Luma}, {"hue", DepthCode::Hue}}));
  app.add_option("--calibration", a.calibration,
                 "what a code means: a FILE, or KEY=VALUE,KEY=VALUE,.. of law polarity range "
                 "bits invalid near far");
  app.add_option("--volume", a.volume, "display volume in mm, for instance 160x108x40 (default: 160 wide, 40 deep)")
      ->type_name("WxHxD");
  app.add_option("--fps", a.options.film.frames_per_s, "frames a second, for a source without timestamps")
      ->check(CLI::Range(0.01, 10000.0));
  app.add_option("--hip", a.options.hip_path, "the finger's path")->required()->type_name("HIP.csv");
  app.add_option("--out", a.options.out_path, "what came of it, a row per tick")->required()->type_name("OUT.csv");
  app.add_option("--method", a.options.method, std::string("method of touch: ") + kMethodNames)->required();
  app.add_option("--stiffness", a.options.stiffness_n_per_mm, "N per mm between finger and proxy")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 1e3));
  app.add_option("--time", a.options.time, "the surface between frames: hold, linear (default: the method's own)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, TimeLaw>{{"hold", TimeLaw::Hold}, {"linear", TimeLaw::Linear}}));
  app.add_option("--guard", a.options.guard,
                 "off, threshold (the paper's), full (all limits of the haptic task); default: "
                 "the method's own")
      ->transform(CLI::CheckedTransformer(std::map<std::string, TraceGuard>{
          {"off", TraceGuard::Off}, {"threshold", TraceGuard::Threshold}, {"full", TraceGuard::Full}}));
}

int runTraceCommand(TraceArguments& a) {
  if (!a.volume.empty()) {
    a.options.film.volume = parseVolume(a.volume);
    if (!a.options.film.volume) {
      return complain("--volume " + a.volume, {.message = "three lengths in mm with x between, 160x108x40"}, kWrongUse);
    }
  }
  if (makeMethod(a.options.method, {}) == nullptr) {
    return complain("--method " + a.options.method, {.message = "unknown; see relievo-lab trace --help"}, kWrongUse);
  }
  if (!a.calibration.empty()) {
    std::ifstream file(a.calibration);
    const bool from_file = file.good() && a.calibration.find('=') == std::string::npos;
    const std::string text = from_file ? std::string(std::istreambuf_iterator<char>(file), {}) : a.calibration;
    const auto settings = parseCalibration(text);
    if (!settings) return complain("--calibration " + a.calibration, settings.error(), kWrongUse);
    SourceOptions& source = a.options.film.source;
    (from_file ? source.side_file : source.command_line) = *settings;
  }
  const std::string url = a.options.film.source.url;
  const PairReader::Backends backends{[url] { return drivers::makeMediaSource(url); }, drivers::makeVideoDecoder};
  const auto summary = runTrace(a.options, backends);
  if (!summary) return complain(summary.error().thing, summary.error().error, kFailed);
  std::printf("%s: %zu ticks, %zu in contact, %.3f N at most\n", a.options.out_path.c_str(), summary->ticks,
              summary->contact_ticks, summary->max_force_n);
  return kDone;
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  CLI::App app("Measures touch on moving depth.");
  app.require_subcommand(1);
  relievo::TraceArguments trace;
  CLI::App* trace_command =
      app.add_subcommand("trace", "a finger's path through a depth film, tick by tick, on virtual time");
  relievo::addTrace(*trace_command, trace);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "relievo-lab: %s; see --help\n", error.what());
    return relievo::kWrongUse;
  }
  return relievo::runTraceCommand(trace);
}
