// SPDX-License-Identifier: Apache-2.0
// The thread that writes files: what it writes in which order, what it refuses, and that its end is bounded.
#include "app/player/file_writer.h"

#include <gtest/gtest.h>

#include <latch>
#include <memory>
#include <optional>
#include <string>

#include "platform/error.h"
#include "platform/files/file_system_answer.h"

namespace relievo {
namespace {

// A writer that is busy until `release`; what it has written since.
struct BusyWriter {
  explicit BusyWriter(Duration patience = std::chrono::hours(1)) : files(FileWriter::Where::OwnThread, patience) {
    files.give("", [this] {
      begun.count_down();
      released.wait();
    });
    begun.wait();
  }
  bool give(const std::string& name, const std::string& word) {
    return files.give(name, [this, word] { written += word; });
  }

  std::latch begun{1}, released{1};
  std::string written;
  FileWriter files;
};

TEST(FileWriter, WritesInOrderAndOnlyTheNewestOfAName) {
  BusyWriter busy;
  EXPECT_TRUE(busy.give("places", "a"));
  EXPECT_TRUE(busy.give("volume", "b"));
  EXPECT_TRUE(busy.give("places", "c"));
  EXPECT_TRUE(busy.give("", "d"));
  EXPECT_TRUE(busy.give("", "e")) << "has no name";
  EXPECT_EQ(busy.written, "") << "nobody has waited";
  busy.released.count_down();
  busy.files.finish();
  EXPECT_EQ(busy.written, "cbde");
  EXPECT_FALSE(busy.give("places", "f")) << "finished";
}

TEST(FileWriter, RefusesWhatNeverEndsToWait) {
  BusyWriter busy;
  EXPECT_TRUE(busy.give("places", "a"));
  for (std::size_t i = 1; i < FileWriter::kMost; ++i) EXPECT_TRUE(busy.give("", "b"));
  EXPECT_FALSE(busy.give("", "c"));
  EXPECT_TRUE(busy.give("places", "d")) << "its place is there";
  busy.released.count_down();
  busy.files.finish();
  EXPECT_EQ(busy.written, "d" + std::string(FileWriter::kMost - 1, 'b'));
}

TEST(FileWriter, HasRoomForANamedWriteWhateverElseWaits) {
  BusyWriter busy;
  for (std::size_t i = 0; i < FileWriter::kMost; ++i) EXPECT_TRUE(busy.give("", "b"));
  EXPECT_TRUE(busy.give("places", "p"));
  EXPECT_TRUE(busy.give("volume", "v"));
  EXPECT_FALSE(busy.give("", "c"));
  busy.released.count_down();
  busy.files.finish();
  EXPECT_EQ(busy.written, std::string(FileWriter::kMost, 'b') + "pv");
}

TEST(FileWriter, ItsEndDoesNotWaitForADeadDisk) {
  auto dead = std::make_shared<std::latch>(1);  // the question is left behind
  std::optional<ErrorCode> first, second;
  {
    const auto ask = [dead](std::optional<ErrorCode>& code) {
      const auto asked = fileSystem().ask("/dead", [dead] { dead->wait(); });
      if (!asked) code = asked.error().code;
    };
    FileWriter files(FileWriter::Where::OwnThread, Duration(1));
    files.give("", [&] { ask(first); });
    files.give("", [&] { ask(second); });
  }
  EXPECT_EQ(first, ErrorCode::Cancelled);
  EXPECT_EQ(second, ErrorCode::Cancelled);
  dead->count_down();
}

TEST(FileWriter, InSimulatedTimeItWritesAtOnce) {
  FileWriter files(FileWriter::Where::AtOnce);
  std::string written;
  EXPECT_TRUE(files.give("a", [&] { written += "a"; }));
  EXPECT_EQ(written, "a");
}

}  // namespace
}  // namespace relievo
