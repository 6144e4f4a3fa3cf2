// SPDX-License-Identifier: Apache-2.0
// What two fingers are called: by their order on the command line, and by the colours of their marks on the screen.
#pragma once

namespace relievo {

// The colours are those of kFingerPaints.
inline constexpr const char* kFirstFinger = "first finger (amber)";
inline constexpr const char* kSecondFinger = "second finger (blue)";

}  // namespace relievo
