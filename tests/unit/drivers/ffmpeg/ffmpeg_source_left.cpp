// SPDX-License-Identifier: Apache-2.0
// Openings and texts that FFmpeg does not end: it waits for the name of a server, or for whoever writes to a pipe.
#include <dlfcn.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netdb.h>
#include <sys/stat.h>

#include <atomic>
#include <string_view>
#include <thread>

#include "platform/files/file_system_answer.h"
#include "platform/unique_fd.h"
#include "tests/support/machine/no_threads.h"
#include "tests/unit/drivers/ffmpeg/ffmpeg_sources.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;

constexpr std::string_view kSilent = "silent.invalid";
std::atomic<bool> name_server_is_silent{false};
std::atomic<int> asking{0}, asked{0};

// Gives up a film from that server once its name is asked for.
void giveUpOne() {
  const auto source = makeFfmpegSource();
  const int before = asking;
  std::thread user([&] {
    while (asking == before) std::this_thread::sleep_for(1ms);
    source->interrupt();
  });
  const auto opened = source->open("http://silent.invalid/film.mkv");
  user.join();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Cancelled);
}

TEST(FfmpegSource, AtMostEightOpeningsAreLeftBehind) {
  const test::TemporaryFolder folder;
  test::makeClip(folder / "a.mkv", {kH264});
  name_server_is_silent = true;
  for (int i = 0; i < 7; ++i) giveUpOne();
  EXPECT_TRUE(makeFfmpegSource()->open(folder / "a.mkv"));
  giveUpOne();
  EXPECT_EQ(asking, 8);
  const Error error = openErrorOf(folder / "a.mkv");
  EXPECT_EQ(error.code, ErrorCode::Exhausted);
  EXPECT_THAT(error.message, testing::HasSubstr("start the program again"));
  name_server_is_silent = false;
  bool opens = false;
  for (int waits = 0; !opens && waits < 3000; ++waits) {
    std::this_thread::sleep_for(10ms);
    opens = makeFfmpegSource()->open(folder / "a.mkv").has_value();
  }
  EXPECT_TRUE(opens) << "the others have ended";
}

// The thread is left behind: the name is still asked for.
TEST(FfmpegText, IsGivenUpWhileItsServersNameIsLookedUp) {
  name_server_is_silent = true;
  const int before = asking;
  std::atomic<bool> cancelled = false;
  std::thread user([&] {
    while (asking == before) std::this_thread::sleep_for(1ms);
    cancelled = true;
  });
  const auto text = readFfmpegText("http://silent.invalid/list.m3u8", 1 << 20, cancelled);
  user.join();
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::Cancelled);
  EXPECT_EQ(asking, before + 1);
  name_server_is_silent = false;
  while (asking > before) std::this_thread::sleep_for(1ms);
}

// On the caller's thread the look-up could not be given up.
TEST(FfmpegText, IsRefusedWhereNoThreadCanBeStarted) {
  const int before = asked;
  const test::NoThreads none;
  const auto text = readFfmpegText("http://silent.invalid/list.m3u8", 1 << 20, false);
  const Error opening = openErrorOf("http://silent.invalid/film.mkv");
  ASSERT_FALSE(text);
  for (const Error& error : {text.error(), opening}) {
    EXPECT_EQ(error.code, ErrorCode::Exhausted);
    EXPECT_STREQ(error.message, kProcessLimit);
  }
  EXPECT_EQ(asked, before);
}

TEST(FfmpegText, IsGivenUpWhileNobodyWritesToItsPipe) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder / "list.m3u8";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto text = readFfmpegText(pipe, 1 << 20, true);
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().code, ErrorCode::Cancelled);
  // Ends the thread that was left, once it waits for the pipe.
  while (!UniqueFd(::open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)).valid()) std::this_thread::sleep_for(1ms);
}

}  // namespace
}  // namespace relievo

// Takes the place of the C library's, which asks a server of names.
extern "C" int getaddrinfo(const char* node, const char* service, const addrinfo* hints, addrinfo** found) {
  using Function = decltype(&getaddrinfo);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  if (node == nullptr || node != relievo::kSilent) return real(node, service, hints, found);
  ++relievo::asking;
  ++relievo::asked;
  while (relievo::name_server_is_silent) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  --relievo::asking;
  return EAI_AGAIN;
}
