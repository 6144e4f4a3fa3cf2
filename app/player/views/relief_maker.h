// SPDX-License-Identifier: Apache-2.0
// Makes the reliefs of a stereo film while it plays, on a thread of its own.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/media/pair_reader.h"
#include "app/player/views/relief_pace.h"
#include "app/player/views/stereo_matcher.h"
#include "platform/clock.h"

namespace relievo {

struct ReliefSummary {
  std::uint64_t made = 0, dropped = 0;  // pictures with a relief of their own, and without
  int cols = 0;                         // columns of the views as they are matched
  double mean_ms = 0;                   // the time to make one relief
};

// The player's side (everything except `work`) never waits for a relief. Pictures are read far enough ahead for a
// relief to be ready before its picture is shown. If reliefs take too long, only every second or third picture gets
// one; a picture that is shown before its relief was begun gets none. Without the thread the caller calls `work`.
//
// The first picture's relief is made at one size after another, and the largest size within the pace's budget is used.
// At a cut the size becomes one smaller if reliefs were slow, one larger if they left much time.
class ReliefMaker {
 public:
  // Pictures to read ahead: those that touch needs if every second one has a relief, and two more.
  static constexpr std::size_t kAhead = 12;

  // `matcher` null: no reliefs can be made.
  ReliefMaker(std::unique_ptr<StereoMatcher> matcher, const Clock& clock);
  ~ReliefMaker();
  ReliefMaker(const ReliefMaker&) = delete;
  ReliefMaker& operator=(const ReliefMaker&) = delete;

  [[nodiscard]] bool canMake() const noexcept { return matcher_ != nullptr; }
  // A second call does nothing.
  void startThread();
  void stop() noexcept;

  // A film with this time between two pictures begins; `end`: it ends.
  void begin(Duration period);
  void end();
  // Forgets the offered pictures, since the film continues at another place.
  void jump();
  // Offers the next picture. Does nothing if it was offered before or has no right view.
  void offer(const FramePair& pair);
  // This picture is shown: no relief is made any more for it and those before it.
  void passed(MediaTime shown);
  // The next relief, in order, with its picture's time.
  [[nodiscard]] std::optional<Frame> take();
  // True if there is nothing to make and nothing to take.
  [[nodiscard]] bool idle() const;
  // A line for the user if this machine makes fewer reliefs than the film has pictures; once a film.
  [[nodiscard]] std::optional<std::string> takeSlowness();
  // What the matcher objects to in the views; each once a film.
  [[nodiscard]] std::optional<StereoMatcher::Caution> takeCaution();
  // Totals over all films.
  [[nodiscard]] ReliefSummary summary() const;

  // Makes one relief; false if there is none to make.
  bool work();

 private:
  struct Job {
    Frame left, right;
  };
  [[nodiscard]] bool hasJob() const { return !jobs_.empty(); }
  void dropUndue();
  [[nodiscard]] Frame makeFirst(const Job& job, Duration budget);
  void adapt();
  void threadMain();

  const std::unique_ptr<StereoMatcher> matcher_;  // used by the maker's side only
  const Clock& clock_;

  mutable std::mutex mutex_;  // guards everything below; not held while a relief is made
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  std::deque<Frame> made_;
  std::uint64_t generation_ = 0;  // counts films and jumps
  bool film_is_new_ = false, begins_shot_ = false;
  bool at_work_ = false;
  Duration period_{0};
  ReliefPace pace_{Duration(0)};
  std::size_t size_ = 0;              // index of the matcher's size in use
  int since_change_ = 0;              // reliefs made since that changed
  std::optional<MediaTime> offered_;  // time of the picture offered last
  std::optional<MediaTime> last_;     // time of the picture whose relief was made last
  std::optional<MediaTime> shown_;    // time of the picture on the screen
  bool slowness_told_ = false;
  std::vector<const char*> cautions_told_;
  std::optional<StereoMatcher::Caution> caution_;
  ReliefSummary summary_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace relievo
