// SPDX-License-Identifier: Apache-2.0
// relievo-lab: the engineer's measurements.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>

#include "app/cli/options.h"
#include "app/cli/program.h"
#include "app/cli/text.h"
#include "app/lab/measurement.h"
#include "app/lab/report.h"
#include "app/lab/trace.h"
#include "drivers/registry.h"

namespace relievo {
namespace {

void addTrace(CLI::App& app, TraceOptions& options) {
  app.footer(
      "Example: a finger's path through a 16-bit depth film, by the paper's method\n"
      "  relievo-lab trace --depth plane.mkv --hip finger.csv --out force.csv --method modified-proxy-graph --guard "
      "off\n"
      "HIP.csv has the header t_s,x_mm,y_mm,z_mm and one row per tick, in the scene frame: x right, y up, z toward "
      "the\n"
      "viewer, origin at the centre of the far plane. Time 0 is the first frame's time.");
  SourceOptions& source = options.film.source;
  app.add_option("--depth", source.url, "Depth film: whatever FFmpeg opens, 8 to 16 bits")
      ->required()
      ->type_name("SRC");
  addDepthOptions(app, source);
  addVolumeOption(app, options.film.volume);
  app.add_option("--fps", options.film.frames_per_s, "Frames a second, for a source without timestamps")
      ->check(CLI::Range(0.01, 10000.0).description(""))
      ->type_name("F");
  app.add_option("--hip", options.hip_path, "The finger's path")->required()->type_name("HIP.csv");
  app.add_option("--out", options.out_path, "What came of it, a row per tick")->required()->type_name("OUT.csv");
  app.add_option("--method", options.method, std::string("Method of touch: ") + kMethodNames)
      ->required()
      ->type_name("NAME");
  app.add_option("--stiffness", options.stiffness_n_per_mm, "Stiffness between finger and proxy [0.5]")
      ->type_name("N_PER_MM")
      ->check(CLI::Range(1e-6, 1e3).description(""));
  addChoice(
      app, "--space", options.space,
      {{"triangles", SpaceLaw::Triangles}, {"quadratic", SpaceLaw::Quadratic}, {"bspline", SpaceLaw::BSpline}},
      "The surface between samples [the method's own]\ntriangles: the paper's; quadratic, bspline: a smooth local "
      "patch, of relievo alone");
  addChoice(app, "--time", options.time,
            {{"hold", TimeLaw::Hold},
             {"linear", TimeLaw::Linear},
             {"bspline", TimeLaw::BSpline},
             {"fitted", TimeLaw::Fitted}},
            "The surface between frames [the method's own]\nhold: the newest as it is; linear: the paper's; bspline, "
            "fitted: smooth splines, of relievo alone");
  addChoice(app, "--guard", options.guard,
            {{"off", TraceGuard::Off}, {"threshold", TraceGuard::Threshold}, {"full", TraceGuard::Full}},
            "What limits the force [the method's own]\noff: nothing; threshold: the paper's; full: all limits of the "
            "haptic task");
}

int runTraceCommand(const TraceOptions& options) {
  const SourceOptions& source = options.film.source;
  if (auto apart = keepApart({options.out_path}, {options.hip_path, source.url, source.depth_url}); !apart) {
    return tell(apart.error());
  }
  if (makeMethod(options.method, {}) == nullptr) {
    return tell(
        {"--method " + options.method, {ErrorCode::InvalidArgument, 0, "unknown; see relievo-lab trace --help"}});
  }
  if (makeMethod(options.method, {.space = options.space, .time = options.time}) == nullptr) {
    return tell({"--method " + options.method,
                 {ErrorCode::InvalidArgument, 0,
                  "does not go with these --space and --time; methods on triangles take triangles, hold and linear"}});
  }
  const std::string url = options.film.source.url;
  const PairReader::Backends backends{[url] { return drivers::makeMediaSource(url); }, drivers::makeVideoDecoder};
  const auto summary = runTrace(options, backends);
  if (!summary) return tell(summary.error(), kExitFailed);
  std::printf("%s: %zu ticks, %zu in contact, %.3f N at most\n", options.out_path.c_str(), summary->ticks,
              summary->contact_ticks, summary->max_force_n);
  if (!summary->plan.empty()) std::printf("plan: %s\n", summary->plan.c_str());
  return kExitDone;
}

CLI::App* addMeasurement(CLI::App& app, const char* name, const char* about, MeasureOptions& options) {
  CLI::App* const command = app.add_subcommand(name, about);
  command->add_flag("--quick", options.quick, "Fewer scenes, rounds and seconds: within a minute");
  command->add_option("--out", options.out, "Folder for the CSVs and SVGs; made when it is missing")
      ->required()
      ->type_name("DIR");
  return command;
}

Outcome<void> makeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    return failOn("--out " + path, {ErrorCode::Io, error.value(), "the folder cannot be made; choose another"});
  if (::access(path.c_str(), W_OK) != 0) {
    return failOn("--out " + path, {ErrorCode::Io, errno, "the folder cannot be written to; choose another"});
  }
  return {};
}

// `work` takes the options, with the way to tell how far it is.
template <class Work>
int runIntoFolder(MeasureOptions options, Work&& work) {
  if (const auto made = makeFolder(options.out); !made) return tell(made.error(), kExitFailed);
  Outcome<void> done;
  {
    ProgressLine line;
    options.tell = [&line](const std::string& what) {
      const auto s = static_cast<int>(toSeconds(line.elapsed()));
      line.say(print("%d:%02d  %s", s / 60, s % 60, what.c_str()));
    };
    done = work(options);
  }
  return done ? kExitDone : tell(done.error(), kExitFailed);
}

int parseAndRun(int argc, char** argv) {
  CLI::App app("Measures touch on moving depth.", "relievo-lab");
  app.require_subcommand(1);
  TraceOptions trace;
  CLI::App* const trace_command =
      app.add_subcommand("trace", "a finger's path through a depth film, tick by tick, on virtual time");
  addTrace(*trace_command, trace);
  MeasureOptions options;
  std::vector<std::pair<const CLI::App*, const Measurement*>> commands;
  for (const Measurement& m : measurements()) commands.emplace_back(addMeasurement(app, m.name, m.about, options), &m);
  addMeasurement(app, "report", "all of these that DIR has not yet, and one page over them", options);
  if (const auto parsed = parseCommandLine(app, argc, argv); !parsed) return parsed.error();

  if (trace_command->parsed()) return runTraceCommand(trace);
  for (const auto& [command, measurement] : commands) {
    if (!command->parsed()) continue;
    return runIntoFolder(options, [m = measurement](const MeasureOptions& o) { return runMeasurement(*m, o); });
  }
  return runIntoFolder(options, writeReport);
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  return relievo::runProgram("relievo-lab", [&] { return relievo::parseAndRun(argc, argv); });
}
