// SPDX-License-Identifier: Apache-2.0
// What the player tells of sources that are lost and found again, and of decoders that begin anew.
#include "app/player/player.h"
#include "platform/print.h"

namespace relievo {

void Player::followSource() {
  using Kind = FilmFeed::News::Kind;
  while (const auto news = feed_.takeNews()) {
    const bool color = news->kind == Kind::ColorLost || news->kind == Kind::ColorBack;
    const std::string& url = color || film().depth_url.empty() ? film().url : film().depth_url;
    switch (news->kind) {
      case Kind::ColorLost:
        note(url + " lost: " + news->why,
             print("it is opened again; after %.0f s without it the film stops", toSeconds(FilmFeed::kPatience)),
             news->time);
        break;
      case Kind::DepthLost:
        note(url + " lost: " + news->why, "the film goes on flat, without force; it is opened again", news->time);
        break;
      case Kind::ColorBack:
        new_epoch_ = true;  // should the picture have stood meanwhile
        note(url + " found again", "the film goes on", news->time);
        break;
      case Kind::DepthBack:
        note(url + " found again", "its depth is felt again", news->time);
        break;
      case Kind::DecoderRestarted:
        note(news->why, news->done, news->time);
        break;
    }
  }
}

}  // namespace relievo
