// SPDX-License-Identifier: Apache-2.0
// Runs calls that nothing can interrupt on threads of their own, which are left behind if they do not end in time.
#pragma once

#include <functional>

#include "platform/error.h"

namespace relievo::ffmpeg {

// FFmpeg looks at a file with a million tags, or for the name of a server, for minutes. Runs `work` and waits until it
// ends, or until a moment after `gives_up` has become true and stayed so: then it returns false, and the thread ends by
// itself. Of such threads there are at most eight. Exhausted, and `work` does not run, beyond that and where no thread
// can be started: on the caller's own nothing could end it. `work` must own all that it uses; `gives_up` is called on
// the caller's thread.
[[nodiscard]] Result<bool> runApart(std::function<void()> work, const std::function<bool()>& gives_up);

}  // namespace relievo::ffmpeg
