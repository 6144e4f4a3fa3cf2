// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/bounds/mp4_track.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace relievo::ffmpeg {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Entries of a list that follow each other in time, each as long.
struct Run {
  std::uint64_t first = 0;
  double begin = 0, each = 0;  // ticks
};

struct List {
  std::uint64_t entries = 0;
  double end = 0;
  std::vector<Run> runs;

  void add(std::uint64_t count, double each, std::uint64_t most) {
    runs.push_back({.first = entries, .begin = end, .each = each});
    end += each * static_cast<double>(count);
    entries += std::min(count, 2 * most);
  }
  // Entries that begin before a time. The last run has no end.
  [[nodiscard]] std::uint64_t before(double time) const {
    const auto next = std::ranges::partition_point(runs, [time](const Run& run) { return run.begin < time; });
    if (next == runs.begin()) return 0;
    const Run& run = *std::prev(next);
    const std::uint64_t last = next == runs.end() ? entries : next->first;
    const double count = run.each > 0 ? std::ceil((time - run.begin) / run.each) : HUGE_VAL;
    return count < static_cast<double>(last - run.first) ? run.first + static_cast<std::uint64_t>(count) : last;
  }
};

constexpr std::uint64_t kCount = 4, kTable = 8;  // where a table's number of rows stands, and its first row
constexpr std::uint64_t kMostTableBytes = std::uint64_t{16} << 20;

std::uint64_t rowNumber(const Bytes& bytes, std::size_t at, std::size_t size = 4) {
  return bigEndian(std::span(bytes).subspan(at, size));
}

// The rows of a table, all that are there or as many as it says; nullopt if it is there twice, or longer than may be
// read.
std::optional<Bytes> rowsOf(const Readable& file, const Mp4Table& table, std::size_t row_bytes, std::uint64_t& budget,
                            bool all = false) {
  if (table.copies > 1) return std::nullopt;
  if (table.box.bytes() <= kTable) return Bytes();
  const std::uint64_t there = (table.box.bytes() - kTable) / row_bytes;
  const std::uint64_t bytes = (all ? there : std::min(there, numberIn(file, table.box, kCount))) * row_bytes;
  if (bytes > std::min(budget, kMostTableBytes)) return std::nullopt;
  budget -= bytes;
  Bytes rows(static_cast<std::size_t>(bytes));
  rows.resize(file(table.box.data + kTable, rows) / row_bytes * row_bytes);
  return rows;
}

// Pieces of chunks.
std::optional<List> piecesOf(const Readable& file, const Mp4Track& track, std::uint64_t most, std::uint64_t& budget) {
  constexpr std::size_t kRow = 12;
  const auto rows = rowsOf(file, {.box = track.runs.box, .copies = 1}, kRow, budget);
  if (!rows) return std::nullopt;
  List list;
  for (std::size_t at = 0; at < rows->size(); at += kRow) {
    const std::uint64_t first = rowNumber(*rows, at), samples = rowNumber(*rows, at + 4);
    const std::uint64_t next = at + kRow < rows->size() ? rowNumber(*rows, at + kRow) : track.chunks + 1;
    const std::uint64_t chunks = std::min({next > first ? next - first : 0, track.chunks, 2 * most});
    const std::uint64_t pieces = (samples + track.piece - 1) / track.piece;
    if (pieces > 0) list.add(chunks * pieces, static_cast<double>(samples) / static_cast<double>(pieces), most);
  }
  return list;
}

// Samples by their times. FFmpeg mends times that are negative, and stays with a row of no samples.
std::optional<List> samplesOf(const Readable& file, const Mp4Track& track, std::uint64_t most, std::uint64_t& budget) {
  constexpr std::size_t kRow = 8;
  constexpr std::uint64_t kNegative = std::uint64_t{1} << 31;
  const auto rows = rowsOf(file, track.times, kRow, budget);
  if (!rows || rows->empty()) return std::nullopt;
  List list;
  for (std::size_t at = 0; at < rows->size(); at += kRow) {
    const std::uint64_t count = rowNumber(*rows, at), each = rowNumber(*rows, at + 4);
    if (count == 0 || each >= kNegative) return std::nullopt;
    list.add(count, static_cast<double>(each), most);
  }
  list.entries = track.samples;
  return list;
}

// How far a picture may be shown from where it stands, in ticks.
std::optional<double> spreadOf(const Readable& file, const Mp4Track& track, std::uint64_t& budget) {
  constexpr std::size_t kRow = 8;
  const auto rows = rowsOf(file, track.shifts, kRow, budget);
  if (!rows) return std::nullopt;
  std::int32_t least = 0, most = 0;
  for (std::size_t at = 4; at < rows->size(); at += kRow) {
    const auto shift = static_cast<std::int32_t>(static_cast<std::uint32_t>(rowNumber(*rows, at)));
    least = std::min(least, shift);
    most = std::max(most, shift);
  }
  return static_cast<double>(most) - static_cast<double>(least);
}

// The numbers of the key frames, from 1 on. Empty: each is one.
struct Keys {
  std::vector<std::uint32_t> numbers;
  bool all = true;

  [[nodiscard]] std::uint64_t before(std::uint64_t entry) const {
    if (all) return entry;
    const auto next = std::ranges::upper_bound(numbers, entry + 1);
    return next == numbers.begin() ? 0 : std::max(*std::prev(next), 1U) - 1;
  }
  // Where FFmpeg ends: with the second from this entry on.
  [[nodiscard]] std::uint64_t secondFrom(std::uint64_t entry, std::uint64_t entries) const {
    if (all) return std::min(entry + 2, entries);
    const auto first = std::ranges::lower_bound(numbers, entry + 1);
    if (numbers.end() - first < 2) return entries;
    return std::min<std::uint64_t>(*std::next(first), entries);
  }
};

std::optional<Keys> keysOf(const Readable& file, const Mp4Track& track, std::uint64_t& budget) {
  const auto rows = rowsOf(file, track.keys, 4, budget);
  if (!rows) return std::nullopt;
  Keys keys{.all = track.keys.copies == 0 || track.isInChunks()};
  for (std::size_t at = 0; at < rows->size(); at += 4)
    keys.numbers.push_back(static_cast<std::uint32_t>(rowNumber(*rows, at)));
  if (!std::ranges::is_sorted(keys.numbers)) return std::nullopt;
  return keys;
}

// What the edits show of a list; nullopt where that is not to be told.
std::optional<std::uint64_t> shownOf(const Readable& file, const Mp4Track& track, const List& list,
                                     std::uint64_t per_second, std::uint64_t most, std::uint64_t& budget) {
  if (per_second == 0 || track.per_second == 0) return std::nullopt;
  const std::size_t word = numberIn(file, track.edits.box, 0, 1) == 1 ? 8 : 4, row = 2 * word + 4;
  const auto rows = rowsOf(file, track.edits, row, budget, true);
  const auto spread = spreadOf(file, track, budget);
  const auto keys = keysOf(file, track, budget);
  if (!rows || !spread || !keys) return std::nullopt;
  const double scale = static_cast<double>(track.per_second) / static_cast<double>(per_second);
  // A decoder of sound begins a second earlier.
  const double early = *spread + (track.sound ? static_cast<double>(track.per_second) : 0);
  std::uint64_t shown = 0;
  bool begun = false;
  for (std::size_t at = 0; at < rows->size() && shown <= most; at += row) {
    const std::uint64_t sign = std::uint64_t{1} << (8 * word - 1), place = rowNumber(*rows, at + word, word);
    const bool is_empty = (place & sign) != 0;
    if (is_empty && !begun) continue;
    begun = true;
    const double begin = is_empty ? 0 : static_cast<double>(place);
    const double length = static_cast<double>(rowNumber(*rows, at, word)) * scale;
    const std::uint64_t first = list.before(begin - early);
    const std::uint64_t from = keys->before(first > 0 ? first - 1 : 0);
    const std::uint64_t to =
        length > 0 ? keys->secondFrom(list.before(begin + length + 1), list.entries) : list.entries;
    shown += std::max<std::uint64_t>(to > from ? to - from : 0, 1);
  }
  return shown;
}

}  // namespace

std::uint64_t bigEndian(std::span<const std::uint8_t> bytes) noexcept {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

std::uint64_t numberIn(const Readable& file, const Mp4Box& box, std::uint64_t at, std::size_t size) {
  std::array<std::uint8_t, 8> bytes{};
  if (box.bytes() < at + size) return 0;
  const std::span number = std::span(bytes).first(size);
  return file(box.data + at, number) == size ? bigEndian(number) : 0;
}

std::optional<std::uint64_t> entriesOf(const Readable& file, const Mp4Track& track, std::uint64_t per_second,
                                       std::uint64_t most, std::uint64_t& budget) {
  constexpr std::uint64_t kFew = 2, kMany = 10'000;  // edits: the first is mostly empty; no film has as many
  List list{.entries = track.samples};
  if (track.isInChunks()) {
    auto pieces = piecesOf(file, track, most, budget);
    if (!pieces) return std::nullopt;
    list = std::move(*pieces);
  }
  const std::uint64_t all = std::min(list.entries, 2 * most);
  if (track.shows <= kFew || all > most) return all;
  if (track.shows > kMany) return all * std::min(track.shows - 1, most);
  if (!track.isInChunks()) {
    auto samples = samplesOf(file, track, most, budget);
    if (!samples) return all * std::min(track.shows - 1, most);
    list = std::move(*samples);
  }
  const auto shown = shownOf(file, track, list, per_second, most, budget);
  return shown ? std::max(all, *shown) : all * std::min(track.shows - 1, most);
}

}  // namespace relievo::ffmpeg
