// SPDX-License-Identifier: Apache-2.0
#include "drivers/ffmpeg/opening/memory.h"

#include <unistd.h>

#include <fstream>
#include <utility>

#include "drivers/ffmpeg/library.h"

namespace relievo::ffmpeg {
namespace {

// Of the process, in physical memory (proc(5), statm); 0 if that cannot be told.
std::size_t residentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0, resident = 0;
  return statm >> pages >> resident ? resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

}  // namespace

OpeningMemory::OpeningMemory() : before_(residentBytes()) {}

bool OpeningMemory::exceeded() {
  const std::scoped_lock lock(mutex_);
  if (exceeded_ || ended_ || before_ == 0 || residentBytes() <= before_ + kMostOpeningBytes) return exceeded_;
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
