// SPDX-License-Identifier: Apache-2.0
#include "app/player/film/film_changes.h"

#include "app/scene/sdr_color.h"
#include "platform/print.h"

namespace relievo {
namespace {

// ITU-T H.273.
constexpr std::uint8_t kBt2020 = 9, kDciP3 = 11, kDisplayP3 = 12;

bool isWide(std::uint8_t primaries) {
  return primaries == kBt2020 || primaries == kDciP3 || primaries == kDisplayP3;
}

}  // namespace

std::vector<std::string> changesOf(const FilmInfo& film) {
  std::vector<std::string> changes;
  if (film.interlaced) changes.emplace_back("the film is interlaced: each picture is made of its first field");
  if (const char* const hdr = hdrName(film.color_transfer)) {
    changes.push_back(print("the colour is HDR (%s): it is mapped to the range of an SDR screen", hdr));
  } else if (isWide(film.color_primaries)) {
    changes.emplace_back(
        "the colour has wide primaries and is shown as BT.709, so it looks pale; convert it to BT.709");
  }
  if (const int more = film.video_tracks_unused; more > 0) {
    changes.push_back(print("%d more video %s not used; if the depth is one of them, save it to a file for --depth",
                            more, more == 1 ? "track is" : "tracks are"));
  }
  return changes;
}

}  // namespace relievo
