// SPDX-License-Identifier: Apache-2.0
#include "app/lab/chart/occasion.h"

#include <ctime>
#include <fstream>

#include "platform/print.h"

namespace relievo {
namespace {

constexpr const char* kQuickRun = ", quick run";

std::string processorName() {
  std::ifstream cpus("/proc/cpuinfo");
  for (std::string line; std::getline(cpus, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "processor unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm date{};
  ::gmtime_r(&now, &date);
  return print("%04d-%02d-%02d", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

}  // namespace

std::string occasionNow(bool quick) {
  return processorName() + ", " + today() + (quick ? kQuickRun : "");
}

bool isOfQuickRun(std::string_view occasion) noexcept {
  return occasion.ends_with(kQuickRun);
}

}  // namespace relievo
