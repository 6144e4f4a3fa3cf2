// SPDX-License-Identifier: Apache-2.0
// libass returns bitmaps of one colour each; those that touch are blended into one picture.
#include "app/render/text/ass_text.h"

#include <ass/ass.h>

#include <algorithm>
#include <cstdarg>
#include <ctime>
#include <optional>
#include <utility>

#include "app/render/text/letter_area.h"
#include "app/render/text/shortened_script.h"
#include "platform/log.h"

namespace relievo {
namespace {

constexpr Error kNoFont{ErrorCode::NotFound, 0, "no font found; install one (Debian: fonts-dejavu-core)"};
constexpr int kMostGlyphs = 2000, kMostBitmapsMb = 24;
// A line of letters of any size, blurred, takes libass half a second and 30 MB, in which nothing can interrupt it.
constexpr double kMostCostS = 1;           // of processor time, for all lines that are seen at once
constexpr int kMostAtOnce = 1000;          // lines; signs that are drawn of many have hundreds
constexpr std::size_t kMostLine = 100000;  // bytes; a sign that is drawn with curves has ten thousand
// Squares as high as the screen, that the letters of a line cover. Five letters of 15 took libass 40 ms and 30 MB in
// 1920 x 1080; five of 1500 7 s and 1.4 GB.
constexpr double kMostArea = 16;

struct FreeLibrary {
  void operator()(ASS_Library* library) const noexcept { ass_library_done(library); }
};
struct FreeRenderer {
  void operator()(ASS_Renderer* renderer) const noexcept { ass_renderer_done(renderer); }
};
struct FreeTrack {
  void operator()(ASS_Track* track) const noexcept { ass_free_track(track); }
};

long long milliseconds(Duration time) noexcept {
  return std::chrono::duration_cast<std::chrono::milliseconds>(time).count();
}

struct Box {
  int left, top, right, bottom;
  [[nodiscard]] bool touches(const Box& other) const noexcept {
    return left <= other.right && other.left <= right && top <= other.bottom && other.top <= bottom;
  }
  void take(const Box& other) noexcept {
    left = std::min(left, other.left), top = std::min(top, other.top);
    right = std::max(right, other.right), bottom = std::max(bottom, other.bottom);
  }
};

// With a clear pixel around, so that a picture between two pixels of the screen keeps its edges.
Box boxOf(const ASS_Image& image) noexcept {
  return {image.dst_x - 1, image.dst_y - 1, image.dst_x + image.w + 1, image.dst_y + image.h + 1};
}

// The boxes of groups of images that touch one another.
std::vector<Box> groupsOf(const ASS_Image* images) {
  std::vector<Box> groups;
  for (const ASS_Image* image = images; image != nullptr; image = image->next) {
    if (image->w == 0 || image->h == 0) continue;
    Box box = boxOf(*image);
    for (bool grows = true; grows;) {  // a box that has grown may touch others
      const auto touched = std::ranges::find_if(groups, [&](const Box& group) { return group.touches(box); });
      grows = touched != groups.end();
      if (!grows) break;
      box.take(*touched);
      groups.erase(touched);
    }
    groups.push_back(box);
  }
  return groups;
}

void blend(const ASS_Image& image, TextPicture& picture) noexcept {
  const std::uint32_t opacity = 255 - (image.color & 0xff);
  const std::uint32_t color[3] = {image.color >> 24, image.color >> 16 & 0xff, image.color >> 8 & 0xff};
  for (int r = 0; r < image.h; ++r) {
    const std::uint8_t* const cover = image.bitmap + static_cast<std::ptrdiff_t>(r) * image.stride;
    std::uint8_t* out =
        picture.rgba.data() +
        4 * (static_cast<std::ptrdiff_t>(image.dst_y - picture.y + r) * picture.width + image.dst_x - picture.x);
    for (int c = 0; c < image.w; ++c, out += 4) {
      const std::uint32_t share = cover[c] * opacity;  // of 255 x 255
      if (share == 0) continue;
      constexpr std::uint32_t kWhole = 255 * 255;
      for (int k = 0; k < 3; ++k) {
        out[k] = static_cast<std::uint8_t>((color[k] * share + out[k] * (kWhole - share) + kWhole / 2) / kWhole);
      }
      out[3] = static_cast<std::uint8_t>((255 * share + out[3] * (kWhole - share) + kWhole / 2) / kWhole);
    }
  }
}

double processorS() noexcept {
  timespec used{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

struct MissingLetter {
  char32_t letter = 0;
  bool heard = false;
};

// Called for every message of libass, which says only in words that no font has a letter. `told` is a MissingLetter.
void hearLibass(int, const char* format, va_list arguments, void* told) {
  constexpr unsigned kFirstMark = 0x2000, kLastMark = 0x206f;  // spaces, joiners and the like: nothing is seen of them
  if (std::string_view(format).find("any fallback with glyph") == std::string_view::npos) return;
  const unsigned letter = va_arg(arguments, unsigned);
  auto& missing = *static_cast<MissingLetter*>(told);
  if ((letter >= kFirstMark && letter <= kLastMark) || missing.heard) return;
  missing = {.letter = letter, .heard = true};
}

// Without any font libass draws nothing.
bool drawsLetters(AssText& text) {
  text.begin("[Script Info]\nPlayResX: 64\nPlayResY: 64\n");
  text.add("0,0,Default,,0,0,0,,M", Duration(0), std::chrono::seconds(1));
  std::vector<TextPicture> pictures;
  text.draw({.width = 64, .height = 64, .aspect = 1}, Duration(0), pictures);
  return !pictures.empty();
}

}  // namespace

struct AssText::Parts {
  MissingLetter missing;
  std::unique_ptr<ASS_Library, FreeLibrary> library;
  std::unique_ptr<ASS_Renderer, FreeRenderer> renderer;
  std::unique_ptr<ASS_Track, FreeTrack> track;
  std::optional<TextFrame> frame;
  std::vector<double> areas;  // letterArea of each line of a foreign script
  bool foreign = false;
  int at_once = 1, most_at_once = kMostAtOnce;  // lines; the latter fewer once it was slow
  bool told = false;

  const ASS_Image* render(long long now_ms, int& changed);
  void leaveOut(int most);
  void measureLast();
};

// Twice as many lines are tried while they are quick: scripts that cost too much are shown in part.
const ASS_Image* AssText::Parts::render(long long now_ms, int& changed) {
  if (!foreign) return ass_render_frame(renderer.get(), track.get(), now_ms, &changed);
  for (;;) {
    const Shortened script(*track, areas, now_ms, std::min(at_once, most_at_once));
    const double begun_s = processorS();
    int differs = 0;
    const ASS_Image* const images = ass_render_frame(renderer.get(), track.get(), now_ms, &differs);
    changed |= differs;
    const bool slow = processorS() - begun_s > kMostCostS;
    if (script.seen() == 0 && script.all()) most_at_once = std::max(most_at_once, 1);  // what follows may be quick
    if (slow && (told || script.seen() > 1)) leaveOut(script.seen() / 2);  // a single one may have loaded fonts
    else if (!script.all() && !script.full() && at_once < most_at_once) {
      at_once *= 2;
      continue;
    } else if (!script.all()) leaveOut(most_at_once);
    return images;
  }
}

void AssText::Parts::leaveOut(int most) {
  most_at_once = most;
  if (!std::exchange(told, true))
    log(LogLevel::Warning, "play",
        "subtitles take too long to draw, or are larger than the screen; some of their lines are left out");
}

// The line that was added last, if it is one. Leaves it out if it is huge.
void AssText::Parts::measureLast() {
  if (static_cast<std::size_t>(track->n_events) == areas.size()) return;
  areas.push_back(letterArea(track->events[track->n_events - 1], *track));
  if (areas.back() <= kMostArea) return;
  areas.pop_back();
  ass_free_event(track.get(), --track->n_events);
  leaveOut(most_at_once);
}

AssText::AssText(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
AssText::AssText(AssText&&) noexcept = default;
AssText& AssText::operator=(AssText&&) noexcept = default;
AssText::~AssText() = default;

Result<AssText> AssText::create(bool foreign) {
  auto parts = std::make_unique<Parts>();
  parts->library.reset(ass_library_init());
  if (!parts->library) return fail(ErrorCode::Exhausted, "out of memory for text");
  ass_set_message_cb(parts->library.get(), hearLibass, &parts->missing);
  parts->renderer.reset(ass_renderer_init(parts->library.get()));
  if (!parts->renderer) return fail(ErrorCode::Exhausted, "out of memory for text");
  ass_set_fonts(parts->renderer.get(), nullptr, "sans-serif", ASS_FONTPROVIDER_AUTODETECT, nullptr, 1);
  ass_set_cache_limits(parts->renderer.get(), kMostGlyphs, kMostBitmapsMb);
  AssText text(std::move(parts));
  if (!drawsLetters(text)) return std::unexpected(kNoFont);
  text.parts_->foreign = foreign;
  return text;
}

char32_t AssText::takeMissingLetter() noexcept {
  return std::exchange(parts_->missing.letter, U'\0');
}

void AssText::begin(std::string_view head) {
  parts_->track.reset(ass_new_track(parts_->library.get()));
  parts_->at_once = 1;
  parts_->most_at_once = kMostAtOnce;
  parts_->told = false;
  parts_->areas.clear();
  if (!parts_->track) return;
  std::string copy(head);
  ass_process_codec_private(parts_->track.get(), copy.data(), static_cast<int>(copy.size()));
  ass_flush_events(parts_->track.get());  // a head has no lines; what is there was not measured
  ass_set_check_readorder(parts_->track.get(), 0);
  ass_track_set_feature(parts_->track.get(), ASS_FEATURE_WRAP_UNICODE, 1);
}

void AssText::add(std::string_view line, Duration begin, Duration length) {
  if (!parts_->track) return;
  if (parts_->foreign && line.size() > kMostLine) return parts_->leaveOut(parts_->most_at_once);
  std::string copy(line);
  ass_process_chunk(parts_->track.get(), copy.data(), static_cast<int>(copy.size()), milliseconds(begin),
                    milliseconds(length));
  if (parts_->foreign) parts_->measureLast();
}

void AssText::removeLines() {
  if (parts_->track) ass_flush_events(parts_->track.get());
  parts_->areas.clear();
}

void AssText::setSize(double factor) noexcept {
  ass_set_font_scale(parts_->renderer.get(), factor);
}

bool AssText::draw(const TextFrame& frame, Duration time, std::vector<TextPicture>& pictures, bool anew) {
  if (!parts_->track) return std::exchange(pictures, {}).size() != 0;
  ASS_Renderer* const renderer = parts_->renderer.get();
  if (parts_->frame != frame) {
    ass_set_frame_size(renderer, frame.width, frame.height);
    ass_set_margins(renderer, frame.margin_y, frame.margin_y, frame.margin_x, frame.margin_x);
    ass_set_pixel_aspect(renderer, static_cast<double>(frame.width) / frame.height / frame.aspect);
  }
  int changed = 0;
  const ASS_Image* const images = parts_->render(milliseconds(time), changed);
  if (changed == 0 && parts_->frame == frame && !anew) return false;
  parts_->frame = frame;
  pictures.clear();
  for (const Box& box : groupsOf(images)) {
    const int width = box.right - box.left, height = box.bottom - box.top;
    TextPicture picture{box.left, box.top, width, height, width, height, {}};
    picture.rgba.resize(4 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    for (const ASS_Image* image = images; image != nullptr; image = image->next) {
      if (image->w > 0 && image->h > 0 && box.touches(boxOf(*image))) blend(*image, picture);
    }
    pictures.push_back(std::move(picture));
  }
  return true;
}

// libass gives a backslash no meaning where a word joiner follows it.
std::string AssText::escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '{') safe += "\\{";
    else if (c == '\\') safe += "\\\xe2\x81\xa0";
    else if (c == '\n') safe += "\\N";
    else if (static_cast<unsigned char>(c) >= ' ') safe += c;
  }
  return safe;
}

}  // namespace relievo
