// SPDX-License-Identifier: Apache-2.0
#include "drivers/pictures/names.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <iterator>
#include <numeric>
#include <set>

#include "drivers/pictures/clock_unit.h"
#include "hal/media/media_names.h"

namespace relievo::pictures {
namespace {

constexpr std::size_t kLeastUnixDigits = 9, kUnixMsDigits = 13, kUnixUsDigits = 16, kUnixNsDigits = 19,
                      kDateDigits = 14;

// A run of digits, or of anything else.
struct Run {
  bool digits = false;
  std::string_view text;
};

std::vector<Run> runsOf(std::string_view text) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  std::vector<Run> runs;
  while (!text.empty()) {
    const bool digits = isDigit(text.front());
    std::size_t end = 1;
    while (end < text.size() && isDigit(text[end]) == digits) ++end;
    runs.push_back({digits, text.substr(0, end)});
    text.remove_prefix(end);
  }
  return runs;
}

std::optional<std::int64_t> scaled(std::string_view digits, std::int64_t ns) noexcept {
  const auto value = integerIn(digits);
  constexpr std::int64_t kMost = kMostSeconds * 1'000'000'000;
  return value && *value <= kMost / ns ? std::optional(*value * ns) : std::nullopt;
}

// Greater numbers would be times beyond what 64 bits of ns hold.
std::optional<std::int64_t> countIn(std::string_view digits) noexcept {
  const auto value = integerIn(digits);
  return value && *value <= kMostSeconds ? value : std::nullopt;
}

std::optional<std::int64_t> secondsIn(const std::vector<Run>& runs) noexcept {
  for (std::size_t i = 0; i + 2 < runs.size(); ++i) {
    if (!runs[i].digits || runs[i + 1].text != "." || !runs[i + 2].digits) continue;
    if (runs.size() != 3 && runs[i].text.size() < kLeastUnixDigits) continue;
    const std::string_view text{runs[i].text.data(), runs[i].text.size() + 1 + runs[i + 2].text.size()};
    if (runs[i].text.size() != kUnixMsDigits) return nanosecondsIn(text);
    const auto milliseconds = nanosecondsIn(text.substr(kUnixMsDigits - 9));  // the leading digits would not fit
    const auto leading = integerIn(text.substr(0, kUnixMsDigits - 9));
    return milliseconds && leading ? std::optional(*leading * 1'000'000'000'000'000 + *milliseconds / 1000)
                                   : std::nullopt;
  }
  return std::nullopt;
}

// Windows counts 100 ns from 1601, .NET from the year 1. Nullopt for a time before 1970 or after 2200.
std::optional<std::int64_t> ticksIn(std::string_view digits) noexcept {
  constexpr std::int64_t kOf1601 = 116'444'736'000'000'000, kOfYear1 = 621'355'968'000'000'000;
  constexpr std::int64_t kMost = 72'000'000'000'000'000;
  const auto ticks = integerIn(digits);
  if (!ticks) return std::nullopt;
  const std::int64_t since = *ticks - (*ticks < kOfYear1 ? kOf1601 : kOfYear1);
  return since >= 0 && since < kMost ? std::optional(100 * since) : std::nullopt;
}

// 20 digits are ns with a zero before them (InteriorNet).
std::optional<std::int64_t> unixTimeIn(std::string_view digits) noexcept {
  switch (digits.size()) {
    case kUnixNsDigits:
    case kUnixNsDigits + 1:
      return scaled(digits, 1);
    case kUnixUsDigits:
      return scaled(digits, 1000);
    case kUnixMsDigits:
      return scaled(digits, 1'000'000);
    default:
      return std::nullopt;
  }
}

std::optional<std::int64_t> timeIn(std::string_view stem) {
  const std::vector<Run> runs = runsOf(stem);
  if (const auto seconds = secondsIn(runs)) return seconds;
  // ARKitScenes: "41069021_305.377", the recording and the time.
  constexpr std::size_t kMilliseconds = 3;
  if (runs.size() == 5 && runs[0].digits && runs[1].text == "_" && runs[2].digits && runs[3].text == "." &&
      runs[4].digits && runs[4].text.size() >= kMilliseconds) {
    return nanosecondsIn({runs[2].text.data(), runs[2].text.size() + 1 + runs[4].text.size()});
  }
  if (runs.size() == 1 && runs[0].digits) return stem.size() == 18 ? ticksIn(stem) : unixTimeIn(stem);
  constexpr std::size_t kRedwoodDigits = 12;
  const bool redwood = runs.size() == 3 && runs[0].digits && runs[1].text == "-" && runs[2].digits;
  return redwood && runs[2].text.size() == kRedwoodDigits ? scaled(runs[2].text, 1000) : std::nullopt;
}

bool allDiffer(const std::vector<std::int64_t>& values) {
  return std::set<std::int64_t>(values.begin(), values.end()).size() == values.size();
}

template <class Read>
std::optional<std::vector<std::int64_t>> readAll(const std::vector<std::string>& names, const Read& read) {
  std::vector<std::int64_t> values;
  for (const std::string& name : names) {
    const auto value = read(stemOf(name));
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return allDiffer(values) ? std::optional(std::move(values)) : std::nullopt;
}

// The place of the only run that differs; nullopt if none or several do, or if it is no number.
std::optional<std::size_t> countingRun(const std::vector<std::string>& names) {
  const std::vector<Run> first = runsOf(stemOf(names.front()));
  std::optional<std::size_t> found;
  for (const std::string& name : names) {
    const std::vector<Run> runs = runsOf(stemOf(name));
    if (runs.size() != first.size()) return std::nullopt;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs[i].text == first[i].text) continue;
      if (!runs[i].digits || !first[i].digits || (found && *found != i)) return std::nullopt;
      found = i;
    }
  }
  return found;
}

// A single name counts by its last run of digits.
std::optional<std::vector<std::int64_t>> numbersIn(const std::vector<std::string>& names,
                                                   std::optional<std::int64_t> (*read)(std::string_view) noexcept) {
  auto place = countingRun(names);
  if (names.size() == 1) {
    const std::vector<Run> runs = runsOf(stemOf(names.front()));
    for (std::size_t i = 0; i < runs.size(); ++i) {
      if (runs[i].digits) place = i;
    }
  }
  if (!place) return std::nullopt;
  return readAll(names, [&](std::string_view stem) { return read(runsOf(stem)[*place].text); });
}

std::optional<std::vector<std::int64_t>> clockIn(const std::vector<std::string>& names) {
  auto values = numbersIn(names, integerIn);
  const std::int64_t ns = values && !areIds(*values) ? clockUnit(*values) : 0;
  if (ns == 0) return std::nullopt;
  for (std::int64_t& value : *values) value *= ns;
  return values;
}

// That of "IMG_20230101_101010" or "20230101101010", or the first of the day.
std::optional<std::chrono::sys_seconds> momentIn(std::string_view stem) {
  using namespace std::chrono;
  const std::vector<Run> runs = runsOf(stem);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string digits(runs[i].text);
    if (!runs[i].digits || !(digits.starts_with("20") || digits.starts_with("19"))) continue;
    const bool timed = i + 2 < runs.size() && runs[i + 2].text.size() >= 6;
    if (digits.size() == 8) digits += timed ? runs[i + 2].text.substr(0, 6) : "000000";
    if (digits.size() != kDateDigits) continue;
    const auto part = [&](std::size_t from, std::size_t count) {
      return static_cast<int>(*integerIn(std::string_view(digits).substr(from, count)));
    };
    const year_month_day date{year(part(0, 4)), month(static_cast<unsigned>(part(4, 2))),
                              day(static_cast<unsigned>(part(6, 2)))};
    if (date.ok()) return sys_days(date) + hours(part(8, 2)) + minutes(part(10, 2)) + seconds(part(12, 2));
  }
  return std::nullopt;
}

// Of "20230501_123015_100000" and "2023-05-01_12-30-15-100": the date, the time, and us or ms.
std::optional<std::int64_t> dateIn(std::string_view stem) {
  constexpr std::size_t kMsDigits = 3, kUsDigits = 6;
  const std::vector<Run> runs = runsOf(stem);
  if (runs.empty() || !runs.back().digits) return std::nullopt;
  const std::string_view fraction = runs.back().text;
  const bool ms = fraction.size() == kMsDigits;
  if (!ms && fraction.size() != kUsDigits) return std::nullopt;
  std::string digits;
  for (const Run& run : runs) digits += run.digits ? run.text : "";
  digits.resize(digits.size() - fraction.size());
  const auto moment = digits.size() == kDateDigits ? momentIn(digits) : std::nullopt;
  if (!moment) return std::nullopt;
  return std::chrono::nanoseconds(moment->time_since_epoch()).count() + *integerIn(fraction) * (ms ? 1'000'000 : 1000);
}

// Whether most of the times are nearer to each other than photos are.
bool areOfFrames(std::vector<std::int64_t> times) {
  constexpr std::int64_t kFar = 3'000'000'000;
  std::ranges::sort(times);
  std::size_t near = 0;
  for (std::size_t i = 1; i < times.size(); ++i) near += times[i] - times[i - 1] < kFar ? 1 : 0;
  return 2 * near > times.size() - 1;
}

// Whether the names tell moments of several days, or dates with the time in one number, most of them some seconds
// apart. Frames are nearer.
bool tellDays(const std::vector<std::string>& names) {
  constexpr std::chrono::seconds kFar{3};
  std::set<std::chrono::sys_seconds> moments;
  for (const std::string& name : names) {
    const auto moment = momentIn(stemOf(name));
    if (!moment) return false;
    moments.insert(*moment);
  }
  const auto dayOf = [](auto moment) { return std::chrono::floor<std::chrono::days>(moment); };
  const auto isDate = [](const Run& run) { return run.digits && run.text.size() == kDateDigits; };
  const bool dates = std::ranges::any_of(runsOf(stemOf(names.front())), isDate);
  if (!dates && dayOf(*moments.begin()) == dayOf(*moments.rbegin())) return false;
  std::size_t far = 0;
  for (auto each = std::next(moments.begin()); each != moments.end(); ++each) {
    if (*each - *std::prev(each) >= kFar) ++far;
  }
  return 2 * far >= moments.size();
}

std::vector<std::int64_t> ranksOf(const std::vector<std::string>& names) {
  std::vector<std::size_t> order(names.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return naturalLess(names[a], names[b]); });
  std::vector<std::int64_t> ranks(names.size());
  for (std::size_t i = 0; i < order.size(); ++i) ranks[order[i]] = static_cast<std::int64_t>(i);
  return ranks;
}

}  // namespace

std::optional<std::int64_t> integerIn(std::string_view text) noexcept {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

std::optional<std::int64_t> nanosecondsIn(std::string_view seconds) noexcept {
  constexpr std::size_t kNsDigits = 9;
  const std::size_t dot = std::min(seconds.find('.'), seconds.size());
  const auto whole = scaled(seconds.substr(0, dot), 1'000'000'000);
  if (!whole || *whole < 0) return std::nullopt;
  std::string_view part = dot < seconds.size() ? seconds.substr(dot + 1) : "0";
  if (part.empty() || part.find_first_not_of("0123456789") != part.npos) return std::nullopt;
  part = part.substr(0, kNsDigits);
  std::int64_t ns = *integerIn(part);
  for (std::size_t i = part.size(); i < kNsDigits; ++i) ns *= 10;
  return *whole + ns;
}

NameValues valuesOf(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  if (auto times = readAll(names, timeIn)) return {NameKind::Seconds, std::move(*times)};
  if (auto times = readAll(names, dateIn); times && areOfFrames(*times)) {
    return {NameKind::Seconds, std::move(*times)};
  }
  if (auto times = clockIn(names)) return {NameKind::Seconds, std::move(*times)};
  if (auto numbers = numbersIn(names, countIn)) return {NameKind::Numbers, std::move(*numbers)};
  return {NameKind::Ranks, ranksOf(names)};
}

bool areUnrelated(const std::vector<std::string>& names) {
  const auto wordsOf = [](const std::string& name) {
    std::string words(stemOf(name));
    std::erase_if(words, [](char c) { return c >= '0' && c <= '9'; });
    return words;
  };
  const std::string words = wordsOf(names.front());
  if (std::ranges::any_of(names, [&](const auto& name) { return wordsOf(name) != words; })) return true;
  if (tellDays(names)) return true;
  const auto numbers = numbersIn(names, integerIn);
  return numbers && areIds(*numbers);
}

}  // namespace relievo::pictures
