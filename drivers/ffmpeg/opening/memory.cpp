// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

#include "drivers/ffmpeg/library.h"

namespace relievo::ffmpeg {
namespace {

std::size_t bytesOf(std::size_t pages) noexcept {
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

// Of the process alone, in physical memory (proc(5), statm); 0 if that cannot be told.
std::size_t ownBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0, resident = 0, shared = 0;
  return statm >> pages >> resident >> shared ? bytesOf(resident - std::min(shared, resident)) : 0;
}

// What a thread of the process has taken (proc(5), stat: minflt); 0 if that cannot be told.
std::size_t takenBytes(int thread) {
  std::ifstream stat("/proc/self/task/" + std::to_string(thread) + "/stat");
  std::string word;
  stat.ignore(std::numeric_limits<std::streamsize>::max(), ')');  // the name
  for (int i = 0; i < 7; ++i) stat >> word;
  std::size_t faults = 0;
  return stat >> faults ? bytesOf(faults) : 0;
}

}  // namespace

OpeningMemory::OpeningMemory() : before_(ownBytes()) {}

void OpeningMemory::begin() {
  const std::scoped_lock lock(mutex_);
  thread_ = ::gettid();
  taken_before_ = takenBytes(thread_);
}

bool OpeningMemory::exceeded() {
  const std::scoped_lock lock(mutex_);
  if (exceeded_ || ended_ || before_ == 0 || ownBytes() <= before_ + kMostOpeningBytes) return exceeded_;
  if (thread_ == 0 || takenBytes(thread_) < taken_before_ + kMostOpeningBytes / 2) return false;
  exceeded_ = true;
  refuseLargeBlocks(true);
  return true;
}

bool OpeningMemory::end() {
  const std::scoped_lock lock(mutex_);
  if (!std::exchange(ended_, true) && exceeded_) refuseLargeBlocks(false);
  return exceeded_;
}

}  // namespace relievo::ffmpeg
