// SPDX-License-Identifier: Apache-2.0
// Formats the summary and checks the output's name.
#include "app/author/package/output.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include "app/author/package/film_kind.h"
#include "app/scene/display_volume.h"
#include "platform/atomic_file.h"
#include "platform/files/answered_place.h"
#include "platform/print.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr Duration kLate = std::chrono::milliseconds(500);

std::string sizeText(std::uint64_t bytes) {
  if (bytes < 1000) return print("%llu bytes", static_cast<unsigned long long>(bytes));
  if (bytes < 1'000'000) return print("%.1f kB", static_cast<double>(bytes) / 1e3);
  return print("%.2f MB", static_cast<double>(bytes) / 1e6);
}

// From the first picture's time to the end of the last one's.
double seconds(const TrackTotals& track, Duration frame_period) {
  return toSeconds(track.last - track.first + frame_period);
}

std::string codingText(const FilmFormat& f) {
  const std::string text = std::string(name(f.depth.codec)) + (f.depth.flat_chroma ? " 4:2:0" : " 4:0:0");
  return f.depth.bits == 8 ? text : text + print(", %d bits", f.depth.bits);
}

std::string trackLine(const char* name, int width, int height, const std::string& coding, int crf,
                      const TrackTotals& track, Duration frame_period) {
  const double length = seconds(track, frame_period);
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  const std::string rate =
      length > 0 ? print("%.0f kbit/s", static_cast<double>(track.bytes) * 8e-3 / length) : std::string("still");
  const std::string quality = crf > 0 ? print("crf %d", crf) : std::string("lossless");
  return print("  %-8s %-10s %-21s %-8s %6llu frames  %10s  %12s\n", name, size.c_str(), coding.c_str(),
               quality.c_str(), static_cast<unsigned long long>(track.frames), sizeText(track.bytes).c_str(),
               rate.c_str());
}

std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : ", ") + word;
  return line;
}

std::string codesLine(const DepthCoder::Counts& codes) {
  int lowest = -1, highest = -1, used = 0;
  for (int i = 0; i < 1 << codes.bits; ++i) {
    if (codes.of_code[static_cast<std::size_t>(i)] == 0) continue;
    if (lowest < 0) lowest = i;
    highest = i;
    ++used;
  }
  std::string line =
      used == 0 ? std::string("  depth codes: none, the whole depth is holes")
                : print("  depth codes: %d bits, %d .. %d, %d of them used", codes.bits, lowest, highest, used);
  if (codes.holes > 0) {
    line += print("; holes %.1f %%", 100.0 * static_cast<double>(codes.holes) / static_cast<double>(codes.samples));
  }
  return line + "\n";
}

// Converts levels of 255 to the height under a finger.
double mm(double levels) {
  return levels * DisplayVolume::kDefaultDepthMm / 255;
}
double newtons(double levels) {
  return newtonsOf(mm(levels));
}

std::string enhancementLines(Enhancement how, const EnhancementSummary& e) {
  const auto percent = [&e](std::uint64_t count) {
    return e.samples > 0 ? 100.0 * static_cast<double>(count) / static_cast<double>(e.samples) : 0;
  };
  std::string lines =
      print("  enhanced (%s): %.1f %% holes and %.2f %% outliers; %.1f %% filled, %.1f %% left as holes\n", name(how),
            percent(e.holes), percent(e.outliers), percent(e.filled), percent(e.holes + e.outliers - e.filled));
  lines += print("    noise between samples: %.2f levels of 255 before, %.2f after\n", e.noise_before, e.noise_after);
  lines += print("    estimated touch error away from edges: %.3f mm (%.3f N) before, %.3f mm (%.3f N) after\n",
                 mm(e.error_before), newtons(e.error_before), mm(e.error_after), newtons(e.error_after));
  constexpr double kShown = 0.0005;  // mm: half of the last digit
  if (mm(e.error_after) > mm(e.error_before) + kShown) {
    lines += "    by this estimate the depth gets worse: leave out --enhance, unless narrow holes must be filled\n";
  }
  if (e.points > 0) {
    lines += print("    mesh: %.0f points per picture, at most %zu; every sample within %.1f levels of it\n", e.points,
                   e.most_points, e.bound);
  }
  return lines;
}

// --force deletes such a folder, so it must contain only files of an earlier run.
bool ownSegmentsAlone(const std::string& folder) {
  if (!isThere(folder)) return true;
  const auto own = [](const FolderEntry& entry) {
    return entry.kind == FolderEntry::Kind::File && (entry.name == "init.mp4" || entry.name.ends_with(".m4s"));
  };
  return isFolder(folder) && std::ranges::all_of(entriesOf(folder), own);
}

// Creates nothing that stays: a place that cannot be written to is told before the work.
Result<void> checkPlace(const std::string& path, bool force) {
  const auto status = statusOf(path);
  if (!status && status.error().code != ErrorCode::NotFound) return std::unexpected(status.error());
  if (status && !S_ISREG(status->st_mode)) return fail(ErrorCode::Io, "exists and is not a file; choose another name");
  if (status && !force) {
    return fail(ErrorCode::Io, "already exists; choose another name, or overwrite it with --force");
  }
  const auto tried = AtomicFile::create(path);
  if (!tried) return std::unexpected(tried.error());
  return {};
}

// FFmpeg would send to another port than the one that was meant: that of the number modulo 65536.
bool namesAPort(const std::string& address) {
  const auto place = std::string_view(address).substr(address.find("://") + 3);
  const auto host_and_port = place.substr(0, place.find_first_of("/?"));
  const auto number = host_and_port.substr(host_and_port.rfind(':') + 1);  // all of it without a colon
  int port = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), port);
  return error == std::errc{} && end == number.data() + number.size() && port > 0 && port < 65536;
}

}  // namespace

Result<void> checkOutput(const OutputOptions& output) {
  const auto kind = filmKindOf(output.path);
  if (!kind) return fail(ErrorCode::InvalidArgument, kUnknownKind);
  if (!holds(*kind, output.depth.codec)) return fail(ErrorCode::InvalidArgument, kNotHeld);
  if (!codes(output.depth.codec, output.depth.bits)) {
    return fail(ErrorCode::InvalidArgument,
                "the codec does not support this bit depth; h264 has 8 and 10, hevc also 12, ffv1 also 12 and 16");
  }
  if (kind == FilmKind::Live) {
    if (namesAPort(output.path)) return {};
    return fail(ErrorCode::InvalidArgument, "the port is not a number from 1 to 65535; write udp://HOST:PORT");
  }
  if (kind == FilmKind::Hls && !output.force && isThere(segmentFolderOf(output.path))) {
    return fail(ErrorCode::Io,
                "its folder of segments already exists; choose another name, or overwrite it with --force");
  }
  if (kind == FilmKind::Hls && !ownSegmentsAlone(segmentFolderOf(output.path))) {
    return fail(ErrorCode::Io, "its folder of segments contains other files; choose another name");
  }
  return checkPlace(output.path, output.force);
}

std::vector<std::string> filesWrittenBy(const OutputOptions& output) {
  std::vector<std::string> files{output.path, output.preview};
  if (filmKindOf(output.path) != FilmKind::Hls) return files;
  const std::string folder = segmentFolderOf(output.path);
  for (const FolderEntry& entry : entriesOf(folder)) files.push_back(folder + "/" + entry.name);
  return files;
}

Result<void> checkPreview(const OutputOptions& output) {
  if (output.preview.empty()) return {};
  if (!output.preview.ends_with(".png")) return fail(ErrorCode::InvalidArgument, "the name must end in .png");
  return checkPlace(output.preview, output.force);
}

std::string progressText(std::uint64_t done, std::optional<std::uint64_t> total, Duration elapsed) {
  const double spent = toSeconds(elapsed);
  const double rate = spent > 0 ? static_cast<double>(done) / spent : 0;
  std::string text = total && *total >= done ? print("%llu/%llu frames", static_cast<unsigned long long>(done),
                                                     static_cast<unsigned long long>(*total))
                                             : print("%llu frames", static_cast<unsigned long long>(done));
  if (rate > 0) text += print(", %.1f frames/s", rate);
  if (rate > 0 && total && *total >= done) {
    const auto left = static_cast<long>(std::ceil(static_cast<double>(*total - done) / rate));
    text += print(", %ld:%02ld left", left / 60, left % 60);
  }
  return text;
}

std::string toText(const std::string& path, const AuthorSummary& summary) {
  const FilmFormat& f = summary.format;
  const FilmTotals& totals = summary.totals;
  std::string text = oneLine(path) + print(": %.2f s, ", seconds(totals.color, summary.frame_period)) +
                     sizeText(totals.file_bytes) + "\n";
  const int depth_crf = f.depth.codec == VideoCodec::Ffv1 ? 0 : f.depth.crf;
  text +=
      trackLine("color", f.color_width, f.color_height, "H.264 4:2:0", f.color_crf, totals.color, summary.frame_period);
  text +=
      trackLine("depth", f.depth_width, f.depth_height, codingText(f), depth_crf, totals.depth, summary.frame_period);
  if (f.material_width > 0) {
    text += trackLine("material", f.material_width, f.material_height, "H.264 4:2:0", f.material_crf, totals.material,
                      summary.frame_period);
  }
  if (summary.enhancement) text += enhancementLines(*summary.enhancement, summary.enhanced);
  if (!summary.read_as.empty()) text += "  read as: " + summary.read_as + "\n";
  for (const std::string& line : summary.read_because) text += "    " + line + "\n";
  text += codesLine(summary.codes);
  text += toText(summary.loss);
  if (!summary.kept.empty()) text += "  kept: " + joined(summary.kept) + "\n";
  const auto tag = [&f](const char* key) {
    const auto found = f.depth_tags.find(key);
    return found == f.depth_tags.end() ? std::string("?") : found->second;
  };
  text += "  depth means: " + tag("DEPTH_LAW") + " law, near is high, full range";
  if (tag("DEPTH_LAW") == "inverse") text += ", near " + tag("DEPTH_NEAR") + " mm, far " + tag("DEPTH_FAR") + " mm";
  text += "\n";
  if (f.depth_tags.contains(kMaterialTag)) text += "  material: " + tag(kMaterialTag) + "\n";
  if (f.material_width > 0) text += "  material of each place: up to " + f.material_scale + "\n";
  if (totals.latest > kLate) {
    text += print("  note: sent up to %.1f s late: this machine is too slow for the film; use a smaller picture\n",
                  toSeconds(totals.latest));
  }
  for (const std::string& note : summary.notes) text += "  note: " + note + "\n";
  return text;
}

}  // namespace relievo
