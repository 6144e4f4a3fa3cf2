// SPDX-License-Identifier: Apache-2.0
// The layouts: sensorData.h of ScanNet's SensReader; RawLogReader of ElasticFusion. All numbers are little endian.
#include "drivers/scan/scan_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "drivers/scan/scan_picture.h"
#include "platform/files/byte_reader.h"

namespace relievo::scan {
namespace {

constexpr std::uint64_t kMostFrames = 1'000'000;
constexpr const char* kNoScan = "is no scan, or damaged at its beginning; check the file";
constexpr const char* kNoFrame = "the scan holds no whole frame; record it again";

template <std::size_t N>
std::optional<std::array<std::uint8_t, N>> bytesAt(const AnsweredFile& file, std::uint64_t at) {
  std::array<std::uint8_t, N> bytes{};
  return file.read(at, bytes).value_or(0) == N ? std::optional(bytes) : std::nullopt;
}

// Reads the frames from `at` on; `next` reads one frame's head, which its pictures follow at once.
template <class ReadHead>
Result<void> listFrames(Scan& scan, std::uint64_t end, std::uint64_t count, std::uint64_t at,
                        const std::atomic<bool>& cancelled, const ReadHead& read_head) {
  for (std::uint64_t i = 0; i < std::min(count, kMostFrames); ++i) {
    if (cancelled) return fail(ErrorCode::Cancelled, "interrupted while opening the scan");
    const auto frame = read_head(at);
    const std::uint64_t behind =
        frame ? std::max(frame->color.begin + frame->color.bytes, frame->depth.begin + frame->depth.bytes) : 0;
    if (!frame || behind > end || frame->depth.bytes == 0) {
      scan.cut_off = true;
      break;
    }
    scan.frames.push_back(*frame);
    at = behind;
  }
  if (scan.frames.empty()) return fail(ErrorCode::Corrupt, kNoFrame);
  return {};
}

bool isSoundSize(std::uint64_t cols, std::uint64_t rows, std::uint64_t sample_bytes) noexcept {
  constexpr std::uint64_t kLongest = 16384;
  return cols > 0 && rows > 0 && cols <= kLongest && rows <= kLongest && cols * rows * sample_bytes <= kMostPicture;
}

}  // namespace

Result<Scan> readSens(const AnsweredFile& file, const std::atomic<bool>& cancelled) {
  constexpr std::uint32_t kVersion = 4;
  constexpr std::uint64_t kLongestName = 4096, kMatrices = std::uint64_t{4} * 64;
  constexpr std::size_t kPose = 64;
  const auto end = file.bytes();
  if (!end) return std::unexpected(end.error());
  const auto start = bytesAt<12>(file, 0);
  ByteReader first = ByteReader(start ? std::span<const std::uint8_t>(*start) : std::span<const std::uint8_t>());
  const auto version = first.value<std::uint32_t>();
  const auto name = first.value<std::uint64_t>();
  if (!start || version != kVersion || name > kLongestName) return fail(ErrorCode::Corrupt, kNoScan);
  const std::uint64_t head_at = 12 + name + kMatrices;
  const auto head = bytesAt<36>(file, head_at);
  if (!head) return fail(ErrorCode::Corrupt, kNoScan);
  ByteReader fields(*head);
  const auto color = fields.value<std::int32_t>(), depth = fields.value<std::int32_t>();
  Scan scan;
  scan.color_cols = fields.value<std::uint32_t>();
  scan.color_rows = fields.value<std::uint32_t>();
  scan.depth_cols = fields.value<std::uint32_t>();
  scan.depth_rows = fields.value<std::uint32_t>();
  scan.codes_per_metre = static_cast<double>(fields.value<float>());
  const auto count = fields.value<std::uint64_t>();
  if (depth != 0 && depth != 1) {
    return fail(ErrorCode::Unsupported,
                "the scan's depth is in a coding that is not read; export it by ScanNet's SensReader");
  }
  const bool sound =
      isSoundSize(scan.depth_cols, scan.depth_rows, 2) && isSoundSize(scan.color_cols, scan.color_rows, 3);
  const bool scaled = std::isfinite(scan.codes_per_metre) && scan.codes_per_metre >= 1 && scan.codes_per_metre <= 1e6;
  if (!sound || !scaled || color < 0 || color > 2) return fail(ErrorCode::Corrupt, kNoScan);
  scan.color = color == 0 ? Coding::Raw : color == 1 ? Coding::Png : Coding::Jpeg;
  scan.depth = depth == 0 ? Coding::Raw : Coding::Deflated;
  const auto read_head = [&](std::uint64_t at) -> std::optional<ScanFrame> {
    const auto bytes = bytesAt<kPose + 32>(file, at);
    if (!bytes) return std::nullopt;
    ByteReader frame = ByteReader(std::span(*bytes).subspan(kPose));
    const auto time = frame.value<std::uint64_t>();
    static_cast<void>(frame.value<std::uint64_t>());  // the depth's own time
    const auto color_bytes = frame.value<std::uint64_t>(), depth_bytes = frame.value<std::uint64_t>();
    if (color_bytes > kMostPicture || depth_bytes > kMostPicture) return std::nullopt;
    const std::uint64_t color_at = at + bytes->size();
    return ScanFrame{time,
                     {color_at, static_cast<std::uint32_t>(color_bytes)},
                     {color_at + color_bytes, static_cast<std::uint32_t>(depth_bytes)}};
  };
  auto listed = listFrames(scan, *end, count, head_at + head->size(), cancelled, read_head);
  return listed ? Result<Scan>(std::move(scan)) : std::unexpected(listed.error());
}

Result<Scan> readKlg(const AnsweredFile& file, const std::atomic<bool>& cancelled) {
  constexpr std::uint32_t kCols = 640, kRows = 480;  // of the loggers, unless the JPEG says another size
  const auto end = file.bytes();
  if (!end) return std::unexpected(end.error());
  const auto start = bytesAt<4>(file, 0);
  if (!start) return fail(ErrorCode::Corrupt, kNoScan);
  const auto count = ByteReader(*start).value<std::int32_t>();
  if (count <= 0) return fail(ErrorCode::Corrupt, kNoScan);
  const auto read_head = [&](std::uint64_t at) -> std::optional<ScanFrame> {
    const auto bytes = bytesAt<16>(file, at);
    if (!bytes) return std::nullopt;
    ByteReader frame(*bytes);
    const auto time = frame.value<std::uint64_t>();
    const auto depth_bytes = frame.value<std::uint32_t>(), color_bytes = frame.value<std::uint32_t>();
    if (color_bytes > kMostPicture || depth_bytes > kMostPicture) return std::nullopt;
    const std::uint64_t depth_at = at + bytes->size();
    return ScanFrame{time, {depth_at + depth_bytes, color_bytes}, {depth_at, depth_bytes}};
  };
  Scan scan;
  if (auto listed = listFrames(scan, *end, static_cast<std::uint64_t>(count), 4, cancelled, read_head); !listed)
    return std::unexpected(listed.error());
  const ScanFrame& first = scan.frames.front();
  const auto picture = readPlace(file, first.color);
  const auto size = picture ? jpegSize(*picture) : std::nullopt;
  scan.depth_cols = scan.color_cols = size ? size->cols : kCols;
  scan.depth_rows = scan.color_rows = size ? size->rows : kRows;
  if (!isSoundSize(scan.depth_cols, scan.depth_rows, 3)) return fail(ErrorCode::Corrupt, kNoScan);
  if (!size) scan.color = Coding::Raw;
  if (first.depth.bytes == 2 * scan.depth_cols * scan.depth_rows) scan.depth = Coding::Raw;
  return scan;
}

}  // namespace relievo::scan
