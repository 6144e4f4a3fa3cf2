// SPDX-License-Identifier: Apache-2.0
// The relievo-author program, for content makers.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <thread>

#include "app/author/author.h"
#include "app/author/package/output.h"
#include "app/cli/options.h"
#include "app/cli/output_guard.h"
#include "app/cli/program.h"
#include "app/cli/progress_line.h"
#include "app/cli/read_files.h"
#include "app/media/folder/film_folder.h"
#include "app/media/playlist.h"
#include "drivers/registry.h"
#include "hal/media/video_decoder.h"
#include "platform/clock.h"
#include "platform/files/answered_place.h"
#include "platform/files/file_system_answer.h"
#include "platform/text/number_in.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

struct Arguments {
  SourceOptions source;
  OutputOptions output;
  std::string scene, paintings, depth_from;
  SwapEyes swap_eyes = SwapEyes::Auto;
  std::optional<DepthSize> depth_size;
  int crf = -1, depth_crf = -1;
};

constexpr const char* kFooter =
    "Examples\n"
    "  combine a colour film and a depth film, in any format that FFmpeg opens:\n"
    "    relievo-author --color street.mp4 --depth street-depth.mkv -o film.mkv\n"
    "  combine a renderer's numbered pictures, depth of 16 bits in mm:\n"
    "    relievo-author --color color-%04d.png --depth depth-%04d.png --fps 24 --calibration unit=1,invalid=0 -o "
    "film.mkv\n"
    "  record two cameras until Ctrl-C:\n"
    "    relievo-author --color v4l2:/dev/video4 --depth v4l2:/dev/video2 --registration rig.toml -o film.mkv\n"
    "  convert a film with colour above and hue-coded depth below, giving its depth range:\n"
    "    relievo-author --color desk.mov --packing tb --depth-code hue --calibration near=520,far=1260 -o desk.mp4\n"
    "  make depth for a 3D film that has two views and no depth:\n"
    "    relievo-author --color holiday-3d.mkv --depth-from stereo -o film.mkv\n"
    "  guess depth for a film of one view:\n"
    "    relievo-author --color holiday.mp4 --depth-from midas-small.onnx -o film.mkv\n"
    "    relievo-author --color holiday.mp4 --depth-from 'python3 guess.py' -o film.mkv\n"
    "  send a transport stream in real time; receive it with relievo play udp://@:5000\n"
    "    relievo-author --color street.mp4 --depth street-depth.mkv -o udp://192.168.1.20:5000\n"
    "\n"
    "The film has two tracks: colour (H.264 4:2:0) and depth (by default H.264 4:0:0 of 8 bits), full range, near "
    "high.\n"
    "Pictures keep their timestamps. The calibration is written to the container's tags and into the H.264 or HEVC\n"
    "stream. Sound, subtitles, languages, chapters and titles of the colour's file are copied; a line names what the\n"
    "film's container cannot hold. At the end a table shows what was done to the depth.\n"
    "\n"
    "Exit code: 0 done, 1 failed at run time, or the film is made but a source was not whole, 2 usage error.";

void addSourceOptions(CLI::App& app, SourceOptions& source) {
  app.add_option("FILE,--color", source.url,
                 "Colour: a file, a URL, v4l2:DEVICE; without --depth it must also hold the depth")
      ->type_name("SRC");
  app.add_option("--depth", source.depth_url, "Depth of 8 to 16 bits: a file or a URL")->type_name("SRC");
  addRateOption(app, source);
}

CLI::Validator quality() {
  return {[](const std::string& word) -> std::string {
            int crf = -1;
            const bool good = CLI::detail::lexical_cast(word, crf) && word == std::to_string(std::clamp(crf, 0, 51));
            return good ? "" : word + " is not a whole number between 0 and 51";
          },
          ""};
}

// Quality of both tracks, and of the depth alone.
void addQualityOptions(CLI::App& app, Arguments& a) {
  app.add_option("--crf", a.crf, "Quality of both tracks, 0 (lossless) to 51 [18 for colour, 8 for depth]")
      ->type_name("N")
      ->check(quality());
  app.add_option("--depth-crf", a.depth_crf, "Quality of the depth; 0 is lossless, which not all hardware decodes")
      ->type_name("N")
      ->check(quality());
}

DepthSize depthSize(const std::string& word) {
  std::array<int, 2> size{};
  if (!readNumbers(word, 'x', std::span(size)) || std::min(size[0], size[1]) < 2 ||
      size[0] > VideoDecoder::kMostSamples / size[1]) {
    throw WordFailure({"--depth-size " + word, {ErrorCode::InvalidArgument, 0, "give WIDTHxHEIGHT, up to 4096x4096"}});
  }
  return {size[0], size[1]};
}

void addDepthFromOptions(CLI::App& app, Arguments& a) {
  app.add_option(
         "--depth-from", a.depth_from,
         "Make depth for a film without depth\nstereo: from a 3D film's two views, left and right, or above and "
         "below each other; the film's\ncolour is the left view\nCMD: a command that guesses it from one view. /bin/sh "
         "runs it; "
         "it reads raw pictures (RGB24 of\n$RELIEVO_WIDTH x $RELIEVO_HEIGHT) and writes one depth picture for each, in "
         "the same order, up to\n64 pictures later: 16 bits a sample, little endian, larger is nearer\nMODEL.onnx: a "
         "network that guesses it, such as MiDaS or Depth Anything")
      ->type_name("stereo|CMD|MODEL.onnx")
      ->excludes("--depth");
  app.add_option_function<std::string>(
         "--depth-size", [&a](const std::string& word) { a.depth_size = depthSize(word); },
         "With --depth-from: the size of the depth that CMD writes ($RELIEVO_DEPTH_WIDTH,\n$RELIEVO_DEPTH_HEIGHT) [the "
         "pictures' size], or the input size of a network that takes any size")
      ->type_name("WxH")
      ->needs("--depth-from");
  addChoice(app, "--swap-eyes", a.swap_eyes, {{"auto", SwapEyes::Auto}, {"no", SwapEyes::No}, {"yes", SwapEyes::Yes}},
            "With --depth-from stereo: whether the right eye's view comes first\nauto: as the pictures show")
      ->needs("--depth-from");
}

// Combines the options about missing depth.
Outcome<void> chooseDepth(Arguments& a) {
  if (a.depth_from.empty()) return {};
  const bool stereo = a.depth_from == "stereo";
  if (stereo && a.depth_size) {
    return failOn("--depth-size", {ErrorCode::InvalidArgument, 0,
                                   "with --depth-from stereo the depth has the views' size; leave it out"});
  }
  if (stereo && !a.source.url.empty() && !isOfFiles(a.source.url)) {
    return failOn(a.source.url,
                  {ErrorCode::Unsupported, 0, "depth from two views reads the film twice; record it to a file first"});
  }
  if (!stereo && a.swap_eyes != SwapEyes::Auto) {
    return failOn("--swap-eyes", {ErrorCode::InvalidArgument, 0, "is for --depth-from stereo; leave it out"});
  }
  if (stereo) a.output.from_views = a.swap_eyes;
  else a.output.from_one_view = OneViewWishes{a.depth_from, a.depth_size};
  return {};
}

// A painting is opened in the middle of the work, where nothing may wait for a pipe's writer or for a server.
Outcome<void> choosePaintings(Arguments& a) {
  if (a.paintings.empty()) return {};
  auto paintings = parsePaintings(a.paintings);
  if (!paintings) return failOn("--material " + a.paintings, paintings.error());
  if (const auto other = std::ranges::find_if_not(*paintings, isOfFiles, &Painting::path); other != paintings->end()) {
    return failOn(other->path,
                  {ErrorCode::Unsupported, 0,
                   "a painting is a file of this machine, no pipe, device or address; make it a file first"});
  }
  a.output.paintings = std::move(*paintings);
  return {};
}

void addEnhanceOptions(CLI::App& app, OutputOptions& output) {
  addChoice(
      app, "--enhance", output.enhancement,
      {{"none", std::nullopt},
       {"median", Enhancement::Median},
       {"dibm", Enhancement::Dibm},
       {"space-time", Enhancement::SpaceTime}},
      "Remove a sensor's noise and holes from the depth\nmedian: fills narrow holes, then takes the median of 5 x 5 "
      "samples;\ndibm (depth-image-based modelling): as median, then replaces each picture by a smoothed mesh of few "
      "points;\nspace-time: as median, then smooths over five pictures and a few samples.\nEdges stay in place");
  app.add_option(
         "--preview", output.preview,
         "Write a PNG that shows the result: colour, depth before and after as lit reliefs, and below them the\n"
         "heights along the line in them, the row of the highest relief: before orange, after blue, a grid line per mm")
      ->type_name("PNG");
}

void addCodingOptions(CLI::App& app, DepthCoding& depth) {
  addChoice(app, "--depth-codec", depth.codec,
            {{"h264", VideoCodec::H264}, {"hevc", VideoCodec::Hevc}, {"ffv1", VideoCodec::Ffv1}},
            "Codec of the depth; ffv1 is lossless, and only for .mkv");
  addChoice(app, "--depth-bits", depth.bits, {{"8", 8}, {"10", 10}, {"12", 12}, {"16", 16}},
            "Bits of the depth: h264 has 8 and 10, hevc 8, 10 and 12, ffv1 8, 10, 12 and 16");
  addChoice(app, "--depth-chroma", depth.flat_chroma, {{"none", false}, {"flat", true}},
            "none: depth is 4:0:0; flat: 4:2:0 with gray chroma, for hardware that cannot decode 4:0:0");
  addChoice(
      app, "--depth-law", depth.law,
      {{"source", std::nullopt}, {"linear", DepthLaw::Linear}, {"inverse", DepthLaw::Inverse}},
      "How the depth's steps are spaced\nsource: as in the source; linear: evenly; inverse: finest near the viewer, by "
      "disparity. Heights do not change");
}

void addSceneOption(CLI::App& app, std::string& scene) {
  addChoice(app, "--scene", scene, {{"sample", "sample"}}, "Make the built-in sample film, with exact depth, instead")
      ->excludes("--color")
      ->excludes("--depth")
      ->excludes("--depth-from")
      ->excludes("--as")
      ->excludes("--packing")
      ->excludes("--depth-code")
      ->excludes("--calibration")
      ->excludes("--material")
      ->excludes("--enhance")
      ->excludes("--preview");
}

void addKeepOptions(CLI::App& app, KeptWishes& keep) {
  app.add_flag_callback(
      "--no-audio", [&keep] { keep.sound = false; },
      "Leave the sound out; otherwise it is copied from the colour's file");
  app.add_flag_callback("--no-subtitles", [&keep] { keep.subtitles = false; }, "Leave subtitles and their fonts out");
}

// In the order of the help text.
void addOptions(CLI::App& app, Arguments& a) {
  app.footer(kFooter);
  addSourceOptions(app, a.source);
  app.add_option("-o,--output", a.output.path,
                 "Output film: .mkv, .mp4, .m4v, .mov, .ts, .m3u8 (HLS), udp://HOST:PORT or srt://HOST:PORT")
      ->required()
      ->type_name("OUT");
  addDepthOptions(app, a.source);
  addMaterialOption(app, a.source, a.paintings);
  addDepthFromOptions(app, a);
  addQualityOptions(app, a);
  addEnhanceOptions(app, a.output);
  addCodingOptions(app, a.output.depth);
  addSceneOption(app, a.scene);
  addKeepOptions(app, a.output.keep);
  app.add_flag("--force", a.output.force, "Overwrite OUT if it exists");
}

// A file system call that was ended by a signal is reported as an interruption.
int tellEnd(const Failure& failure, const std::string& output) {
  if (failure.error.code != ErrorCode::Cancelled) return tell(failure);
  return tell({output, {ErrorCode::Cancelled, 0, "interrupted; nothing was written"}});
}

int run(Arguments& a) {
  const std::atomic<bool>& stop = stopOnSignals();
  const CancelsAnswers cancels(stop);
  if (a.scene.empty() && a.source.url.empty()) {
    return tell({"--color", {ErrorCode::InvalidArgument, 0, "missing; give the film's colour, or use --scene sample"}});
  }
  for (std::string* const source : {&a.source.url, &a.source.depth_url}) *source = sourceNamed(*source);
  if (auto chosen = chooseDepth(a); !chosen) return tell(chosen.error());
  if (auto chosen = choosePaintings(a); !chosen) return tell(chosen.error());
  if (a.crf >= 0) a.output.color_crf = a.output.depth.crf = a.crf;
  if (a.depth_crf >= 0) a.output.depth.crf = a.depth_crf;
  std::vector<std::string> inputs = a.source.named_files;
  inputs.insert(inputs.end(), {a.source.url, a.source.depth_url});
  if (isRegularFile(a.depth_from)) inputs.push_back(a.depth_from);  // a network; no command, whose * is no pattern
  for (const Painting& painting : a.output.paintings) inputs.push_back(painting.path);
  if (a.source.depth_url.empty() && !a.output.from_views) inputs.push_back(depthBeside(a.source.url));
  if (auto apart = keepApart(filesWrittenBy(a.output), inputs); !apart) return tellEnd(apart.error(), a.output.path);

  Outcome<AuthorSummary> summary;
  {
    ProgressLine line;
    const auto progress = [&line](std::uint64_t done, std::optional<std::uint64_t> total) {
      line.count(done);
      line.show([&](Duration elapsed) { return progressText(done, total, elapsed); });
    };
    if (a.scene.empty()) {
      summary =
          authorFilm(a.source, {drivers::makeMediaSource, drivers::makeSoftwareDecoder}, a.output, stop, progress);
    } else {
      const int threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
      summary = authorSample({.threads = threads}, a.output, stop, progress);
    }
  }
  if (!summary) return tellEnd(summary.error(), a.output.path);
  say(toText(a.output.path, *summary));
  if (const char* const why = whyTooFar(summary->loss)) return tell({a.output.path, {ErrorCode::Io, 0, why}});
  return summary->lost.empty() ? kExitDone : tell(failureOf(summary->lost.front()));
}

// Several threads allocate and free pictures: with a heap for each thread, glibc would use a sixth more memory. Large
// blocks are mapped each by itself: a heap keeps the gaps between them, 25 MB with pictures of 1920 x 1296.
void shareOneHeap() {
#ifdef M_ARENA_MAX
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
#endif
}

int parseAndRun(int argc, char** argv) {
  CLI::App app("Packages colour and depth as one film that can be touched.", "relievo-author");
  Arguments arguments;
  addOptions(app, arguments);
  shareOneHeap();
  drivers::boundDecoderMemory();
  if (const auto parsed = parseCommandLine(app, argc, argv); !parsed) return parsed.error();
  return run(arguments);
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  return relievo::runProgram("relievo-author", [&] { return relievo::parseAndRun(argc, argv); });
}
