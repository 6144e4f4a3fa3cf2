// SPDX-License-Identifier: Apache-2.0
// Chooses by language, by mark, by order.
#include "app/media/tracks/film_tracks.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <tuple>

#include "platform/files/answered_place.h"
#include "platform/text/lower_case.h"

namespace relievo {
namespace {

namespace fs = std::filesystem;

// ISO 639: two letters, and the codes of three letters in use, of books and of terms.
struct Language {
  std::string_view two, three, other;
};
constexpr std::array kLanguages{
    Language{"ar", "ara", ""},    Language{"bg", "bul", ""},    Language{"ca", "cat", ""},
    Language{"cs", "cze", "ces"}, Language{"da", "dan", ""},    Language{"de", "ger", "deu"},
    Language{"el", "gre", "ell"}, Language{"en", "eng", ""},    Language{"es", "spa", ""},
    Language{"et", "est", ""},    Language{"fa", "per", "fas"}, Language{"fi", "fin", ""},
    Language{"fr", "fre", "fra"}, Language{"he", "heb", ""},    Language{"hi", "hin", ""},
    Language{"hr", "hrv", ""},    Language{"hu", "hun", ""},    Language{"id", "ind", ""},
    Language{"is", "ice", "isl"}, Language{"it", "ita", ""},    Language{"ja", "jpn", ""},
    Language{"ko", "kor", ""},    Language{"lt", "lit", ""},    Language{"lv", "lav", ""},
    Language{"nb", "nob", ""},    Language{"nl", "dut", "nld"}, Language{"no", "nor", ""},
    Language{"pl", "pol", ""},    Language{"pt", "por", ""},    Language{"ro", "rum", "ron"},
    Language{"ru", "rus", ""},    Language{"sk", "slo", "slk"}, Language{"sl", "slv", ""},
    Language{"sr", "srp", ""},    Language{"sv", "swe", ""},    Language{"th", "tha", ""},
    Language{"tr", "tur", ""},    Language{"uk", "ukr", ""},    Language{"vi", "vie", ""},
    Language{"zh", "chi", "zho"},
};

// One word for a language, however it is written; without what follows it ("pt-BR", "de_DE.UTF-8", "en.sdh").
std::string plain(std::string_view code) {
  const std::string word = lowerCase(code.substr(0, code.find_first_of("-_.")));
  const auto known = std::ranges::find_if(kLanguages, [&](const Language& each) {
    return word == each.two || word == each.three || (!each.other.empty() && word == each.other);
  });
  return known == kLanguages.end() ? word : std::string(known->two);
}

std::string tag(const StreamInfo& stream, const char* key) {
  const auto found = stream.tags.find(key);
  return found == stream.tags.end() ? "" : found->second;
}

std::optional<std::size_t> byLanguage(const std::vector<FilmTrack>& tracks, const std::string& languages) {
  std::istringstream wished(languages);
  for (std::string code; std::getline(wished, code, ',');) {
    const auto found = std::ranges::find_if(tracks, [&](const FilmTrack& track) {
      return !track.language.empty() && plain(track.language) == plain(code);
    });
    if (found != tracks.end()) return static_cast<std::size_t>(found - tracks.begin());
  }
  return std::nullopt;
}

template <class Is>
std::optional<std::size_t> firstThat(const std::vector<FilmTrack>& tracks, Is is) {
  const auto found = std::ranges::find_if(tracks, is);
  return found == tracks.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - tracks.begin()));
}

}  // namespace

std::string describeTrack(const std::vector<FilmTrack>& tracks, std::optional<std::size_t> chosen) {
  if (tracks.empty()) return "none in this film";
  if (!chosen || *chosen >= tracks.size()) return "off";
  const FilmTrack& track = tracks[*chosen];
  std::string words = std::to_string(*chosen + 1) + " of " + std::to_string(tracks.size());
  for (const std::string& more : {track.language, track.title, fs::path(track.path).filename().string()}) {
    if (!more.empty() && more != "und") words += ", " + more;
  }
  return words;
}

std::vector<FilmTrack> tracksOf(const std::vector<StreamInfo>& streams, StreamKind kind) {
  std::vector<FilmTrack> tracks;
  for (const StreamInfo& stream : streams) {
    if (stream.kind != kind) continue;
    tracks.push_back({.stream = stream.index,
                      .path = "",
                      .codec = stream.codec,
                      .language = tag(stream, "LANGUAGE"),
                      .title = tag(stream, "TITLE"),
                      .channels = stream.channels,
                      .by_default = stream.by_default,
                      .forced = stream.forced});
  }
  return tracks;
}

std::vector<FilmTrack> subtitleFilesOf(const std::string& film) {
  constexpr std::array kEndings{".srt", ".ass", ".ssa", ".vtt"};
  std::vector<FilmTrack> tracks;
  const fs::path path(film);
  if (!isRegularFile(path)) return tracks;
  const std::string stem = path.stem().string();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (const auto& [name, is] : entriesOf(folder)) {
    const fs::path beside = folder / name;
    const std::string ending = lowerCase(beside.extension().string());
    if (std::ranges::find(kEndings, ending) == kEndings.end() || is != FolderEntry::Kind::File) continue;
    const std::string own = beside.stem().string();  // FILM or FILM.en
    if (own != stem && !own.starts_with(stem + ".")) continue;
    const std::string between = own.size() > stem.size() ? own.substr(stem.size() + 1) : "";
    tracks.push_back({.path = beside.string(),
                      .codec = ending.substr(1),
                      .language = between,
                      .forced = lowerCase(between).ends_with("forced")});
  }
  std::ranges::sort(
      tracks, {}, [](const FilmTrack& track) { return std::tuple(track.forced, !track.language.empty(), track.path); });
  return tracks;
}

std::optional<std::size_t> chooseSound(const std::vector<FilmTrack>& tracks, const std::string& languages) {
  if (tracks.empty()) return std::nullopt;
  if (const auto wished = byLanguage(tracks, languages)) return wished;
  return firstThat(tracks, [](const FilmTrack& track) { return track.by_default; }).value_or(0);
}

std::optional<std::size_t> chooseSubtitles(const std::vector<FilmTrack>& tracks, const std::string& languages,
                                           const std::string& desktop) {
  if (const auto wished = byLanguage(tracks, languages)) return wished;
  const auto is_file = [](const FilmTrack& track) { return track.stream < 0; };
  const auto understood = [&](const FilmTrack& track) {
    return is_file(track) && !desktop.empty() && plain(track.language) == plain(desktop);
  };
  if (const auto file = firstThat(tracks, understood)) return file;
  if (const auto file = firstThat(tracks, is_file)) return file;
  return firstThat(tracks, [](const FilmTrack& track) { return track.by_default || track.forced; });
}

}  // namespace relievo
