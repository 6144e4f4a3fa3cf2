// SPDX-License-Identifier: Apache-2.0
// Fewer and larger pages under a big picture: a finger that crosses 4K depth reads rows that lie pages apart, and
// spends most of its time on address translation.
#pragma once

#include <cstddef>

namespace relievo {

// Smaller blocks stay as they are: from here on, at least one page of 2 MiB lies whole in a block, wherever it begins.
inline constexpr std::size_t kHugePagesFrom = std::size_t{4} << 20;

// Asks the system to put huge pages under [begin, begin + bytes), which is any memory of this process. Call it before
// the block is first written: what is there already stays on small pages. A hint: it changes no contents, takes no
// memory that was not asked for, needs no undoing before the block is freed, and where the system has no huge pages
// nothing happens. Thread-safe; a system call, so not real-time safe.
void askForHugePages(const void* begin, std::size_t bytes) noexcept;

}  // namespace relievo
