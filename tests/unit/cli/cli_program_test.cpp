// SPDX-License-Identifier: Apache-2.0
// The last actions of a program, however it ends.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

#include "app/cli/program.h"

namespace relievo {
namespace {

void quieten() noexcept {
  static_cast<void>(::write(STDERR_FILENO, "quiet", 5));
}

void begin() {
  static_cast<void>(stopOnSignals(quieten));
}

TEST(ProgramDeathTest, ALibraryThatEndsTheProgramDoesNotLeaveTheMotorsOn) {
  EXPECT_EXIT((begin(), std::exit(3)), testing::ExitedWithCode(3), "^quiet$");
}

TEST(ProgramDeathTest, NeitherDoesASecondSignal) {
  EXPECT_EXIT((begin(), std::raise(SIGTERM), std::raise(SIGTERM), ::pause()), testing::KilledBySignal(SIGTERM),
              "^quiet$");
}

// Which would stop every thread, watchdogs included, while a force stands.
TEST(ProgramDeathTest, CtrlZDoesNotStopIt) {
  const auto ignored = [](void (*handler)(int)) { return handler == SIG_IGN ? 5 : 6; };
  EXPECT_EXIT(std::_Exit(ignored(std::signal(SIGTSTP, SIG_DFL))), testing::ExitedWithCode(6), "");
  EXPECT_EXIT((begin(), std::_Exit(ignored(std::signal(SIGTSTP, SIG_DFL)))), testing::ExitedWithCode(5), "");
}

// As nohup(1) starts it.
TEST(ProgramDeathTest, AHangUpThatIsIgnoredStaysSo) {
  const auto hangUp = [](void (*before)(int)) {
    std::signal(SIGHUP, before);
    const std::atomic<bool>& stop = stopOnSignals(quieten);
    std::raise(SIGHUP);
    std::_Exit(stop ? 5 : 6);
  };
  EXPECT_EXIT(hangUp(SIG_DFL), testing::ExitedWithCode(5), "");
  EXPECT_EXIT(hangUp(SIG_IGN), testing::ExitedWithCode(6), "");
}

TEST(ProgramDeathTest, SignalsMayEndItAtOnceAgainButNotOneThatIsIgnored) {
  const auto raise = [](int number, void (*before)(int)) {
    std::signal(SIGHUP, before);
    begin();
    endOnSignals();
    std::raise(number);
    std::_Exit(6);
  };
  EXPECT_EXIT(raise(SIGTERM, SIG_DFL), testing::KilledBySignal(SIGTERM), "");
  EXPECT_EXIT(raise(SIGHUP, SIG_DFL), testing::KilledBySignal(SIGHUP), "");
  EXPECT_EXIT(raise(SIGHUP, SIG_IGN), testing::ExitedWithCode(6), "");
}

// As with a display that does not answer.
TEST(ProgramDeathTest, AnEndThatTakesLongIsTold) {
  const auto end = [] {
    begin();
    std::raise(SIGTERM);
    const bool set = ::alarm(0) > 0;
    std::raise(SIGALRM);
    return set ? 5 : 6;
  };
  EXPECT_EXIT(std::_Exit(runProgram("relievo", end)), testing::ExitedWithCode(5),
              "^relievo: is still ending; a second signal ends it at once\n$");
}

TEST(ProgramDeathTest, AThreadWithoutMemoryEndsTheProgramWithALine) {
  const auto run = [](const std::function<void()>& work) {
    return runProgram("relievo", [&] {
      begin();
      std::thread(work).join();
      return kExitDone;
    });
  };
  EXPECT_EXIT(run([] { throw std::bad_alloc(); }), testing::ExitedWithCode(kExitFailed),
              "^quietrelievo: std::bad_alloc: the system is out of resources; .*\n$");
  const auto refused = [](std::errc why) { return [why] { throw std::system_error(std::make_error_code(why)); }; };
  for (const std::errc lack : {std::errc::resource_unavailable_try_again, std::errc::not_enough_memory}) {
    EXPECT_EXIT(run(refused(lack)), testing::ExitedWithCode(kExitFailed), "the system is out of resources");
  }
  EXPECT_EXIT(run(refused(std::errc::bad_file_descriptor)), testing::KilledBySignal(SIGABRT), "^quiet$");
  EXPECT_EXIT(run([] { throw std::logic_error("a fault"); }), testing::KilledBySignal(SIGABRT), "^quiet$");
}

// Otherwise a film that is opened later would get the number of standard output, and printed lines would go into it.
TEST(ProgramDeathTest, AFileIsNoStreamThatWasClosed) {
  const auto opened = [] { return ::open("/dev/null", O_WRONLY | O_CLOEXEC) > STDERR_FILENO ? 5 : 6; };
  EXPECT_EXIT((::close(STDIN_FILENO), ::close(STDOUT_FILENO), ::close(STDERR_FILENO),
               std::_Exit(runProgram("relievo", opened))),
              testing::ExitedWithCode(5), "");
}

TEST(ProgramDeathTest, FewFilesAreOpenAtOnceWhateverIsAllowed) {
  const auto look = [] {
    rlimit limit{};
    return ::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur <= 1024 ? 5 : 6;
  };
  const auto run = [&] {
    rlimit limit{};
    static_cast<void>(::getrlimit(RLIMIT_NOFILE, &limit));
    limit.rlim_cur = limit.rlim_max;
    static_cast<void>(::setrlimit(RLIMIT_NOFILE, &limit));
    return runProgram("relievo", look);
  };
  EXPECT_EXIT(std::_Exit(run()), testing::ExitedWithCode(5), "");
}

TEST(ProgramDeathTest, AClosedOutputIsAFailure) {
  const auto say = [] { return std::puts("words") >= 0 ? kExitDone : kExitFailed; };
  EXPECT_EXIT((::close(STDOUT_FILENO), std::_Exit(runProgram("relievo", say))), testing::ExitedWithCode(kExitFailed),
              "standard output: it cannot be written");
}

}  // namespace
}  // namespace relievo
