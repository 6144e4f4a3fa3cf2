// SPDX-License-Identifier: Apache-2.0
#include "app/player/file_writer.h"

#include <algorithm>
#include <utility>

#include "platform/files/file_system_answer.h"

namespace relievo {

FileWriter::FileWriter(Where where, Duration last_patience) : last_patience_(last_patience) {
  if (where == Where::OwnThread) thread_ = std::thread([this] { threadMain(); });
}

bool FileWriter::give(const std::string& name, std::function<void()> write) {
  std::unique_lock lock(mutex_);
  if (finishing_) return false;
  if (!thread_.joinable()) {
    lock.unlock();
    write();
    return true;
  }
  const auto waits = name.empty() ? jobs_.end() : std::ranges::find(jobs_, name, &Job::name);
  if (name.empty() && jobs_.size() >= kMost) return false;
  if (waits != jobs_.end()) waits->write = std::move(write);
  else jobs_.push_back({name, std::move(write)});
  wake_.notify_all();
  return true;
}

void FileWriter::finish() {
  std::unique_lock lock(mutex_);
  finishing_ = true;
  wake_.notify_all();
  if (!thread_.joinable()) return;
  wake_.wait_for(lock, last_patience_, [this] { return jobs_.empty() && !writing_; });
  lock.unlock();
  gives_up_ = true;
  thread_.join();
}

void FileWriter::threadMain() {
  const CancelsAnswers cancels(gives_up_);
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return finishing_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    writing_ = true;
    lock.unlock();
    job.write();
    lock.lock();
    writing_ = false;
    wake_.notify_all();
  }
}

Result<void> writeFile(const std::string& path, std::string_view text, Existing existing) {
  auto file = AtomicFile::create(path, existing);
  if (!file) return std::unexpected(file.error());
  file->output().cancelBy(CancelsAnswers::flag());
  file->write(text);
  return file->commit();
}

}  // namespace relievo
