// SPDX-License-Identifier: Apache-2.0
// The Inverse3 over real sockets of the loopback interface, with the emulator of its service in another thread.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "drivers/inverse3/inverse3.h"
#include "platform/allocation_counter.h"
#include "tests/rt/forbidden_calls.h"
#include "tests/support/device/inverse3_server.h"
#include "tests/support/machine/no_threads.h"

namespace relievo {
namespace {

using namespace std::chrono_literals;
using test::Inverse3Server;
using Version = test::Inverse3Service::Version;

class Inverse3Loopback : public testing::Test {
 protected:
  std::unique_ptr<HapticDevice> deviceAt(const inverse3::Address& address) {
    return makeInverse3({.address = address}, clock_);
  }
  static void bringUp(HapticDevice& device) {
    const auto opened = device.open();
    ASSERT_TRUE(opened) << opened.error().message;
    const auto homed = device.home();
    ASSERT_TRUE(homed) << homed.error().message;
    ASSERT_TRUE(device.start());
  }
  Result<HapticSample> tick(HapticDevice& device) {
    auto sample = device.read();
    if (sample) static_cast<void>(device.write({0, 0, 1}));
    clock_.sleepUntil(clock_.now() + 1ms);
    return sample;
  }
  // Nobody listens there.
  static std::uint16_t freePort() {
    const UniqueFd gone = test::bindLoopback(SOCK_STREAM);
    return test::portOf(gone);
  }
  MonotonicClock clock_;
};

TEST_F(Inverse3Loopback, ATickAllocatesNothingAndTakesNoLock) {
  Inverse3Server server(Version::V3_5);
  const glm::dvec3 place(12.5, -7, 3.25);
  server.with([&](auto& service) { service.hand = [place](double) { return place; }; });
  const auto device = deviceAt(server.address());
  ASSERT_NO_FATAL_FAILURE(bringUp(*device));
  const std::uint64_t allocations = threadAllocations(), locks = test::threadLocks();
  int there = 0;
  for (int i = 0; i < 500; ++i) {
    const auto sample = tick(*device);
    there += sample && std::abs(sample->position_mm.x - place.x) < 1e-4 &&
                     std::abs(sample->position_mm.y - place.y) < 1e-4 &&
                     std::abs(sample->position_mm.z - place.z) < 1e-4
                 ? 1
                 : 0;
  }
  EXPECT_EQ(threadAllocations(), allocations);
  EXPECT_EQ(test::threadLocks(), locks);
  EXPECT_GT(there, 400) << "on a loaded machine some ticks may lose the service";
  device->stop();
  EXPECT_EQ(server.with([](auto& service) { return service.error(); }), "");
}

TEST_F(Inverse3Loopback, AServiceThatEndsIsLostAndIsFoundAgain) {
  auto server = std::make_unique<Inverse3Server>(Version::V3_1);
  const inverse3::Address address = server->address();
  const auto device = deviceAt(address);
  ASSERT_NO_FATAL_FAILURE(bringUp(*device));
  EXPECT_TRUE(tick(*device));
  server.reset();
  Result<HapticSample> read;
  while (read) read = tick(*device);
  EXPECT_EQ(read.error().code, ErrorCode::Lost);
  device->close();
  const auto refused = device->open();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::NotFound);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("systemctl start haply-inverse-service"));
  server = std::make_unique<Inverse3Server>(Version::V3_5, address.port);
  ASSERT_NO_FATAL_FAILURE(bringUp(*device));
}

// The last `write` is long ago and nobody reads: the watchdog's own thread stops the motors.
TEST_F(Inverse3Loopback, TheWatchdogActsWhileTheTickHangs) {
  Inverse3Server server(Version::V3_5);
  const auto device = deviceAt(server.address());
  ASSERT_NO_FATAL_FAILURE(bringUp(*device));
  const auto pushes = [&server] { return server.with([](auto& service) { return service.pushes(); }); };
  for (int i = 0; i < 5000 && !pushes(); ++i) static_cast<void>(tick(*device));
  ASSERT_TRUE(pushes());
  while (pushes()) std::this_thread::sleep_for(1ms);
}

TEST_F(Inverse3Loopback, WhatIsNoSuchServiceIsRefused) {
  const UniqueFd listener = test::bindLoopback(SOCK_STREAM);
  std::thread web([&listener] {
    const UniqueFd client(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC));
    static_cast<void>(test::sendAll(client, "HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n"));
    char byte = 0;
    while (::recv(client.get(), &byte, 1, 0) > 0) {
    }
  });
  const auto opened = deviceAt({.host = "127.0.0.1", .port = test::portOf(listener)})->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Unsupported);
  web.join();
}

// A service of 3.0 has no other port than the older one.
TEST_F(Inverse3Loopback, WhereOnlyTheOlderPortAnswersANewerServiceIsAskedFor) {
  const UniqueFd older = test::bindLoopback(SOCK_STREAM);
  const auto opened = deviceAt({.host = "127.0.0.1", .port = freePort(), .older_port = test::portOf(older)})->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("systemctl start"));
  EXPECT_THAT(opened.error().message, testing::HasSubstr("install 3.1"));
}

TEST_F(Inverse3Loopback, LooksForTheOlderPortOnlyBesideTheUsualOne) {
  const UniqueFd older(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_TRUE(older.valid());
  const sockaddr_in place = test::loopback(10000);
  const bool free = ::bind(older.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
  ASSERT_TRUE(!free || ::listen(older.get(), 1) == 0);  // if it is not, another program answers there
  const auto opened = deviceAt({.host = "127.0.0.1", .port = freePort()})->open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::NotFound);
  EXPECT_THAT(opened.error().message, testing::Not(testing::HasSubstr("3.0")));
}

// Its queue of connections is full, so that the next one waits.
TEST_F(Inverse3Loopback, LookingForTheOlderPortCanBeCancelled) {
  const UniqueFd older = test::bindLoopback(SOCK_STREAM);
  ASSERT_EQ(::listen(older.get(), 0), 0);
  const sockaddr_in place = test::loopback(test::portOf(older));
  std::vector<UniqueFd> waiting;
  for (int i = 0; i < 4; ++i) {
    waiting.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    static_cast<void>(::connect(waiting.back().get(), reinterpret_cast<const sockaddr*>(&place), sizeof place));
  }
  std::atomic<bool> cancelled = false;
  std::thread canceller([&cancelled] {
    std::this_thread::sleep_for(200ms);
    cancelled = true;
  });
  const auto wire = inverse3::makeTcpWire({.host = "127.0.0.1", .port = freePort(), .older_port = test::portOf(older)});
  const auto opened = wire->open(cancelled);
  canceller.join();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::Cancelled);
}

TEST_F(Inverse3Loopback, AtTheLimitOfProcessesOpeningFails) {
  const auto device = deviceAt({.host = "127.0.0.1", .port = 1});
  const test::NoThreads none;
  EXPECT_EQ(device->open().error().code, ErrorCode::Exhausted);
}

// It listens, but never answers.
TEST_F(Inverse3Loopback, OpeningEndsWhenItIsCalledOff) {
  const UniqueFd listener = test::bindLoopback(SOCK_STREAM);
  const auto device = deviceAt({.host = "127.0.0.1", .port = test::portOf(listener)});
  std::thread caller([&device] {
    std::this_thread::sleep_for(20ms);
    device->cancel();
  });
  EXPECT_EQ(device->open().error().code, ErrorCode::Cancelled);
  caller.join();
}

}  // namespace
}  // namespace relievo
