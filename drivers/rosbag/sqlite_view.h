// SPDX-License-Identifier: Apache-2.0
// A database of SQLite in a file that another program wrote, for reading.
#pragma once

#include <sqlite3.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "platform/error.h"
#include "platform/files/answered_file.h"

namespace relievo::rosbag {

// SQLite reads the file through AnsweredFile, so that a stalled mount stalls nothing, and takes no lock. What a writer
// left in a log beside the file is not seen.
class SqliteView {
 public:
  SqliteView() = default;
  SqliteView(const SqliteView&) = delete;
  SqliteView& operator=(const SqliteView&) = delete;
  ~SqliteView();

  // A query ends soon after the flag is set; it must outlive the view.
  [[nodiscard]] Result<void> open(AnsweredFile file, const std::atomic<bool>& cancelled);
  [[nodiscard]] sqlite3* get() const noexcept { return database_; }

 private:
  AnsweredFile file_;
  std::string name_;  // of the file system
  sqlite3_vfs files_{};
  bool registered_ = false;
  sqlite3* database_ = nullptr;
};

struct EndStatement {
  void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, EndStatement>;
// Null if the database has no such table or column; views are none.
[[nodiscard]] Statement prepare(const SqliteView& view, const char* query);

}  // namespace relievo::rosbag
