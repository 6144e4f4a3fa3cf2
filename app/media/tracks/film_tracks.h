// SPDX-License-Identifier: Apache-2.0
// The sound and subtitle tracks of a film, and the choice among them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hal/media/media_source.h"

namespace relievo {

struct FilmTrack {
  int stream = -1;  // in the colour's source; -1: the file `path`
  std::string path;
  std::string codec, language, title;
  int channels = 0;  // of sound
  bool by_default = false, forced = false;
};

// "2 of 3, jpn, Director"; "off" for none.
[[nodiscard]] std::string describeTrack(const std::vector<FilmTrack>& tracks, std::optional<std::size_t> chosen);

// In the source's order.
[[nodiscard]] std::vector<FilmTrack> tracksOf(const std::vector<StreamInfo>& streams, StreamKind kind);
// The subtitle files beside `film`, found by their names (FILM.srt, FILM.en.ass, FILM.vtt, ..) and sorted by them:
// those without a language first, those for foreign words alone (FILM.en.forced.srt) last. None for an address.
[[nodiscard]] std::vector<FilmTrack> subtitleFilesOf(const std::string& film);

// `languages`: "jpn,en": the first that is there wins. Codes of two and of three letters mean the same languages.
// Otherwise the track that the film marks as its default one, else the first.
[[nodiscard]] std::optional<std::size_t> chooseSound(const std::vector<FilmTrack>& tracks,
                                                     const std::string& languages);
// As chooseSound by `languages`. Otherwise a file beside the film, first of all one in the language of the desktop
// ("de_DE.UTF-8"), or a track that the film marks as its default or as forced; else none.
[[nodiscard]] std::optional<std::size_t> chooseSubtitles(const std::vector<FilmTrack>& tracks,
                                                         const std::string& languages, const std::string& desktop);

}  // namespace relievo
