// SPDX-License-Identifier: Apache-2.0
// Spans of a quarter of a second, each judged by how much of it the reader rested.
#include "app/player/film/decode_pace.h"

#include <algorithm>

namespace relievo {
namespace {

constexpr Duration kSpan = std::chrono::milliseconds(250);
constexpr double kBusy = 0.05, kSpare = 0.5;                   // shares of a span at rest
constexpr Duration kLate = std::chrono::milliseconds(250);     // from which on the reader hurries
constexpr Duration kBetweenHurries = std::chrono::seconds(1);  // it takes that long to see what one has done
constexpr Duration kLongPatience = std::chrono::minutes(2);
constexpr Duration kSoon = std::chrono::seconds(30);  // late again within this time: the recovery was too early

}  // namespace

void DecodePace::look(const Seen& seen, MonotonicTime now) noexcept {
  const bool dry = seen.late > Duration(0);
  dry_rounds_ = dry ? dry_rounds_ + 1 : 0;
  dry_decodes_ = dry ? dry_decodes_ + (seen.decodes ? 1 : 0) : 0;
  dry_since_ = dry ? dry_since_.value_or(now) : std::optional<MonotonicTime>();
  dry_for_ = dry ? now - *dry_since_ : Duration(0);
  if (dry && 2 * dry_decodes_ > dry_rounds_) {
    leaveOut(now);
    if (seen.late >= kLate && (!hurried_ || now >= *hurried_ + kBetweenHurries)) {
      hurry_ = true;
      hurried_ = now;
    }
  }
  if (!since_) {
    since_ = now;
    rested_ = seen.rested;
    rounds_ = decodes_ = 0;
    filled_ = false;
  }
  ++rounds_;
  decodes_ += seen.decodes ? 1 : 0;
  filled_ = filled_ || seen.filled;
  if (now < *since_ + kSpan) return;
  judge(toSeconds(seen.rested - rested_) / toSeconds(now - *since_), 2 * decodes_ > rounds_, now);
  since_.reset();
}

void DecodePace::judge(double rest, bool decodes, MonotonicTime now) noexcept {
  if (!leaves_out_) {
    if (rest < kBusy && decodes && !filled_) leaveOut(now);
    return;
  }
  idle_ = rest > kSpare ? idle_ + (now - *since_) : Duration(0);
  if (idle_ < patience_) return;
  leaves_out_ = false;
  recovered_ = now;
}

void DecodePace::leaveOut(MonotonicTime now) noexcept {
  idle_ = Duration(0);
  if (leaves_out_) return;
  leaves_out_ = true;
  if (!recovered_) return;
  patience_ = now < *recovered_ + kSoon ? std::min(2 * patience_, kLongPatience) : kShortPatience;
}

void DecodePace::pause() noexcept {
  since_.reset();
  dry_rounds_ = dry_decodes_ = 0;
  dry_since_.reset();
  dry_for_ = Duration(0);
  hurry_ = false;
}

}  // namespace relievo
