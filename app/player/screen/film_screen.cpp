// SPDX-License-Identifier: Apache-2.0
// Decides when to draw.
#include "app/player/screen/film_screen.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <utility>

#include "app/media/pairs/long_wait.h"
#include "app/player/screen/bar_script.h"
#include "app/player/screen/keys_script.h"
#include "app/player/screen/list_script.h"
#include "app/player/screen/stereo_word.h"
#include "platform/log.h"
#include "platform/print.h"

namespace relievo {
namespace {

constexpr double kDrawShare = 0.6;  // of the film's frame period; the rest is left for decoding and touch
constexpr Duration kRedrawPeriod = std::chrono::milliseconds(33);  // of a paused picture while the finger moves
constexpr double kMovedMm = 0.2;                                   // smaller movements are invisible

bool movedVisibly(const std::optional<FingerMark>& a, const std::optional<FingerMark>& b) noexcept {
  if (a.has_value() != b.has_value()) return true;
  return a && (a->contact != b->contact || glm::distance(a->position_mm, b->position_mm) > kMovedMm);
}

bool movedVisibly(const FingerMarks& a, const FingerMarks& b) noexcept {
  return movedVisibly(a[0], b[0]) || movedVisibly(a[1], b[1]);
}

}  // namespace

Result<void> FilmScreen::open(const std::atomic<bool>& stop) {
  auto opened = picture_.open(stop);
  if (const std::string words = picture_.description(); opened && !words.empty()) {
    log(LogLevel::Info, "render", "%s", words.c_str());
  }
  if (opened || opened.error().code != ErrorCode::NotFound) return opened;
  journal_.note(std::string("display: ") + opened.error().message, "film and touch go on without it");
  return {};
}

Result<void> FilmScreen::attend(MonotonicTime now) {
  noteSaved(now);
  const auto redraw = picture_.attend(now);
  if (redraw) {
    redraw_ = redraw_ || *redraw;
    return {};
  }
  if (redraw.error().code != ErrorCode::Lost) return std::unexpected(redraw.error());
  noteLost();
  return {};
}

void FilmScreen::setScene(const DepthCalibration& calibration, const DisplayVolume& volume, bool on_side,
                          Duration period, MonotonicTime now) {
  calibration_ = calibration;
  jump();
  picture_.setScene(calibration, volume, fromSeconds(kDrawShare * toSeconds(period)));
  on_side_ = on_side;
  applyAspect();
  text_.wake(now);
}

Result<bool> FilmScreen::show(const FramePair& pair, MediaTime place, std::optional<Duration> late,
                              const DepthComing& coming, const FingerMarks& fingers, MonotonicTime now) {
  picture_.setPair(pair, place, late);
  lookAhead(pair.depth, coming);
  const auto seen = draw(fingers, now);
  if (!seen || !*seen) {
    ++dropped_;
    return seen;
  }
  ++shown_;
  if (!first_shown_) {  // the first drawing may have taken long
    first_shown_ = clock_.now();
    text_.wake(*first_shown_);
    if (!first_hint_.empty()) text_.hint(first_hint_, *first_shown_);
  }
  return true;
}

Result<void> FilmScreen::showTurned(const FramePair& pair, MediaTime place, const DepthComing& coming,
                                    const FingerMarks& fingers, MonotonicTime now) {
  picture_.setPair(pair, place);
  lookAhead(pair.depth, coming);
  const auto drawn = draw(fingers, now);
  return drawn ? Result<void>{} : std::unexpected(drawn.error());
}

Result<void> FilmScreen::redraw(const FingerMarks& fingers, MediaTime place, MonotonicTime next_picture,
                                MonotonicTime now) {
  if (!redraw_ && (now < drawn_at_ + kRedrawPeriod || next_picture < now + kRedrawPeriod)) return {};
  const bool words = picture_.subtitlesChange(place);  // whatever else the drawing is for
  if (!redraw_ && !words && !picture_.away() && !movedVisibly(fingers, drawn_fingers_)) return {};
  const auto drawn = draw(fingers, now);
  return drawn ? Result<void>{} : std::unexpected(drawn.error());
}

void FilmScreen::clear() noexcept {
  picture_.clear();
  redraw_ = true;
}

// False if the screen is lost.
Result<bool> FilmScreen::draw(const FingerMarks& fingers, MonotonicTime now) {
  drawn_fingers_ = fingers;
  drawn_at_ = now;
  redraw_ = false;
  const auto shown = picture_.show(fingers, now);
  if (!shown) return std::unexpected(shown.error());
  writeScreenshot(now);
  if (const char* why = picture_.takeRefusal()) {
    journal_.note(std::string("stereo: ") + why, print("shown as %s", name(picture_.stereo().layout)));
  }
  for (const char32_t letter : {picture_.words().takeMissingLetter(), subtitles().takeMissingLetter()}) {
    if (letter != 0) noteMissing(letter);
  }
  if (*shown == Picture::Shown::Lost) noteLost();
  if (*shown == Picture::Shown::Back) journal_.note("display back", "the picture is shown again");
  return *shown == Picture::Shown::OnScreen || *shown == Picture::Shown::Back;
}

void FilmScreen::write(const ScreenFacts& facts, MonotonicTime next_picture, MonotonicTime now) {
  const bool waits = waitsLong(facts.state, now);
  if (waits && text_.noticed(now).empty()) text_.notice({"Opening " + facts.title, std::nullopt}, now);
  const bool any = text_.hasList() || (osd_ && (first_shown_ || waits));
  auto content = any ? text_.content(facts, statistics_, now) : ScreenContent{};
  if (content == written_) return;
  written_ = content;
  picture_.setText(std::move(content));
  if (next_picture > now + 2 * kRedrawPeriod) redraw_ = true;  // else the next picture shows it
}

// A window that is hidden until there is a picture comes up by what is written then.
bool FilmScreen::waitsLong(PlayerState state, MonotonicTime now) noexcept {
  const bool waits = state == PlayerState::Opening || (state == PlayerState::Buffering && !first_shown_);
  waits_since_ = waits ? waits_since_.value_or(now) : std::optional<MonotonicTime>();
  return waits && now - *waits_since_ > kLongWait;
}

void FilmScreen::turnKeys(ScreenRows rows) {
  if (!osd_ && !text_.hasList()) return text_.notice({"All keys: relievo play --help", std::nullopt}, clock_.now());
  const TextFrame frame = picture_.textFrame();
  const std::size_t pages = keyPages(rows, frame.aspect, frame.height);
  text_.turnKeys(std::move(rows), pages);
}

void FilmScreen::jump() {
  coming_.forget();
  picture_.setAhead({});
  picture_.cut();
}

// At a cut the subtitles may stand at another depth at once.
void FilmScreen::lookAhead(const Frame& depth, const DepthComing& coming) {
  if (!subtitles().mayShow() || depth.empty()) return jump();
  if (coming_.follow(depth, coming, calibration_, picture_.volume())) picture_.cut();
  picture_.setAhead(coming_.ahead());
}

void FilmScreen::obey(const PlayerCommand& command) {
  switch (command.verb) {
    case PlayerVerb::FullScreen:
      return picture_.fillScreen(command.value == 0  ? FullScreen::Toggle
                                 : command.value > 0 ? FullScreen::On
                                                     : FullScreen::Off);
    case PlayerVerb::Info:
      return text_.toggleBar();
    case PlayerVerb::Statistics:
      return text_.toggleStatistics();
    case PlayerVerb::ZoomBy:
      picture_.changeZoom(command.value);
      break;
    case PlayerVerb::SubtitleDelayBy:
      subtitles().changeDelay(fromSeconds(command.value));
      break;
    case PlayerVerb::SubtitleSizeBy:
      subtitles().changeSize(command.value);
      break;
    case PlayerVerb::Aspect:
      changeAspect(command.word);
      break;
    case PlayerVerb::Layout:
      if (command.word.empty()) picture_.nextLayout();
      else picture_.setLayout(command.word);
      break;
    case PlayerVerb::SwapEyes:
      picture_.swapEyes();
      break;
    case PlayerVerb::DepthBy:
      picture_.changeStrength(command.value);
      break;
    case PlayerVerb::ScreenBy:  // parts above the screen plane appear in front of the screen
      picture_.changeScreenPlane(-command.value);
      break;
    default:
      return;
  }
  redraw_ = true;
}

void FilmScreen::changeAspect(const std::string& word) {
  constexpr std::array kWords{"film", "16:9", "4:3", "2.35:1"};
  aspect_word_ = word.empty() ? kWords[++next_aspect_ % kWords.size()] : word;
  applyAspect();
}

void FilmScreen::applyAspect() noexcept {
  const double aspect = parseAspect(aspect_word_).value_or(0);
  picture_.setAspect(on_side_ && aspect > 0 ? 1 / aspect : aspect);
}

std::optional<double> FilmScreen::barAt(const SurfaceMouse& mouse, MonotonicTime now) {
  constexpr double kNear = 0.8;  // of the view's height
  const auto point = osd_ ? picture_.viewPoint(mouse.across, mouse.down) : std::nullopt;
  if (!point) return std::nullopt;
  drags_bar_ = drags_bar_ && mouse.pressed;
  if (point->down > std::min(kNear, roomForWords(written_, point->aspect)) || drags_bar_) text_.wake(now);
  const auto share =
      drags_bar_ ? barShareAlong(point->across, point->aspect) : barShareAt(point->across, point->down, point->aspect);
  text_.point(share, drags_bar_ ? std::nullopt : buttonAt(mouse), now);
  if (!written_.bar || !written_.bar->has_length) return std::nullopt;
  drags_bar_ = share && mouse.pressed;
  return share;
}

std::optional<PlayerVerb> FilmScreen::buttonAt(const SurfaceMouse& mouse) const {
  const auto point = written_.bar ? picture_.viewPoint(mouse.across, mouse.down) : std::nullopt;
  return point ? barButtonAt(*written_.bar, point->across, point->down, point->aspect) : std::nullopt;
}

bool FilmScreen::isOverBar(const SurfaceMouse& mouse) const {
  const auto point = written_.bar ? picture_.viewPoint(mouse.across, mouse.down) : std::nullopt;
  return point && (drags_bar_ || point->down > roomForWords(written_, point->aspect));
}

std::optional<std::size_t> FilmScreen::filmAt(const SurfaceMouse& mouse) const {
  const auto point = written_.list ? picture_.viewPoint(mouse.across, mouse.down) : std::nullopt;
  return point ? listFilmAt(*written_.list, point->across, point->down, point->aspect) : std::nullopt;
}

bool FilmScreen::isOverListHelp(const SurfaceMouse& mouse) const {
  const auto point = written_.list ? picture_.viewPoint(mouse.across, mouse.down) : std::nullopt;
  return point && isListHelpAt(written_.help_key, point->across, point->down, point->aspect);
}

void FilmScreen::describe(PlayReport& report) const {
  const RenderStatistics& drawn = picture_.statistics();
  report.display = picture_.capabilities().name;
  report.display_mode = picture_.description();
  report.stereo = stereoWord(picture_.stereo());
  report.surface_width = picture_.width();
  report.surface_height = picture_.height();
  report.imported = drawn.imported;
  report.triangles = drawn.triangles;
  report.picture_error_px = drawn.error_px;
  report.drawn_size = drawn.size;
  report.mesh_ms = drawn.mesh_ms;
  report.draw_ms = drawn.frame_ms;
  report.frames_shown = shown_;
  report.frames_dropped = dropped_;
}

void FilmScreen::noteMissing(char32_t letter) {
  journal_.note(print("no font here has the letter U+%04X", static_cast<unsigned>(letter)),
                "boxes are shown for such letters; install a font that has them (Debian: fonts-noto-core; Chinese, "
                "Japanese, Korean: fonts-noto-cjk)");
}

void FilmScreen::noteLost() {
  journal_.note("display lost", "film and touch continue; the display is tried again every second");
}

}  // namespace relievo
