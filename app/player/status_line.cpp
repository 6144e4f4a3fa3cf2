// SPDX-License-Identifier: Apache-2.0
// Composes the line and cuts it to the terminal's width, so that it never wraps.
#include "app/player/status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "platform/log.h"
#include "platform/print.h"
#include "platform/text/plain_text.h"

namespace relievo {
namespace {

constexpr std::size_t kUsualColumns = 80;

std::size_t columnsOfTerminal() noexcept {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

std::string timesOf(const ScreenFacts& facts) {
  std::string text = clockTime(facts.position_s);
  if (facts.duration_s <= 0) return text;
  return text + " / " + clockTime(facts.duration_s) +
         print(" (%.0f %%)", 100 * std::min(1.0, facts.position_s / facts.duration_s));
}

}  // namespace

std::string statusText(const ScreenFacts& facts, const PlayReport& report, const FingerForces& forces_n,
                       const std::string& notice, std::size_t columns) {
  std::string text = std::string(name(facts.state)) + " " + timesOf(facts);
  if (!notice.empty()) text += "  " + oneLine(notice);  // it may hold words of the film
  if (facts.rate != 1) text += print("  %gx", facts.rate);
  if (facts.films > 1) text += print("  film %zu of %zu", facts.film, facts.films);
  text += print("  dropped %llu", static_cast<unsigned long long>(report.frames_dropped));
  const auto missed = [](const HapticSummary& haptic) { return static_cast<unsigned long long>(haptic.overruns); };
  if (const auto& second = report.second_finger) {
    text += print("  force %.2f N, %.2f N  missed ticks %llu, %llu", forces_n[0], forces_n[1], missed(report.haptic),
                  missed(second->haptic));
  } else if (report.haptic.ticks > 0) {
    text += print("  force %.2f N  missed ticks %llu", forces_n[0], missed(report.haptic));
  }
  // Parts that do not fit are left out, the last first; a first part that does not fit is cut.
  while (text.size() >= columns && text.rfind("  ") != std::string::npos) text.resize(text.rfind("  "));
  return text.substr(0, columns > 0 ? columns - 1 : 0);
}

StatusLine::StatusLine() : on_terminal_(::isatty(STDERR_FILENO) == 1) {
  const char* const kind = std::getenv("TERM");
  if (kind == nullptr || std::string_view(kind) == "dumb") on_terminal_ = false;
}

void StatusLine::show(const ScreenFacts& facts, const PlayReport& report, const FingerForces& forces_n,
                      const std::string& notice, MonotonicTime now) {
  due_ = now + kPeriod;
  showStatusLine(statusText(facts, report, forces_n, notice, columnsOfTerminal()));
}

void StatusLine::clear() noexcept {
  showStatusLine({});
}

}  // namespace relievo
