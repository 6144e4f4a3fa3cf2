// SPDX-License-Identifier: Apache-2.0
// Writes facts about a film that toolchain/cross-check compares between machines: FOLDER/frames.txt with one line per
// decoded picture, and FOLDER/METHOD.csv with the trace of each method along a finger's path.
#include <cinttypes>
#include <cstdio>
#include <sstream>
#include <string>

#include "app/haptics/baseline/methods.h"
#include "app/lab/trace/trace.h"
#include "tests/support/film/ffmpeg_backends.h"

namespace relievo {
namespace {

// FNV-1a of the samples, without the padding of their rows.
std::uint64_t hashOf(const Frame& frame) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t i = 0; i < (frame.model == ColorModel::Gray ? 1U : 3U); ++i) {
    const Component& component = frame.components[i];
    const int cols = i == 0 ? frame.width : (frame.width + (1 << frame.chroma_shift_x) - 1) >> frame.chroma_shift_x;
    const int rows = i == 0 ? frame.height : (frame.height + (1 << frame.chroma_shift_y) - 1) >> frame.chroma_shift_y;
    const Plane& plane = frame.planes[component.plane];
    for (int r = 0; r < rows; ++r) {
      const std::uint8_t* sample = plane.data + r * plane.stride_bytes + component.offset_bytes;
      for (int c = 0; c < cols; ++c, sample += component.step_bytes) {
        for (int byte = 0; byte < (component.bits > 8 ? 2 : 1); ++byte) hash = (hash ^ sample[byte]) * 0x100000001b3U;
      }
    }
  }
  return hash;
}

void writeFrame(std::FILE* out, const char* name, const Frame& frame) {
  std::fprintf(out, "%s %" PRId64 " %dx%d %016" PRIx64 "\n", name,
               static_cast<std::int64_t>((frame.pts - MediaTime{}).count()), frame.width, frame.height, hashOf(frame));
}

Outcome<int> writeFacts(const std::string& film, const std::string& hip, const std::string& folder) {
  PairReader reader(kFfmpeg);
  if (const auto opened = reader.open({.url = film}); !opened) return failOn(reader.failedThing(), opened.error());
  std::FILE* const out = std::fopen((folder + "/frames.txt").c_str(), "w");
  if (out == nullptr) return failOn(folder, {ErrorCode::NotFound, 0, "cannot be written to"});
  int frames = 0;
  for (;;) {
    const auto pair = reader.next();
    if (!pair) return failOn(film, pair.error());
    if (!*pair) break;
    writeFrame(out, "color", (*pair)->color);
    if (!(*pair)->depth.empty()) writeFrame(out, "depth", (*pair)->depth);
    ++frames;
  }
  std::fclose(out);
  std::istringstream names(kMethodNames);
  for (std::string name; names >> name;) {
    TraceOptions options;
    options.film.source.url = film;
    options.hip_path = hip;
    options.out_path = folder + "/" + name + ".csv";
    options.method = name;
    if (const auto traced = runTrace(options, kFfmpeg); !traced) return std::unexpected(traced.error());
  }
  return frames;
}

}  // namespace
}  // namespace relievo

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: film_facts FILM HIP.csv FOLDER\n", stderr);
    return 2;
  }
  const auto frames = relievo::writeFacts(argv[1], argv[2], argv[3]);
  if (!frames) {
    std::fprintf(stderr, "film_facts: %s: %s\n", frames.error().thing.c_str(), frames.error().error.message);
    return 1;
  }
  std::printf("%d pictures\n", *frames);
}
