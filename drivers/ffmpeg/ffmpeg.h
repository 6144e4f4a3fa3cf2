// SPDX-License-Identifier: Apache-2.0
// Media source and software decoders on FFmpeg's libraries.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "hal/media/audio_decoder.h"
#include "hal/media/media_source.h"
#include "hal/media/subtitle_decoder.h"
#include "hal/media/video_decoder.h"
#include "platform/error.h"

namespace relievo {

// Files, named pipes, numbered pictures ("frames/%03d.png"), and addresses that begin with http, https (HLS and DASH as
// well), rtsp, rtsps, rtp, udp, srt or tcp; Unsupported for any other. A source may refer only to sources of its own
// kind: a file to other files, a network source never to a local file (see address.h). RTSP uses TCP unless the address
// ends in
// "?udp".
//
// A read returns Timeout after ten seconds without data, or after three for a real-time stream (rtsp, rtp, udp, tcp);
// opening times out after 30 s. `interrupt` ends every wait within a tenth of a second; one for a name server
// leaves its thread behind. A real-time stream without a duration never ends: when its data stop it is Lost.
//
// Of several programmes (a broadcast multiplex, the bit rates of an adaptive stream) the best one is the film; the
// streams of the others are listed as Other. So are cover pictures.
//
// If the container has an index, `seek` goes to the leading video stream's key frames. Transport streams and adaptive
// streams land near the target, before or after it, so the reader must check the time and retry from earlier.
//
// Pictures and raw streams have no times: their packets have none either, and the decoder below counts in steps of
// StreamInfo::frame_period; any seek goes to the beginning.
[[nodiscard]] std::unique_ptr<MediaSource> makeFfmpegSource();

// Decodes streams of the source above, and those of any other source by codec name and extradata. Pictures whose layout
// hal/media/frame.h cannot describe (palettes, single bits, big endian, ..) are converted to the nearest one that it
// can. Only these are copied; the conversion is exact for integers of up to 16 bits. Gray in floating point (a
// renderer's EXR) is interpreted as distances in metres and converted to whole mm, with matching calibration tags. A
// picture in which the decoder concealed errors by guesses is dropped and counted as damaged, since guessed depth must
// not be felt.
[[nodiscard]] std::unique_ptr<VideoDecoder> makeFfmpegDecoder();

// From now on FFmpeg allocates no block that no picture needs, in the whole process: a text or a colour profile in a
// picture of 300 KB unpacks to 300 MB. The first encoder that is opened ends it (app/coding/video_encoder.h), also for
// inputs that are still read: what a fragment of a film that comes later lists has then no bound.
void boundFfmpegBlocks() noexcept;

// Whether it returns both views of a stream with kLayersTag 2 (Frame::right): FFmpeg 7.1 or later; else the first
// alone.
[[nodiscard]] bool ffmpegDecodesBothViews() noexcept;

// Decodes any codec, rate and channel layout, which may change within the film. Channels are mixed down by their
// layout's standard rule, scaled so that the sum does not clip.
[[nodiscard]] std::unique_ptr<AudioDecoder> makeFfmpegAudioDecoder();

// Decodes every coding of text (SubRip, WebVTT, mov_text, ..) to lines of Advanced SubStation, and pictures of words
// (PGS, DVB, DVD). Text that is no UTF-8 is taken for Latin-1.
[[nodiscard]] std::unique_ptr<SubtitleDecoder> makeFfmpegSubtitleDecoder();

// Returns the text at a path or an address (http, https), or from a pipe; Corrupt if it is longer than `most_bytes`.
// Timeout if it has not come whole within 30 s; Cancelled soon after the flag is set, even while a server's name is
// looked up.
[[nodiscard]] Result<std::string> readFfmpegText(const std::string& url, std::size_t most_bytes,
                                                 const std::atomic<bool>& cancelled);

}  // namespace relievo
