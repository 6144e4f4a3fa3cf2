// SPDX-License-Identifier: Apache-2.0
// Which sound and subtitles each kind of film can hold.
#pragma once

extern "C" {
#include <libavformat/avformat.h>
}

#include "app/author/package/film_kind.h"

namespace relievo {

[[nodiscard]] bool isTransport(FilmKind kind) noexcept;
[[nodiscard]] bool isMp4(FilmKind kind) noexcept;
[[nodiscard]] bool canHold(const AVFormatContext& film, FilmKind kind, AVCodecID codec);
// The text coding of films of this kind; NONE if they have none.
[[nodiscard]] AVCodecID textOf(FilmKind kind) noexcept;
// "a transport stream"
[[nodiscard]] const char* nameOf(FilmKind kind) noexcept;

}  // namespace relievo
