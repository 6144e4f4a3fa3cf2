// SPDX-License-Identifier: Apache-2.0
// The relievo-lab program: measures methods of touch and draws charts.
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>

#include "app/cli/options.h"
#include "app/cli/output_guard.h"
#include "app/cli/program.h"
#include "app/cli/progress_line.h"
#include "app/lab/chart/report.h"
#include "app/lab/measure/measurement.h"
#include "app/lab/trace/trace.h"
#include "drivers/registry.h"
#include "platform/print.h"

namespace relievo {
namespace {

std::vector<std::pair<std::string, std::string>> methodChoices() {
  std::vector<std::pair<std::string, std::string>> choices;
  std::istringstream names(kMethodNames);
  for (std::string name; names >> name;) choices.emplace_back(name, name);
  return choices;
}

void addTrace(CLI::App& app, TraceOptions& options) {
  app.footer(
      "Examples:\n"
      "  a finger's path through a 16-bit depth film, by the paper's method, with unlimited force\n"
      "    relievo-lab trace --depth plane.mkv --hip finger.csv --out force.csv --method modified-proxy-graph --guard "
      "off\n"
      "  the same by relievo with one part replaced: frames held, not interpolated\n"
      "    relievo-lab trace --depth plane.mkv --hip finger.csv --out force.csv --method relievo --time hold\n"
      "HIP.csv has the header t_s,x_mm,y_mm,z_mm and one row per tick, in the scene frame: x right, y up, z toward "
      "the\n"
      "viewer, origin at the centre of the far plane. Time 0 is the first frame's time. OUT.csv has a row per tick: "
      "the\n"
      "finger, the proxy, the force on the hand, contact (0 or 1), and the method's time in ns.");
  SourceOptions& source = options.film.source;
  app.add_option("--depth", source.url, "Depth film of 8 to 16 bits, in any format that FFmpeg opens")
      ->required()
      ->type_name("SRC");
  addDepthOptions(app, source);
  addMaterialOption(app, source);
  addBoxOption(app, options.film.volume);
  app.add_option("--fps", options.film.frames_per_s, "Frames per second, for a source without timestamps")
      ->check(between(0.01, 10000.0))
      ->type_name("F");
  app.add_option("--hip", options.hip_path, "Path of the finger")->required()->type_name("HIP.csv");
  app.add_option("--out", options.out_path, "Output: one row per tick")->required()->type_name("OUT.csv");
  addChoice(
      app, "--method", options.method, methodChoices(),
      "Method of touch\nrelievo: the player's own; modified-proxy-graph: the paper's (Cha et al., 2006); proxy-graph, "
      "proxy-blend: its\npredecessors; penalty: penetration depth, no proxy. The charts' god-object is relievo with "
      "--space triangles")
      ->required();
  app.add_option("--stiffness", options.stiffness_n_per_mm,
                 "Stiffness between finger and proxy, N/mm [the material's, else 0.5]")
      ->type_name("N_PER_MM")
      ->check(between(1e-6, 1e3));
  addChoice(app, "--space", options.space,
            {{"triangles", SpaceLaw::Triangles}, {"quadratic", SpaceLaw::Quadratic}, {"bspline", SpaceLaw::BSpline}},
            "The surface between samples [the method's own]\ntriangles: the paper's; quadratic, bspline: smooth local "
            "patches, only for relievo");
  addChoice(app, "--time", options.time,
            {{"hold", TimeLaw::Hold},
             {"linear", TimeLaw::Linear},
             {"bspline", TimeLaw::BSpline},
             {"fitted", TimeLaw::Fitted},
             {"adapted", TimeLaw::Adapted},
             {"mean", TimeLaw::Mean}},
            "The surface between frames [the method's own]\nhold: the newest frame; linear: the paper's; bspline, "
            "fitted: splines; adapted: the fitted one where it adds more than noise, else bspline; mean: of five "
            "frames. bspline, fitted, adapted and mean work only with relievo on smooth patches");
  addChoice(app, "--guard", options.guard,
            {{"off", TraceGuard::Off}, {"threshold", TraceGuard::Threshold}, {"full", TraceGuard::Full}},
            "Limits on the force [the method's own]\noff: nothing; threshold: the paper's guard, which releases the "
            "finger when the "
            "force jumps; full: all limits of the haptic task");
}

int runTraceCommand(const TraceOptions& options) {
  const SourceOptions& source = options.film.source;
  std::vector<std::string> inputs = source.named_files;
  inputs.insert(inputs.end(), {options.hip_path, source.url, source.depth_url});
  if (auto apart = keepApart({options.out_path}, inputs); !apart) {
    return tell(apart.error());
  }
  if (auto checked = checkParts(options); !checked) return tell(checked.error());
  const PairReader::Backends backends{drivers::makeMediaSource, drivers::makeSoftwareDecoder};
  const auto summary = runTrace(options, backends);
  if (!summary) return tell(summary.error());
  std::printf("%s: %zu ticks, %zu in contact, %.3f N at most\n", options.out_path.c_str(), summary->ticks,
              summary->contact_ticks, summary->max_force_n);
  std::printf("parts: %s\n", summary->parts.c_str());
  if (!summary->plan.empty()) std::printf("plan: %s\n", summary->plan.c_str());
  for (const std::string& doubt : summary->doubts) std::printf("doubt: %s\n", doubt.c_str());
  return kExitDone;
}

CLI::App* addMeasurement(CLI::App& app, const char* name, const char* about, MeasureOptions& options) {
  CLI::App* const command = app.add_subcommand(name, about);
  command->add_flag("--quick", options.quick,
                    "Fewer scenes, rounds and seconds: a measurement takes under a minute, a report a few minutes");
  command->add_option("--out", options.out, "Output folder for CSV and SVG files; created if missing")
      ->required()
      ->type_name("DIR");
  return command;
}

Outcome<void> makeFolder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) return failOn("--out " + path, {ErrorCode::Io, error.value(), "cannot create the folder; choose another"});
  if (::access(path.c_str(), W_OK) != 0) {
    return failOn("--out " + path, {ErrorCode::Io, errno, "cannot write to the folder; choose another"});
  }
  return {};
}

// Runs `work` with the options and a function that reports progress. `files` describes the output.
template <class Work>
int runIntoFolder(MeasureOptions options, Work&& work, const std::string& files) {
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
  if (!done) return tell(done.error(), kExitFailed);
  std::printf("%s/%s\n", options.out.c_str(), files.c_str());
  return kExitDone;
}

// "smoothness.svg, smoothness-hand.svg; data in .csv files of the same names"
std::string chartFiles(const Measurement& measurement) {
  std::string words;
  for (const ChartEntry& chart : measurement.charts)
    words += (words.empty() ? "" : ", ") + std::string(chart.name) + ".svg";
  return words + "; data in .csv files of the same names";
}

// Films come and go, frame by frame of half a megabyte and more. By default the C library returns such memory to the
// system and faults it in again page by page, which takes a third of a measurement's time.
void keepFreedMemory() {
  ::mallopt(M_ARENA_MAX, 1);
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the largest value that mallopt accepts
  ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  ::mallopt(M_TOP_PAD, 64 << 20);
}

int parseAndRun(int argc, char** argv) {
  CLI::App app("Measures methods of touch on moving depth, and how fast and exactly that depth is drawn.",
               "relievo-lab");
  app.footer(
      "\nExamples:\n"
      "  relievo-lab report --quick --out charts      all charts in a few minutes, with charts/index.html as the "
      "overview\n"
      "  relievo-lab trace --help                     one finger, one film, one method, tick by tick\n"
      "\nIn the charts, `god-object` is the method relievo on the triangles of Cha et al. (2006): a converged proxy;\n"
      "`god-object-smoothed` is the same on depth whose frames are smoothed first; `bullet` is a god-object on "
      "the\n"
      "height field of the Bullet library. A name such as `relievo hold` is a method with one part replaced.\n");
  app.require_subcommand(1);
  TraceOptions trace;
  CLI::App* const trace_command = app.add_subcommand(
      "trace", "runs one method along a finger's path through a depth film, tick by tick, on virtual time");
  addTrace(*trace_command, trace);
  MeasureOptions options;
  std::vector<std::pair<const CLI::App*, const Measurement*>> commands;
  for (const Measurement& m : measurements()) commands.emplace_back(addMeasurement(app, m.name, m.about, options), &m);
  app.get_subcommand("enhance")
      ->add_option("--depth", options.depth_films,
                   "Depth films whose first pictures are added to the chart of mesh points")
      ->type_name("SOURCE");
  addMeasurement(app, "report", "runs each measurement whose results are not yet in DIR and writes an overview page",
                 options);
  if (const auto parsed = parseCommandLine(app, argc, argv); !parsed) return parsed.error();

  if (trace_command->parsed()) return runTraceCommand(trace);
  const auto display = drivers::makeDisplay("offscreen");
  if (!display) return tell(display.error());
  options.display = display->get();
  options.backends = {drivers::makeMediaSource, drivers::makeSoftwareDecoder};
  for (const auto& [command, measurement] : commands) {
    if (!command->parsed()) continue;
    const auto run = [m = measurement](const MeasureOptions& o) { return runMeasurement(*m, o); };
    return runIntoFolder(options, run, chartFiles(*measurement));
  }
  return runIntoFolder(options, writeReport, "index.html shows every chart; charts are .svg, data .csv");
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  relievo::keepFreedMemory();
  return relievo::runProgram("relievo-lab", [&] { return relievo::parseAndRun(argc, argv); });
}
