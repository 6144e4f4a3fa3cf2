// SPDX-License-Identifier: Apache-2.0
// A film that is decoded too slowly: pictures are left out until there is time for all of them again.
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "app/player/film/film_playback.h"
#include "drivers/mock/mock.h"
#include "platform/log.h"

namespace relievo {
namespace {

using std::chrono::milliseconds;

// While it is shut, the decoder stands still within a picture.
class Gate {
 public:
  void pass() {
    std::unique_lock lock(mutex_);
    opened_.wait(lock, [this] { return open_; });
  }
  void set(bool open) {
    const std::scoped_lock lock(mutex_);
    open_ = open;
    opened_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable opened_;
  bool open_ = true;
};

// Gives the reader's thread the time that it takes; the film's clock stands meanwhile.
void waitUntil(const std::function<bool()>& holds) {
  while (!holds()) std::this_thread::yield();
}

class FilmLateTest : public testing::Test {
 protected:
  static constexpr Duration kPeriod = milliseconds(40);
  static constexpr std::size_t kHeld = 9;  // pairs: the present one, four of the playhead, four of the feed

  FilmLateTest() { setLogLevel(LogLevel::Error); }
  ~FilmLateTest() override {
    gate_.set(true);
    film_.stop();
  }

  MockMediaProfile film() {
    const MockTrack color{.width = 16,
                          .height = 12,
                          .model = ColorModel::Yuv,
                          .frames = 6000,
                          .frame_period = kPeriod,
                          .sample = [this](int, int, int, int) {
                            gate_.pass();
                            return std::uint16_t{100};
                          }};
    return {.tracks = {color, {.width = 16, .height = 12, .frames = 6000, .frame_period = kPeriod}}};
  }
  void start() {
    film_.begin();
    film_.open({.url = "film"});
    waitUntil([&] { return film_.opening() == FilmPlayback::Opening::Opened; });
    film_.opened();
    waitUntil([&] { return film_.filling() == FilmPlayback::Progress::Ready; });
    film_.takeFirst();
    ASSERT_TRUE(film_.start(clock_.now()));
  }
  void tick() {
    clock_.sleepUntil(clock_.now() + milliseconds(10));
    advance();
    static_cast<void>(film_.going(clock_.now()));
  }
  void advance() { passed_ += film_.advance(clock_.now()); }
  // A reader that has time: it has read all that it may, and rests, before the clock goes on.
  void playInTime() {
    tick();
    waitUntil([&] {
      advance();
      return film_.pairs().pairs == passed_ + kHeld;
    });
  }

  std::size_t passed_ = 0;  // pairs, without the present one
  ManualClock clock_;
  Gate gate_;
  Journal journal_{clock_};
  FilmPlayback film_{
      {.make_source = [this](const std::string&) { return makeMockSources({{"film", film()}}, clock_); },
       .make_decoder =
           [](const StreamInfo&) { return makeMockDecoder({.max_held_frames = 32, .referenced_every = 2}); },
       .clock = &clock_,
       .own_threads = true},
      nullptr,
      clock_,
      journal_};
};

TEST_F(FilmLateTest, LeavesOutPicturesWhileItsDecoderIsLateAndThenNoMore) {
  start();
  gate_.set(false);
  for (int i = 0; i < 100; ++i) tick();
  gate_.set(true);
  waitUntil([&] {
    advance();
    return film_.pairs().left_out > 0;
  });
  int whole = 0;  // ticks since the last picture that was left out: one in eight, while they are
  for (int i = 0; i < 20'000 && whole < 100; ++i) {
    const auto before = film_.pairs().left_out;
    playInTime();
    whole = film_.pairs().left_out == before ? whole + 1 : 0;
  }
  EXPECT_EQ(whole, 100);
}

}  // namespace
}  // namespace relievo
