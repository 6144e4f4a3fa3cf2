// SPDX-License-Identifier: Apache-2.0
// A long wait for a film that is being opened is told.
#include "app/media/pairs/long_wait.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace relievo {
namespace {

// Standard error in a pipe, so that a source can wait for what is said.
class Said {
 public:
  Said() {
    EXPECT_EQ(::pipe(pipe_.data()), 0);
    kept_ = ::dup(STDERR_FILENO);
    ::dup2(pipe_[1], STDERR_FILENO);
  }
  ~Said() {
    ::dup2(kept_, STDERR_FILENO);
    for (const int file : {kept_, pipe_[0], pipe_[1]}) ::close(file);
  }
  Said(const Said&) = delete;
  Said& operator=(const Said&) = delete;

  // Empty if nothing comes in `patience_ms`.
  [[nodiscard]] std::string wait(int patience_ms) const {
    pollfd readable{.fd = pipe_[0], .events = POLLIN, .revents = 0};
    std::array<char, 256> text{};
    if (::poll(&readable, 1, patience_ms) <= 0) return "";
    const auto got = ::read(pipe_[0], text.data(), text.size());
    return {text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))};
  }

 private:
  std::array<int, 2> pipe_{};
  int kept_ = -1;
};

// Cannot be opened, and says so only after something was said.
class SlowSource final : public MediaSource {
 public:
  SlowSource(const Said& said, int patience_ms, std::string& heard)
      : said_(said), patience_ms_(patience_ms), heard_(heard) {}

 private:
  Result<Description> openSource(const std::string&) override {
    heard_ = said_.wait(patience_ms_);
    return fail(ErrorCode::NotFound, "not there");
  }
  Result<std::optional<Packet>> readPacket() override { return std::nullopt; }
  Result<void> seekTo(MediaTime) override { return {}; }
  void closeSource() noexcept override {}
  void interrupted() noexcept override {}

  const Said& said_;
  int patience_ms_;
  std::string& heard_;
};

TEST(LongWait, SaysWhatIsWaitedForOnlyAfterItsPatience) {
  const Said said;
  std::string heard;
  const auto open = [&](int patience_ms, Duration telling) {
    PairReader reader(
        {.make_source = [&](const std::string&) { return std::make_unique<SlowSource>(said, patience_ms, heard); }});
    EXPECT_FALSE(openTelling(reader, {.url = "film", .depth_url = "depth"}, telling).has_value());
  };
  open(20'000, Duration(0));
  EXPECT_THAT(heard, testing::HasSubstr("waiting for \"film\" or \"depth\" (up to 30 s)"));
  open(0, std::chrono::hours(1));
  EXPECT_EQ(heard, "");
}

}  // namespace
}  // namespace relievo
