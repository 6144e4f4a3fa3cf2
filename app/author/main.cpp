// SPDX-License-Identifier: Apache-2.0
// relievo-author: the content maker's program.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <thread>

#include "app/author/author.h"
#include "app/author/output.h"
#include "drivers/registry.h"
#include "platform/clock.h"

namespace relievo {
namespace {

constexpr int kDone = 0, kFailed = 1, kWrongUse = 2;

std::atomic<bool> stop_wanted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void stopOnSignals() {
  struct sigaction action{};
  action.sa_handler = [](int) { stop_wanted.store(true, std::memory_order_relaxed); };
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(number, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of the write, told like any other
}

int complain(const std::string& thing, const Error& error) {
  const std::string why = error.os_error != 0 ? std::string(" (") + std::strerror(error.os_error) + ")" : "";
  std::fprintf(stderr, "relievo-author: %s: %s%s\n", thing.c_str(), error.message, why.c_str());
  return error.code == ErrorCode::InvalidArgument ? kWrongUse : kFailed;
}

// One line that is written over, on a terminal alone.
class ProgressLine {
 public:
  ~ProgressLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  void show(std::uint64_t done, std::optional<std::uint64_t> total) {
    if (!on_terminal_) return;
    const MonotonicTime now = clock_.now();
    if (shown_ && now - last_ < std::chrono::milliseconds(200)) return;
    shown_ = true;
    last_ = now;
    std::fprintf(stderr, "\r\033[K%s", progressText(done, total, now - start_).c_str());
    std::fflush(stderr);
  }

 private:
  MonotonicClock clock_;
  bool on_terminal_ = ::isatty(STDERR_FILENO) == 1;
  MonotonicTime start_ = clock_.now(), last_ = start_;
  bool shown_ = false;
};

struct Arguments {
  SourceOptions source;
  OutputOptions output;
  std::string calibration, scene;
  int crf = -1, depth_crf = -1;
};

void addOptions(CLI::App& app, Arguments& a) {
  app.footer(
      "Examples\n"
      "  a colour film and a depth film, both of any kind that FFmpeg opens, into one file:\n"
      "    relievo-author --color street.mp4 --depth street-depth.mkv -o film.mkv\n"
      "  a depth camera's film, colour above, depth below as hue, with what its depth means:\n"
      "    relievo-author --color desk.mov --packing tb --depth-code hue --calibration near=520,far=1260 -o desk.mp4\n"
      "\n"
      "The file holds two H.264 tracks: colour (4:2:0) and depth (4:0:0, 8 bits, full range, near is high), each "
      "picture at\n"
      "the time it had. The depth's meaning is written in its tags. At the end a table says what was done to the "
      "depth.");
  app.add_option("--color", a.source.url, "colour: a file or a URL; without --depth it holds the depth as well")
      ->type_name("SRC");
  app.add_option("--depth", a.source.depth_url, "depth of 8 to 16 bits: a file or a URL")->type_name("SRC");
  app.add_option("-o,--output", a.output.path, "the film to write: .mkv, .mp4, .m4v or .mov")
      ->required()
      ->type_name("OUT");
  app.add_option("--depth-code", a.source.depth_code, "what carries the depth: luma (default) or hue")
      ->type_name("luma|hue")
      ->transform(
          CLI::CheckedTransformer(std::map<std::string, DepthCode>{{"luma", DepthCode::Luma}, {"hue", DepthCode::Hue}})
              .description(""));
  app.add_option("--packing", a.source.packing,
                 "where the depth lies: auto (default), tracks, sbs (right half of the picture), tb (lower half)")
      ->type_name("auto|tracks|sbs|tb")
      ->transform(CLI::CheckedTransformer(std::map<std::string, Packing>{{"auto", Packing::Auto},
                                                                         {"tracks", Packing::Tracks},
                                                                         {"sbs", Packing::SideBySide},
                                                                         {"tb", Packing::TopBottom}})
                      .description(""));
  app.add_option(
         "--calibration", a.calibration,
         "what a depth code means, if the source does not say it: law=linear|inverse polarity=near-high|near-low "
         "range=full|limited bits=8..16 invalid=CODE|none near=MM far=MM")
      ->type_name("FILE|KEY=VALUE,..");
  app.add_option("--crf", a.crf, "quality of both tracks, 0 (lossless) to 51 (default: 18 for colour, 8 for depth)")
      ->type_name("N")
      ->check(CLI::Range(0, 51).description(""));
  app.add_option("--depth-crf", a.depth_crf,
                 "quality of the depth alone; 0 keeps every code, where hardware can decode it")
      ->type_name("N")
      ->check(CLI::Range(0, 51).description(""));
  app.add_option("--scene", a.scene, "make a film of the project's own instead, with its exact depth: sample")
      ->type_name("NAME")
      ->check(CLI::IsMember({"sample"}).description(""))
      ->excludes("--color")
      ->excludes("--depth")
      ->excludes("--packing")
      ->excludes("--depth-code")
      ->excludes("--calibration");
  app.add_flag("--force", a.output.force, "replace OUT if it is there");
}

Result<void> readCalibration(Arguments& a) {
  if (a.calibration.empty()) return {};
  std::ifstream file(a.calibration);
  const bool from_file = a.calibration.find('=') == std::string::npos;
  if (from_file && !file.good())
    return fail(ErrorCode::NotFound, "no such file; name one, or write KEY=VALUE,KEY=VALUE,..");
  const std::string text = from_file ? std::string(std::istreambuf_iterator<char>(file), {}) : a.calibration;
  auto settings = parseCalibration(text);
  if (!settings) return std::unexpected(settings.error());
  (from_file ? a.source.side_file : a.source.command_line) = std::move(*settings);
  return {};
}

int run(Arguments& a) {
  if (a.scene.empty() && a.source.url.empty()) {
    return complain("--color",
                    {ErrorCode::InvalidArgument, 0, "missing: name the film's colour, or take --scene sample"});
  }
  if (auto read = readCalibration(a); !read) return complain("--calibration " + a.calibration, read.error());
  if (a.crf >= 0) a.output.color_crf = a.output.depth_crf = a.crf;
  if (a.depth_crf >= 0) a.output.depth_crf = a.depth_crf;

  stopOnSignals();
  Outcome<AuthorSummary> summary;
  {
    ProgressLine line;
    const auto progress = [&line](std::uint64_t done, std::optional<std::uint64_t> total) { line.show(done, total); };
    if (a.scene.empty()) {
      const std::string url = a.source.url;
      const PairReader::Backends backends{[url] { return drivers::makeMediaSource(url); }, drivers::makeVideoDecoder};
      summary = authorFilm(a.source, backends, a.output, stop_wanted, progress);
    } else {
      const int threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
      summary = authorSample({.threads = threads}, a.output, stop_wanted, progress);
    }
  }
  if (!summary) return complain(summary.error().thing, summary.error().error);
  std::fputs(toText(a.output.path, *summary).c_str(), stdout);
  return kDone;
}

int parseAndRun(int argc, char** argv) {
  CLI::App app("Brings colour and depth together in one film that can be touched.", "relievo-author");
  Arguments arguments;
  addOptions(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "relievo-author: %s; see --help\n", error.what());
    return kWrongUse;
  }
  return run(arguments);
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  try {
    return relievo::parseAndRun(argc, argv);
  } catch (const std::exception& error) {  // out of memory, out of threads
    std::fprintf(stderr, "relievo-author: %s; close other programs and try again\n", error.what());
    return relievo::kFailed;
  }
}
