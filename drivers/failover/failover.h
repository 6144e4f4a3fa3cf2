// SPDX-License-Identifier: Apache-2.0
// A video decoder made of several: where one dies, another goes on at the same picture.
#pragma once

#include <memory>
#include <vector>

#include "hal/video_decoder.h"

namespace relievo {

// The first that takes the stream decodes it, best first; `description` says why not a better one. It keeps the packets
// since the last key frame that pictures may still be needed of. When a decoder fails, they are fed again and the
// pictures that have been handed out already are dropped: nothing is missing, nothing comes twice. What hangs (Timeout)
// or stumbles (Io) is begun anew, once in a film; whoever fails otherwise, or again, is replaced by the next for good.
// The last one's failure is the caller's. Each is told by `takeRestart`. A `receive` that meets a failure takes as long
// as what is decoded again.
//
// At least one. Frames outlive the decoder that they are of, as with any decoder.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeFailoverDecoder(std::vector<std::unique_ptr<VideoDecoder>> decoders);

}  // namespace relievo
