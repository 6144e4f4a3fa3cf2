// SPDX-License-Identifier: Apache-2.0
// A file system for SQLite that has one file, for reading (sqlite.org, "The OS Interface").
#include "drivers/rosbag/sqlite_view.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "drivers/rosbag/bag_file.h"

namespace relievo::rosbag {
namespace {

struct OpenFile {
  sqlite3_file base;
  const AnsweredFile* file;
};

int readFile(sqlite3_file* base, void* out, int bytes, sqlite3_int64 at) {
  const std::span<std::uint8_t> room(static_cast<std::uint8_t*>(out), static_cast<std::size_t>(bytes));
  const auto got = reinterpret_cast<OpenFile*>(base)->file->read(static_cast<std::uint64_t>(at), room);
  if (!got) return SQLITE_IOERR_READ;
  std::ranges::fill(room.subspan(*got), std::uint8_t{0});
  return *got == room.size() ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
}

int sizeOfFile(sqlite3_file* base, sqlite3_int64* bytes) {
  const auto known = reinterpret_cast<OpenFile*>(base)->file->bytes();
  *bytes = known ? static_cast<sqlite3_int64>(*known) : 0;
  return known ? SQLITE_OK : SQLITE_IOERR_FSTAT;
}

const sqlite3_io_methods kMethods{
    .iVersion = 1,
    .xClose = [](sqlite3_file*) { return SQLITE_OK; },
    .xRead = readFile,
    .xWrite = [](sqlite3_file*, const void*, int, sqlite3_int64) { return SQLITE_READONLY; },
    .xTruncate = [](sqlite3_file*, sqlite3_int64) { return SQLITE_READONLY; },
    .xSync = [](sqlite3_file*, int) { return SQLITE_OK; },
    .xFileSize = sizeOfFile,
    .xLock = [](sqlite3_file*, int) { return SQLITE_OK; },
    .xUnlock = [](sqlite3_file*, int) { return SQLITE_OK; },
    .xCheckReservedLock =
        [](sqlite3_file*, int* held) {
          *held = 0;
          return SQLITE_OK;
        },
    .xFileControl = [](sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; },
    .xSectorSize = [](sqlite3_file*) { return 0; },
    .xDeviceCharacteristics = [](sqlite3_file*) { return SQLITE_IOCAP_IMMUTABLE; },
    .xShmMap = nullptr,
    .xShmLock = nullptr,
    .xShmBarrier = nullptr,
    .xShmUnmap = nullptr,
    .xFetch = nullptr,
    .xUnfetch = nullptr,
};

int openFile(sqlite3_vfs* files, const char*, sqlite3_file* base, int flags, int* given) {
  if ((flags & SQLITE_OPEN_MAIN_DB) == 0) {
    base->pMethods = nullptr;
    return SQLITE_CANTOPEN;
  }
  *reinterpret_cast<OpenFile*>(base) = {{&kMethods}, static_cast<const AnsweredFile*>(files->pAppData)};
  if (given != nullptr) *given = flags;
  return SQLITE_OK;
}

}  // namespace

SqliteView::~SqliteView() {
  sqlite3_close(database_);
  if (registered_) sqlite3_vfs_unregister(&files_);
}

Result<void> SqliteView::open(AnsweredFile file, const std::atomic<bool>& cancelled) {
  file_ = std::move(file);
  name_ = "relievo-" + std::to_string(reinterpret_cast<std::uintptr_t>(this));
  files_.iVersion = 1;
  files_.szOsFile = sizeof(OpenFile);
  files_.mxPathname = 256;
  files_.zName = name_.c_str();
  files_.pAppData = &file_;
  files_.xOpen = openFile;
  files_.xDelete = [](sqlite3_vfs*, const char*, int) { return SQLITE_READONLY; };
  files_.xAccess = [](sqlite3_vfs*, const char*, int, int* there) {
    *there = 0;
    return SQLITE_OK;
  };
  files_.xFullPathname = [](sqlite3_vfs*, const char* name, int room, char* out) {
    return sqlite3_snprintf(room, out, "%s", name) != nullptr ? SQLITE_OK : SQLITE_CANTOPEN;
  };
  files_.xRandomness = [](sqlite3_vfs*, int bytes, char* out) {
    std::memset(out, 0, static_cast<std::size_t>(bytes));
    return bytes;
  };
  files_.xSleep = [](sqlite3_vfs*, int microseconds) { return microseconds; };
  files_.xCurrentTime = [](sqlite3_vfs*, double* days) {
    *days = 0;
    return SQLITE_OK;
  };
  files_.xGetLastError = [](sqlite3_vfs*, int, char*) { return 0; };
  registered_ = sqlite3_vfs_register(&files_, 0) == SQLITE_OK;
  constexpr int kFlags = SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX;
  if (!registered_ || sqlite3_open_v2("bag", &database_, kFlags, name_.c_str()) != SQLITE_OK)
    return fail(ErrorCode::Corrupt, "SQLite cannot open the bag");
  // A query of the file's own that is named like a table need not end.
  sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  // Nor need a computed column stay small.
  sqlite3_limit(database_, SQLITE_LIMIT_LENGTH, int{kMostMessage});
  // A message is read once; SQLite need not keep its pages.
  sqlite3_exec(database_, "PRAGMA cache_size = 8", nullptr, nullptr, nullptr);
  constexpr int kSteps = 1000;  // of SQLite's machine, between looks at the flag
  sqlite3_progress_handler(
      database_, kSteps, [](void* flag) { return static_cast<const std::atomic<bool>*>(flag)->load() ? 1 : 0; },
      const_cast<std::atomic<bool>*>(&cancelled));
  return {};
}

Statement prepare(const SqliteView& view, const char* query) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(view.get(), query, -1, &statement, nullptr) != SQLITE_OK) return nullptr;
  return Statement(statement);
}

}  // namespace relievo::rosbag
