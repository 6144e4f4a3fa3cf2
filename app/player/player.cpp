// SPDX-License-Identifier: Apache-2.0
// The player's life: boot, the loop, the end.
#include "app/player/player.h"

#include <linux/input-event-codes.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <glm/geometric.hpp>
#include <utility>

#include "app/player/control/player_control.h"
#include "app/player/screen/notices.h"

namespace relievo {
namespace {

constexpr Duration kLongestWait = std::chrono::milliseconds(5);  // the most that a key waits
constexpr Duration kIdleWait = std::chrono::milliseconds(20);    // without a film
constexpr Duration kReaderWait = std::chrono::milliseconds(2);   // while the picture waits for the reader or a camera

PairReader::Backends backendsOf(const PlayerParts& parts, bool own_threads) {
  PairReader::Backends backends = parts.backends;
  backends.clock = &parts.clock;
  backends.own_threads = own_threads;
  return backends;
}

// The last part of a path or URL, without a query.
std::string titleOf(const std::string& url) {
  const std::string path = url.substr(0, url.find('?'));
  const std::size_t end = path.find_last_not_of('/');
  if (end == std::string::npos) return url;
  const std::size_t slash = path.rfind('/', end);
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  return path.substr(begin, end + 1 - begin);
}

// In the list of films the keys of a film mean nothing.
bool isForAnotherTime(const PlayerCommand& command, PlayerState state) noexcept {
  return state == PlayerState::Browsing && needsFilm(command.verb);
}

FingerForces forcesOf(const FingerMarks& marks) {
  const auto force = [](const std::optional<FingerMark>& mark) { return mark ? glm::length(mark->force_n) : 0.0; };
  return {force(marks[0]), force(marks[1])};
}

FingerFacts fingerFacts(std::string device, const std::optional<FingerMark>& mark, const DisplayVolume& volume) {
  FingerFacts facts{.haptic = std::move(device)};
  if (!mark) return facts;
  facts.contact = mark->contact;
  facts.force_n = glm::length(mark->force_n);
  if (volume.width_mm > 0) facts.across = mark->position_mm.x / volume.width_mm;
  if (volume.height_mm > 0) facts.up = mark->position_mm.y / volume.height_mm;
  return facts;
}

std::optional<double> secondsOf(std::optional<MediaTime> time) {
  return time ? std::optional(toSeconds(*time)) : std::nullopt;
}

}  // namespace

Player::Player(PlayerConfig config, PlayerParts parts)
    : config_(std::move(config)),
      parts_(std::move(parts)),
      journal_(parts_.clock,
               [this](const FaultEntry& fault, MonotonicTime when, bool fresh) {
                 if (parts_.control != nullptr) parts_.control->happened(fault);
                 if (fresh) screen_.text().tell(fault.what, when);
               }),
      programme_(config_.resume_path, config_.loop),
      film_(backendsOf(parts_, config_.own_threads), parts_.audio, parts_.clock, journal_),
      touch_({parts_.haptic, parts_.recorder}, parts_.second_finger, parts_.clock,
             config_.own_threads ? Ticking::Thread : Ticking::ByHand, journal_),
      screen_(parts_.display, config_.display, config_.stereo, config_.osd, parts_.clock, journal_),
      keys_(config_.keys),
      loudness_(config_.volume_path, config_.sound_device) {
  if (config_.volume_percent) loudness_.set(*config_.volume_percent);
  film_.soundOutput().setGain(loudness_.gain());
  if (config_.browser) browser_.emplace(*config_.browser, parts_.posters, config_.source, config_.own_threads);
  parts_.display.hearMouse([this](const SurfaceMouse& mouse) { return hearMouse(mouse); });
  journal_.stateChanged(state_);
  film_.hearLive([this](const FramePair& pair) { touch_.hear(pair.depth, pair.material); });
}

Player::~Player() {
  film_.stop();  // its reader may be about to tell of depth
  touch_.stop();
  parts_.display.hearMouse({});
}

bool Player::apply(PlayerEvent event) {
  const auto next = nextState(state_, event);
  if (!next) return false;
  if (std::exchange(state_, *next) == *next) return true;
  journal_.stateChanged(state_);
  if (parts_.control != nullptr) parts_.control->stateChanged(state_, journal_.sinceBegin(parts_.clock.now()));
  return true;
}

void Player::failFilm(const std::string& thing, const Error& error) {
  if (!apply(PlayerEvent::Fail)) return;
  film_.countPlayed(parts_.clock.now());
  journal_.noteStop(thing + ": " + error.message);
  failure_ = Failure{thing, error};
}

void Player::failDisplay(const Error& error) {
  display_failed_ = true;
  failFilm(std::string("display ") + screen_.capabilities().name, error);
}

// A picture that cannot be drawn (Unsupported) is the film's fault, other errors are the display's.
void Player::failDrawing(const Error& error) {
  if (error.code == ErrorCode::Unsupported) failFilm(programme_.film().url, error);
  else failDisplay(error);
}

Outcome<void> Player::run(const std::atomic<bool>& stop) {
  journal_.begin();
  boot();
  while (alive()) {
    const MonotonicTime now = parts_.clock.now();
    const bool time_is_up = config_.duration && now - journal_.began() >= *config_.duration;
    if (time_is_up || stop.load(std::memory_order_relaxed)) break;
    step(now);
    if (alive()) touch_.sleepUntil(nextWake(parts_.clock.now()));
  }
  finish(parts_.clock.now());
  if (failure_) return std::unexpected(*failure_);
  return {};
}

bool Player::alive() const noexcept {
  if (quitting_ || state_ == PlayerState::Fault) return false;
  return state_ != PlayerState::Idle || config_.stays;
}

void Player::boot() {
  if (auto opened = screen_.open(); !opened) return failDisplay(opened.error());
  if (parts_.remote != nullptr) {
    if (auto heard = parts_.remote->open(); !heard) {
      journal_.note(std::string("remote: ") + heard.error().message, "the film plays without one");
      parts_.remote = nullptr;
    }
  }
  film_.begin();
  touch_.begin();
  apply(PlayerEvent::Ready);
  if (parts_.control != nullptr) parts_.control->ready();
  if (config_.source.url.empty()) return openBrowser(journal_.began());
  std::vector<PlaylistEntry> films{{.url = config_.source.url, .depth_url = config_.source.depth_url, .title = ""}};
  for (const std::string& url : config_.more) films.push_back({.url = url, .depth_url = "", .title = ""});
  openList(films, journal_.began());
}

void Player::step(MonotonicTime now) {
  film_.read();
  if (const auto attended = screen_.attend(now); !attended) {
    if (attended.error().code == ErrorCode::Cancelled) quitting_ = true;  // the viewer has closed the window
    else failDisplay(attended.error());
  }
  followDrops(now);
  followMouse(now);
  readRemote(now);
  followDevice();
  film_.noteNews();
  followReader(now);
  followClock(now);
  followLoopAB(now);
  while (auto subtitle = film_.takeSubtitle()) screen_.subtitles().add(std::move(*subtitle));
  film_.followSound(state_ == PlayerState::Playing);
  programme_.keep(film_.placeToKeep(now), now);
  touch_.drain(seeks_, state_ == PlayerState::Playing ? film_.liveTimes() : nullptr);
  followStatistics(now);
  screen_.write(facts(), film_.nextPicture(now), now);
  followBrowser(now);
  followFault(now);
  tellStatus(now);
  if (parts_.control != nullptr) parts_.control->attend(*this, now);
}

void Player::tellStatus(MonotonicTime now) {
  if (parts_.status == nullptr || !parts_.status->isDue(now) || !film_.isOpen()) return;
  parts_.status->show(facts(), report(), forcesOf(touch_.marks()), now);
}

// The next picture, but soon enough for keys.
MonotonicTime Player::nextWake(MonotonicTime now) const {
  if (state_ == PlayerState::Idle || state_ == PlayerState::Browsing) return now + kIdleWait;
  if (state_ == PlayerState::Playing)
    return std::min(film_.nextPicture(now), now + (film_.isLive() ? kReaderWait : kLongestWait));
  return now + (state_ == PlayerState::Paused ? kLongestWait : kReaderWait);
}

void Player::finish(MonotonicTime now) {
  touch_.stop();  // zero force before anything else
  film_.silence();
  loudness_.keep();
  if (parts_.status != nullptr) parts_.status->clear();
  if (parts_.control != nullptr) parts_.control->stopping();
  touch_.drain(seeks_, nullptr);
  leaveFilm(now);
  if (state_ != PlayerState::Fault) apply(PlayerEvent::Stop);
  ended_ = parts_.clock.now();
  film_.stop();
  screen_.close();
  if (parts_.remote != nullptr) parts_.remote->close();
}

void Player::readRemote(MonotonicTime now) {
  while (parts_.remote != nullptr) {
    const auto key = parts_.remote->poll(now);
    if (!key) {
      journal_.note(std::string("remote: ") + key.error().message, "the film goes on without one");
      parts_.remote->close();
      parts_.remote = nullptr;
      return;
    }
    if (!*key) break;
    const auto command = keys_.take(**key, state_);
    if (command && !isForAnotherTime(*command, state_)) obey(*command, now);
    else noteUnbound(**key, now);
  }
  if (const auto command = keys_.held(now)) obey(*command, now);
}

// Within the display's `attend`.
bool Player::hearMouse(const SurfaceMouse& mouse) {
  if (state_ == PlayerState::Browsing) return hearMouseInList(mouse);
  if (mouse.notches != 0) return false;
  const auto share = screen_.barAt(mouse, parts_.clock.now());
  if (share && mouse.pressed) dragged_to_ = share;
  return share.has_value();
}

// While one seek is under way the mouse may move on; the last place counts.
void Player::followMouse(MonotonicTime now) {
  if (!dragged_to_ || state_ == PlayerState::Seeking) return;
  obey({PlayerVerb::SeekShare, *std::exchange(dragged_to_, std::nullopt)}, now);
}

// A key that means nothing says so once. Keys that only change the meaning of others are silent.
void Player::noteUnbound(const KeyEvent& key, MonotonicTime now) {
  constexpr std::array<std::uint16_t, 8> kSilent{KEY_LEFTSHIFT, KEY_RIGHTSHIFT, KEY_LEFTCTRL, KEY_RIGHTCTRL,
                                                 KEY_LEFTALT,   KEY_RIGHTALT,   KEY_LEFTMETA, KEY_RIGHTMETA};
  if (key.action != KeyEvent::Action::Press) return;
  const KeyTable::Binding* const binding = config_.keys.find(state_, key.code);
  if (binding != nullptr && (!binding->press || !isForAnotherTime(*binding->press, state_))) return;
  if (std::ranges::find(kSilent, key.code) != kSilent.end() || !unbound_.insert(key.code).second) return;
  const std::string label = keyLabel(key.code, config_.held);
  screen_.text().notice({(label.empty() ? "This key" : label) + " has no meaning here", std::nullopt}, now);
}

ScreenRows Player::keyRows() const {
  ScreenRows rows;
  if (config_.has_mouse) rows = mouseRows(state_ == PlayerState::Browsing, config_.mouse_touches);
  for (auto& row : config_.keys.rowsIn(state_, config_.held)) rows.push_back(std::move(row));
  return rows;
}

std::optional<std::string> Player::refusal(const PlayerCommand& command) const {
  if (auto why = browsingRefusal(command)) return why;
  if (!needsFilm(command.verb)) return std::nullopt;
  if (!film_.isOpen()) {
    constexpr std::array kOpening{PlayerVerb::Play, PlayerVerb::PlayPause, PlayerVerb::Next, PlayerVerb::Previous};
    const bool opens = std::ranges::find(kOpening, command.verb) != kOpening.end();
    if (opens && state_ == PlayerState::Idle && programme_.asked()) return std::nullopt;
    return state_ == PlayerState::Browsing ? "no film is open; choose one" : "no film is open; open one first";
  }
  if (command.verb != PlayerVerb::Next || programme_.present() + 1 < programme_.size()) return std::nullopt;
  return programme_.size() == 1 ? "no next film: this one is played alone" : "this is the last film of the list";
}

// The report is long: it is made once a second, and only to be seen.
void Player::followStatistics(MonotonicTime now) {
  if (!screen_.wantsStatistics() || !statistics_.isDue(now)) return;
  screen_.setStatistics(statistics_.rows(report(), forcesOf(screen_.fingers()), now));
}

void Player::obey(const PlayerCommand& command, MonotonicTime now) {
  if (auto why = refusal(command)) {
    why->front() = static_cast<char>(std::toupper(static_cast<unsigned char>(why->front())));
    return screen_.text().notice({std::move(*why), std::nullopt}, now);
  }
  switch (command.verb) {
    case PlayerVerb::Quit:
      quitting_ = true;
      return;
    case PlayerVerb::Open:
      return openList({{.url = command.word, .depth_url = "", .title = ""}}, now);
    case PlayerVerb::Stop:
      return stopFilm(now);
    case PlayerVerb::Loop:
      programme_.setLoop(command.value == 0 ? !programme_.loops() : command.value > 0);
      break;
    case PlayerVerb::Screenshot:
      return screen_.saveScreenshot(facts().title);
    case PlayerVerb::Keys:
      return screen_.text().toggleKeys(keyRows());
    default:
      break;
  }
  if (obeyBrowsing(command, now)) return;
  if (!obeySound(command, now)) obeyPicture(command, now);
  if (auto notice = noticeOf(command, facts())) screen_.text().notice(std::move(*notice), now);
  else screen_.wake(now);
}

void Player::obeyPicture(const PlayerCommand& command, MonotonicTime now) {
  screen_.obey(command);
  const Situation situation{.state = state_,
                            .held = film_.held(),
                            .rate = film_.rate(),
                            .here = film_.goal(now),
                            .length = film_.info().duration,
                            .chapters = film_.info().chapters,
                            .picture = film_.picture().color.pts,
                            .period = film_.period(),
                            .film = programme_.present(),
                            .films = programme_.size(),
                            .film_asked = programme_.asked()};
  for (const Deed& deed : deedsFor(command, situation)) carryOut(deed, now);
}

PlayReport Player::report() const {
  PlayReport report = journal_.written();
  report.wall_s = journal_.sinceBegin(ended_.value_or(parts_.clock.now()));
  report.source = config_.source.url;
  report.depth_source = config_.source.depth_url;
  report.pairs = film_.pairs();
  report.media_s = toSeconds(film_.played());
  report.live = film_.live();
  report.reliefs = film_.reliefs();
  report.sound = film_.sound();
  report.seeks = seeks_.entries();
  report.volume = touch_.volume();
  report.haptic = touch_.fingers()[0].session().summary();
  screen_.describe(report);
  const auto msSinceBegin = [this](std::optional<MonotonicTime> time) {
    return time ? std::optional(1e3 * journal_.sinceBegin(*time)) : std::nullopt;
  };
  report.first_frame_ms = msSinceBegin(screen_.firstShown());
  report.first_touch_ms = msSinceBegin(touch_.fingers()[0].firstTick());
  if (touch_.fingers().size() > 1) {
    const Finger& second = touch_.fingers()[1];
    report.second_finger = {second.session().summary(), msSinceBegin(second.firstTick())};
  }
  return report;
}

ScreenFacts Player::facts() const {
  const PlaylistEntry& film = programme_.film();
  std::array<FingerFacts, 2> fingers;
  for (std::size_t i = 0; i < touch_.fingers().size(); ++i) {
    fingers[i] = fingerFacts(touch_.fingers()[i].device(), screen_.fingers()[i], screen_.volume());
  }
  const MediaTime position = film_.place(parts_.clock.now()).value_or(film_.picture().color.pts);
  return {.title = film.title.empty() ? titleOf(film.url) : film.title,
          .position_s = toSeconds(position),
          .duration_s = toSeconds(film_.info().duration),
          .buffered_s = toSeconds(film_.bufferedUntil()),
          .state = state_,
          .held = film_.held(),
          .rate = film_.rate(),
          .loop = programme_.loops(),
          .film = programme_.present() + 1,
          .films = programme_.size(),
          .stereo = screen_.stereo(),
          .has_depth = film_.info().has_depth,
          .fingers = fingers,
          .volume_percent = loudness_.percent(),
          .muted = loudness_.muted(),
          .sound_track = describeTrack(film_.info().sounds, film_.info().sound),
          .subtitle_track = describeTrack(film_.info().subtitles, words_shown_ ? film_.info().words : std::nullopt),
          .sound_delay_s = toSeconds(film_.soundDelay()),
          .subtitle_delay_s = toSeconds(subtitle_delay_),
          .aspect = screen_.aspectWord(),
          .loop_from_s = secondsOf(loop_from_),
          .loop_to_s = secondsOf(loop_to_)};
}

}  // namespace relievo
