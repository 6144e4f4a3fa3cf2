// SPDX-License-Identifier: Apache-2.0
// What the player does with the list of films that a viewer chooses from.
#include <algorithm>
#include <array>

#include "app/player/player.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Error kTakenAway{ErrorCode::Lost, 0, "it was unplugged during the film; plug it in to continue"};

}  // namespace

// False for a command that is none of these.
bool Player::obeyBrowsing(const PlayerCommand& command, MonotonicTime now) {
  const bool browsing = state_ == PlayerState::Browsing;
  switch (command.verb) {
    case PlayerVerb::SelectBy:
      browser_->selectBy(static_cast<std::ptrdiff_t>(command.value));
      return true;
    case PlayerVerb::SelectTo:
      browser_->select(command.value == 0 ? browser_->shelf().size() : static_cast<std::size_t>(command.value) - 1);
      return true;
    case PlayerVerb::Choose:
      chooseFilm(now);
      return true;
    case PlayerVerb::Back:
      goBack(now);
      return true;
    case PlayerVerb::Escape:
      if (!browsing && returnsToBrowser() && !screen_.isFullScreen()) goBack(now);
      else screen_.obey({PlayerVerb::FullScreen, -1});
      return true;
    default:
      return false;
  }
}

// Selecting and choosing; nullopt: they can be done, or it is another command.
std::optional<std::string> Player::browsingRefusal(const PlayerCommand& command) const {
  constexpr std::array kVerbs{PlayerVerb::SelectBy, PlayerVerb::SelectTo, PlayerVerb::Choose};
  if (std::ranges::find(kVerbs, command.verb) == kVerbs.end()) return std::nullopt;
  if (state_ != PlayerState::Browsing) return "the list of films is not shown";
  const std::size_t films = browser_->shelf().size();
  if (films == 0) return "the list of films is empty";
  if (command.verb != PlayerVerb::SelectTo || command.value <= static_cast<double>(films)) return std::nullopt;
  return print("there is no film %.0f; the list has %zu", command.value, films);
}

void Player::openBrowser(MonotonicTime now) {
  if (!browser_ || !apply(PlayerEvent::Browse)) return;
  browsed_ = true;
  screen_.text().forgetWarning();  // of the film that was played
  screen_.text().hideKeys();       // likewise
  browser_->open(programme_.leftFilms(), now);
  screen_.announce({});
  screen_.text().setList(browser_->view());
  screen_.write(facts(), MonotonicTime::max(), now);
  screen_.clear();
}

void Player::closeBrowser() {
  if (!screen_.text().hasList()) return;
  browser_->close();
  screen_.text().setList(std::nullopt);
  screen_.text().hideKeys();       // they are the list's
  screen_.text().forgetWarning();  // of a film that could not be played
}

void Player::followBrowser(MonotonicTime now) {
  if (!browser_) return;
  if (state_ != PlayerState::Browsing) {
    const auto place = film_.isOpen() ? browser_->takenAway(programme_.film().url) : std::nullopt;
    if (place) failFilm(*place, kTakenAway);
    return;
  }
  browser_->warn(screen_.text().showsWarning(now));
  if (browser_->attend(now)) screen_.text().setList(browser_->view());
}

void Player::chooseFilm(MonotonicTime now) {
  if (state_ != PlayerState::Browsing || browser_->shelf().empty()) return;
  browser_->select(browser_->shelf().selected());  // the viewer's own choice from now on
  openSelected(now);
}

void Player::openSelected(MonotonicTime now) {
  const ShelfFilm film = browser_->shelf().film(browser_->shelf().selected());
  openList({{.url = film.url, .depth_url = film.depth_url, .title = film.title}}, now);
}

// A film that is played alone is the selected one of the list: next and previous are that list's films.
std::optional<std::size_t> Player::placeOnShelf() const {
  if (!browser_ || browser_->shelf().empty() || programme_.size() > 1) return std::nullopt;
  const std::size_t selected = browser_->shelf().selected();
  return browser_->shelf().film(selected).url == programme_.film().url ? std::optional(selected) : std::nullopt;
}

void Player::goBack(MonotonicTime now) {
  if (state_ == PlayerState::Browsing) browser_->select(0);
  else if (state_ == PlayerState::Idle) openBrowser(now);
  else stopFilm(now);
}

// Called within the display's `attend`: the chosen film is opened later in the round.
bool Player::hearMouseInList(const SurfaceMouse& mouse, bool clicks) {
  const auto film = screen_.filmAt(mouse);
  browser_->point(film);
  if (mouse.notches != 0) browser_->selectBy(-mouse.notches);
  if (clicks && screen_.isOverListHelp(mouse)) mouse_.click(PlayerVerb::Keys);
  if (clicks && film) {
    browser_->select(*film);
    mouse_.click(PlayerVerb::Choose);
  }
  return true;
}

}  // namespace relievo
