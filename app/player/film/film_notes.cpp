// SPDX-License-Identifier: Apache-2.0
// What the player tells of a film's sources: lost and found again, damaged, cut off; of decoders that begin anew.
#include "app/player/film/film_playback.h"
#include "platform/print.h"

namespace relievo {

void FilmPlayback::noteNews() {
  using Kind = FilmFeed::News::Kind;
  while (const auto news = feed_.takeNews()) {
    const bool color = news->kind == Kind::ColorLost || news->kind == Kind::ColorBack;
    const std::string& url = color || depth_url_.empty() ? url_ : depth_url_;
    switch (news->kind) {
      case Kind::ColorLost:
        journal_.note(url + " lost: " + news->why,
                      print("reconnecting; the film stops after %.0f s without it", toSeconds(FilmFeed::kPatience)),
                      news->time);
        break;
      case Kind::DepthLost:
        journal_.note(url + " lost: " + news->why, "the film plays on without depth and force; reconnecting",
                      news->time);
        break;
      case Kind::ColorBack:
        jumped_ = true;  // should the picture have stood meanwhile
        journal_.note(url + " found again", "the film goes on", news->time);
        break;
      case Kind::DepthBack:
        journal_.note(url + " found again", "its depth is felt again", news->time);
        break;
      case Kind::DecoderRestarted:
        journal_.note(news->why, news->done, news->time);
        break;
    }
  }
}

void FilmPlayback::noteMissing() {
  const auto noteOne = [this](const std::string& url, Duration missing, const char* done) {
    if (missing <= Duration(0)) return;
    journal_.note(print("%s ends %.1f s too early: truncated or damaged", url.c_str(), toSeconds(missing)), done);
  };
  const PairCounters pairs = feed_.counters();
  if (pairs.damaged > 0) {
    journal_.note(
        print("%llu pictures of %s are damaged", static_cast<unsigned long long>(pairs.damaged), url_.c_str()),
        "the decodable parts were shown");
  }
  noteOne(url_, pairs.missing, "the part that exists was played");
  noteOne(depth_url_, pairs.depth_missing, "the rest was shown without depth and force");
}

}  // namespace relievo
