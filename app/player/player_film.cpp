// SPDX-License-Identifier: Apache-2.0
// What the player does within a film: carries out commands, waits for the reader, and follows the clock.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/player/player.h"
#include "app/scene/film_box.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr Error kNotAllowed{
    ErrorCode::Unsupported, 0,
    "not allowed in a playlist; allowed are http, https, rtsp, rtp, udp, tcp and, in a local file, paths"};

}  // namespace

void Player::carryOut(const Deed& deed, MonotonicTime now) {
  switch (deed.kind) {
    case Deed::Kind::GoOn:
      return goOn(now);
    case Deed::Kind::Stand:
      return stand(now);
    case Deed::Kind::StepOn:
      return stepOn(now);
    case Deed::Kind::Rate:
      if (apply(PlayerEvent::Rate)) film_.setRate(deed.rate, now);
      return;
    case Deed::Kind::Seek:
      return seek(deed.target, PlayerEvent::Seek, deed.by_viewer, now);
    case Deed::Kind::OpenFilm:
      if (placeOnShelf()) {
        browser_->select(deed.film);
        return openSelected(now);
      }
      return openFilm(deed.film, deed.back ? Programme::Way::Back : Programme::Way::Forward, now);
  }
}

void Player::goOn(MonotonicTime now) {
  if (!apply(PlayerEvent::Play)) return;
  film_.wishHeld(false);
  if (state_ != PlayerState::Playing) return;
  if (auto resumed = film_.resume(now); !resumed) failFilm("the film's clock", resumed.error());
}

void Player::stand(MonotonicTime now) {
  if (!apply(PlayerEvent::Pause)) return;
  film_.wishHeld(true);
  if (state_ != PlayerState::Paused) return;
  if (auto paused = film_.pause(now); !paused) failFilm("the film's clock", paused.error());
}

void Player::stepOn(MonotonicTime now) {
  if (!apply(PlayerEvent::Step)) return;
  if (!film_.held()) {
    if (auto paused = film_.pause(now); !paused) return failFilm("the film's clock", paused.error());
  }
  film_.stepOn(now);
}

void Player::seek(MediaTime target, PlayerEvent why, bool by_viewer, MonotonicTime now) {
  target = std::max(target, MediaTime{});
  if (state_ == PlayerState::Opening && apply(why)) return void(config_.start = target);
  if (why == PlayerEvent::Seek && film_.isStill()) return;  // a photo has no other place
  if (!apply(why)) return;
  // Picture and surface stay until the new picture comes, so that both agree.
  if (const auto clock = film_.clock()) touch_.feed(film_.depth(), {clock->at(now), now, 0});
  seeks_.asked(target, by_viewer, now);
  film_.seek(target, now);
  screen_.jump();
}

void Player::followReader(MonotonicTime now) {
  if (state_ == PlayerState::Opening) followOpening(now);
  if (state_ == PlayerState::Seeking && film_.arriving(now)) apply(PlayerEvent::Sought);
  if (state_ == PlayerState::Buffering) followProgress(film_.filling(), now);
}

void Player::followOpening(MonotonicTime now) {
  if (programme_.film().refused) return failFilm(programme_.film().url, kNotAllowed);
  switch (film_.opening()) {
    case FilmPlayback::Opening::Waits:
      return film_.noteWait(now);
    case FilmPlayback::Opening::Failed:
      return failFilm();
    case FilmPlayback::Opening::IsList: {
      const auto first = programme_.spread(film_.listed());
      if (!first) return failFilm(programme_.film().url, first.error());
      journal_.filmIsList();
      return openFilm(*first, programme_.way(), now);
    }
    case FilmPlayback::Opening::Opened:
      break;
  }
  apply(PlayerEvent::Opened);
  failure_.reset();
  programme_.opened();
  if (std::exchange(config_.unseen, false)) {
    log(LogLevel::Info, "play", "there is no desktop and no screen here: it plays off screen; see --display");
  }
  journal_.filmIs(film_.opened());
  beginWords();
  for (const std::string& path : std::exchange(words_to_add_, {})) addWords(path, now);
  doubts_.begin(film_.info().reading);
  const Duration length = film_.info().duration;
  if (const auto start = std::exchange(config_.start, std::nullopt)) {
    if (length <= Duration(0) || *start < MediaTime(length)) return seek(*start, PlayerEvent::Seek, false, now);
    return journal_.note(print("the film ends at %.1f s, before %.1f s", toSeconds(length), toSeconds(*start)),
                         "it begins at its beginning");
  }
  const auto left = programme_.whereLeft(length);
  if (!left) return;
  log(LogLevel::Info, "play", "resumes at %.1f s, where it was left", toSeconds(*left));
  seek(*left, PlayerEvent::Seek, false, now);
}

// One after the other, and after a warning that is shown: of the film before, which could not be played.
void Player::tellDoubts(MonotonicTime now) {
  if (screen_.text().showsWarning(now)) return;
  if (const auto doubt = doubts_.next()) screen_.text().tell(*doubt, now);
}

void Player::followProgress(FilmPlayback::Progress progress, MonotonicTime now) {
  switch (progress) {
    case FilmPlayback::Progress::Goes:
      return;
    case FilmPlayback::Progress::Ready:
      return begin(now);
    case FilmPlayback::Progress::Starved:
      apply(PlayerEvent::Starved);
      return journal_.note("buffering: the source or this computer is too slow",
                           "the picture stops until enough is buffered");
    case FilmPlayback::Progress::Over:
      if (film_.isStill() && programme_.size() == 1) return;  // a photo is shown until another command
      if (film_.rushes() && state_ == PlayerState::Buffering) return rushNoMore(now);
      return endFilm(now);
    case FilmPlayback::Progress::Failed:
      return failFilm();
  }
}

// There is no key frame from here to the end of the film.
void Player::rushNoMore(MonotonicTime now) {
  journal_.note("no fast forward here: the film has no more key frames", "it plays on at its usual rate");
  film_.setRate(1, now);
  seek(film_.goal(now), PlayerEvent::Seek, false, now);
}

// The first pair after a start, a seek or an underrun is on the screen before its clock starts, so that a slow first
// drawing delays nothing.
void Player::begin(MonotonicTime now) {
  if (film_.takeFirst()) {
    beginScene(now);
    touch_.setLookAhead(film_.lookAhead());
    screen_.setFirstHint(firstHint());
  } else if (scene_turns_ != film_.turns()) {
    beginScene(now);
  }
  if (film_.takeJump()) touch_.beginEpoch();
  const MediaTime first = film_.picture().color.pts;
  showPicture(now);
  if (state_ == PlayerState::Fault) return;
  if (touch_.waiting()) {  // with a still clock, so that the force fades in on a surface at rest
    touch_.feed(film_.depth(), {first, parts_.clock.now(), 0});
    touch_.start();
  }

  now = parts_.clock.now();
  if (auto started = film_.start(now); !started) return failFilm("the film's clock", started.error());
  apply(film_.held() ? PlayerEvent::FilledHeld : PlayerEvent::Filled);
  feedTouch();
  seeks_.shown(first, now, parts_.clock.now());
}

// In the shape of the present picture.
void Player::beginScene(MonotonicTime now) {
  scene_turns_ = film_.turns();
  DisplayVolume volume = config_.volume.value_or(usualBox(film_.picture().color, film_.picture().depth));
  if (config_.volume && scene_turns_ % 2 != 0) std::swap(volume.width_mm, volume.height_mm);
  const DepthCalibration& calibration = film_.info().calibration.calibration;
  touch_.setScene(calibration, volume, film_.info().material, film_.info().material_scale);
  screen_.setScene(calibration, volume, scene_turns_ % 2 != 0, film_.period(), now);
  announce(volume);
}

// The force begins anew on the surface that is turned. While the picture is waited for, it does so in `begin`.
void Player::turnPicture(int quarters, MonotonicTime now) {
  touch_.rest();
  film_.turn(quarters);
  if (!film_.begun()) return;
  beginScene(now);
  const bool goes = state_ == PlayerState::Playing || state_ == PlayerState::Paused;
  if (goes && film_.takeJump()) touch_.beginEpoch();
  const auto shown = screen_.showTurned(film_.picture(), film_.goal(now), film_.coming(), marks(), now);
  if (!shown) failDrawing(shown.error());
}

// Does not mention a missing device, or one without anything to feel.
std::string Player::firstHint() const {
  const std::string help = helpKey();
  std::string keys = help.empty() ? "" : help + ": all keys";
  const bool has_device = touch_.waiting() || touch_.running();
  if (!has_device || !film_.info().has_depth) return keys;
  return (config_.mouse_touches ? "Press into the picture to feel it.  " : "Reach into the picture to feel it.  ") +
         keys;
}

void Player::announce(const DisplayVolume& volume) {
  const int height = film_.picture().color.height;
  screen_.announce({facts().title, static_cast<int>(std::lround(height * volume.width_mm / volume.height_mm)), height});
}

// Without a film, and while one is opened, sought or waited for, the screen stands: only what is over it changes.
void Player::followClock(MonotonicTime now) {
  if (state_ == PlayerState::Fault) return;
  if (state_ != PlayerState::Playing && state_ != PlayerState::Paused)
    return redraw(marks(), MonotonicTime::max(), now);
  const std::size_t pictures = film_.advance(now);
  feedTouch();
  const bool shows = pictures > 0 && film_.hasNewPicture();
  if (pictures > 0) screen_.skip(shows ? pictures - 1 : pictures);
  if (shows) showPicture(now);
  else redraw(marks(), film_.nextPicture(now), now);
  if (state_ == PlayerState::Playing) followProgress(film_.going(now), now);
}

// A device may be connected, or reconnected, at any time.
void Player::followDevice() {
  const bool waits = touch_.followDevice();
  if (!waits || (state_ != PlayerState::Playing && state_ != PlayerState::Paused)) return;
  feedTouch();
  touch_.start();
}

void Player::showPicture(MonotonicTime now) {
  const auto seen = screen_.show(film_.picture(), film_.goal(now), film_.late(now), film_.coming(), marks(), now);
  if (!seen) failDrawing(seen.error());
  else if (*seen) film_.noteShown();
}

void Player::redraw(const FingerMarks& fingers, MonotonicTime next_picture, MonotonicTime now) {
  const MediaTime place = film_.place(now).value_or(MediaTime{});
  if (auto drawn = screen_.redraw(fingers, place, next_picture, now); !drawn) failDrawing(drawn.error());
}

// The finger marks, unless there is nothing to feel.
FingerMarks Player::marks() {
  return film_.info().has_depth ? touch_.marks() : FingerMarks{};
}

void Player::feedTouch() {
  if (const auto clock = film_.clock()) touch_.feed(film_.depth(), *clock);
}

}  // namespace relievo
